#include "wearwell/cli/new.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <memory>

#include "wearwell/base/error.h"
#include "wearwell/cli/new_from.h"
#include "wearwell/cli/new_monitor.h"
#include "wearwell/cli/option_rules.h"
#include "wearwell/study/example.h"

namespace wearwell {

void add_new_command(CLI::App& app, Models models, int& exit_code) {
  auto options = std::make_shared<NewOptions>();
  CLI::App* command = app.add_subcommand(
      "new", "Write a commented study: an example, or one for your own table; or a monitor");
  std::vector<std::string> presets;
  for (const Model& model : models) presets.emplace_back(model.preset);
  presets.emplace_back(monitor_preset);
  command
      ->add_option("PRESET", options->preset,
                   fmt::format("Application to start from: {}", fmt::join(presets, ", ")))
      ->type_name(fmt::format("TEXT:{}", fmt::join(presets, "|")));
  command->add_option("DIR", options->folder,
                      "Folder for the study: new or empty (default with --from: FILE-study)");
  command->add_option("--from", options->from,
                      "Guess columns and units of the table FILE, and copy it to the folder; of a "
                      "monitor: the result whose units it follows");
  command
      ->add_option("--column", options->columns,
                   "Role of a column, ROLE=HEADING: depth='wear [um]'; ROLE= for none")
      ->type_name("ROLE=HEADING");
  command
      ->add_option("--failure", options->failure,
                   "The value that means failure in a column of 0 and 1")
      ->check(number_between(0, 1));
  command->add_option("--limit", options->limit, "Failure threshold of the wear: '100 um'");
  for (const auto& [key, help] : table_keys) {
    command->add_option_function<std::string>(
        option_of(key),
        [options, name = std::string(key)](const std::string& value) {
          options->table[name] = value;
        },
        help);
  }
  command->footer(
      "Examples:\n"
      "  wearwell new joint my-joint && wearwell fit my-joint/study.toml\n"
      "  wearwell new --from lives.csv\n"
      "  wearwell new fatigue my-lives --from lives.csv\n"
      "  wearwell new monitor my-fleet --from study-results\n"
      "  wearwell new --from rig.xlsx --sheet Run3 --column unit=Lager --limit '80 um'\n\n"
      "Exit codes: 0 done; 1 the guessed study needs corrections before it runs; 2 the request is "
      "wrong, nothing written.");
  command->callback([options, models, &exit_code] {
    if (options->preset == monitor_preset) {
      run_new_monitor(*options, models);
      exit_code = 0;
      return;
    }
    if (!options->from.empty()) {
      exit_code = run_from(*options, models);
      return;
    }
    if (options->preset.empty()) throw CLI::RequiredError("PRESET");
    const Model& model = model_of(models, options->preset);
    const bool of_table = !options->columns.empty() || options->failure ||
                          !options->limit.empty() || !options->table.empty();
    if (of_table)
      throw InputError(
          "--column, --failure, --limit and the options for reading a table need --from FILE");
    if (options->folder.empty()) throw CLI::RequiredError("DIR");
    const std::filesystem::path study = write_example(model, options->folder);
    fmt::print("Now run: wearwell fit {}\n", study.string());
    exit_code = 0;
  });
}

}  // namespace wearwell
