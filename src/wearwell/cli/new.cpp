#include "wearwell/cli/new.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "wearwell/input/option_value.h"
#include "wearwell/study/example.h"

namespace wearwell {
namespace {

struct NewOptions {
  std::string trade;
  std::filesystem::path folder;
};

}  // namespace

void add_new_command(CLI::App& app, Models models, int& exit_code) {
  auto options = std::make_shared<NewOptions>();
  std::vector<std::string> trades;
  for (const Model& model : models) trades.emplace_back(model.trade);
  CLI::App* command =
      app.add_subcommand("new", "Write a commented study with data, that runs as it is");
  command->add_option("TRADE", options->trade, "What to start from")
      ->required()
      ->check(one_of(trades));
  command->add_option("DIR", options->folder, "Folder for it: new or empty")->required();
  command->footer("Example:\n  wearwell new joint my-joint && wearwell fit my-joint/study.toml");
  command->callback([options, models, &exit_code] {
    const auto model = std::find_if(models.begin(), models.end(), [&](const Model& each) {
      return each.trade == options->trade;
    });
    const std::filesystem::path study = write_example(*model, options->folder);
    fmt::print("Now run: wearwell fit {}\n", study.string());
    exit_code = 0;
  });
}

}  // namespace wearwell
