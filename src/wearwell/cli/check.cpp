#include "wearwell/cli/check.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>

namespace wearwell {
void add_check_command(CLI::App& app, Models models, int& exit_code) {
  auto study = std::make_shared<std::filesystem::path>();
  CLI::App* check = app.add_subcommand(
      "check", "Describe the model, units and priors of a study without fitting it");
  check->add_option("STUDY", *study, "Study file (TOML)")->required();
  check->footer("Example:\n  wearwell check examples/joint/study.toml");
  check->callback([study, models, &exit_code] {
    fmt::print("{}", read_study(source_of(*study), models)->description());
    exit_code = 0;
  });
}

}  // namespace wearwell
