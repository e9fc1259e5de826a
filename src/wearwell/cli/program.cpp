#include "wearwell/cli/program.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "wearwell/base/ending.h"
#include "wearwell/base/error.h"
#include "wearwell/base/input_errors.h"
#include "wearwell/base/shown.h"
#include "wearwell/cli/app.h"
#include "wearwell/cli/command_line.h"

namespace wearwell {
namespace {

constexpr int bad_request = 2, machine_failed = 3;

int complain(const std::string& message, int exit_code) {
  fmt::print(stderr, "wearwell: {}\n", shown(message));
  return exit_code;
}

// If a standard stream is closed, the next file opened would receive the output.
void fill_standard_streams() {
  for (int fd = 0; fd <= 2; ++fd) {
    if (fcntl(fd, F_GETFD) == -1 && open("/dev/null", O_RDONLY) < 0) _exit(machine_failed);
  }
}

// Empty if all output arrived. `error` is the reason why printing ended early, if it did; that
// output is no longer in the buffer, and flushing does not fail again.
std::string trouble_with_output(int error) {
  errno = 0;
  std::cout.flush();
  if (std::fflush(stdout) == 0 && !std::ferror(stdout) && std::cout) return {};
  if (error == 0) error = errno;
  return fmt::format("cannot write to standard output: {}",
                     error ? std::strerror(error) : "the output is incomplete");
}

int run(int argc, char** argv, Models models, int& output_error) {
  int exit_code = 0;
  const std::unique_ptr<CLI::App> app = make_app(models, exit_code);
  const std::vector<std::string> arguments(argv + std::min(argc, 1), argv + argc);
  try {
    check_command_line(*app, arguments);
    app->parse(argc, argv);
  } catch (const CLI::Success& help) {
    return app->exit(help);
  } catch (const CLI::ParseError& error) {
    return complain(said_of(*app, error), bad_request);
  } catch (const InputErrors& errors) {
    for (const std::string& each : errors.all) complain(each, bad_request);
    return bad_request;
  } catch (const InputError& error) {
    return complain(error.what(), bad_request);
  } catch (const MachineError& error) {
    return complain(error.what(), machine_failed);
  } catch (const std::filesystem::filesystem_error& error) {
    return complain(error.what(), machine_failed);
  } catch (const std::system_error& error) {
    if (!std::ferror(stdout)) return complain(error.what(), machine_failed);
    output_error = error.code().value();  // reported in main
    return machine_failed;
  } catch (const std::bad_alloc&) {
    return complain("out of memory", machine_failed);
  } catch (const std::exception& error) {
    return complain(fmt::format("internal error, please report it: {}", error.what()),
                    machine_failed);
  }
  return exit_code;
}

}  // namespace

int run_program(int argc, char** argv, Models models) {
  fill_standard_streams();
  std::signal(SIGXFSZ, SIG_IGN);  // exceeding the file size limit is a full disk, not an abort
  remove_half_written_on_signals();
  int output_error = 0;
  const int exit_code = run(argc, argv, models, output_error);
  const std::string trouble = trouble_with_output(output_error);
  return trouble.empty() ? exit_code : complain(trouble, machine_failed);
}

}  // namespace wearwell
