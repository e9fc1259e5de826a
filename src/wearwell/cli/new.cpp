#include "wearwell/cli/new.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "wearwell/study/new_study.h"

namespace wearwell {
namespace {

struct NewOptions {
  std::string trade;
  std::filesystem::path folder;
};

}  // namespace

void add_new_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<NewOptions>();
  CLI::App* command =
      app.add_subcommand("new", "Write a commented study with data, that runs as it is");
  command->add_option("TRADE", options->trade, "What to start from")
      ->required()
      ->check(CLI::IsMember(new_study_trades()));
  command->add_option("DIR", options->folder, "Folder for it: new or empty")->required();
  command->footer("Example:\n  wearwell new joint my-joint && wearwell fit my-joint/study.toml");
  command->callback([options, &exit_code] {
    const std::filesystem::path study = write_new_study(options->trade, options->folder);
    fmt::print("Now run: wearwell fit {}\n", study.string());
    exit_code = 0;
  });
}

}  // namespace wearwell
