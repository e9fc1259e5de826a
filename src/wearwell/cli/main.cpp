#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/cli/bearing.h"
#include "wearwell/cli/check.h"
#include "wearwell/cli/clutch.h"
#include "wearwell/cli/compare.h"
#include "wearwell/cli/fit.h"
#include "wearwell/cli/new.h"
#include "wearwell/cli/report.h"
#include "wearwell/cli/select.h"

namespace {

constexpr int bad_request = 2, machine_failed = 3;

int complain(const std::string& message, int exit_code) {
  fmt::print(stderr, "wearwell: {}\n", printable_lines(message));
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace wearwell;
  int exit_code = 0;
  CLI::App app(
      "Wear and fatigue-life parameters from few noisy measurements, with honest uncertainty.",
      "wearwell");
  app.require_subcommand(1);
  app.set_version_flag("--version", WEARWELL_VERSION);
  add_fit_command(app, exit_code);
  add_bearing_command(app);
  add_clutch_command(app, exit_code);
  add_select_command(app, exit_code);
  add_check_command(app, exit_code);
  add_compare_command(app, exit_code);
  add_new_command(app, exit_code);
  add_report_command(app, exit_code);

  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    return complain(fmt::format("{} (see wearwell --help)", error.what()), bad_request);
  } catch (const InputError& error) {
    return complain(error.what(), bad_request);
  } catch (const MachineError& error) {
    return complain(error.what(), machine_failed);
  } catch (const std::bad_alloc&) {
    return complain("out of memory", machine_failed);
  } catch (const std::exception& error) {
    return complain(fmt::format("internal error, please report it: {}", error.what()),
                    machine_failed);
  }
  return exit_code;
}
