#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "wearwell/base/error.h"
#include "wearwell/cli/bearing.h"

int main(int argc, char** argv) {
  CLI::App app("How long will it last, and how sure are we?", "wearwell");
  app.require_subcommand(1);
  wearwell::add_bearing_command(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const wearwell::InputError& error) {
    fmt::print(stderr, "wearwell: {}\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "wearwell: {}\n", error.what());
    return 3;
  }
  return 0;
}
