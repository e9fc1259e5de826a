#include "wearwell/cli/new.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/base/printable.h"
#include "wearwell/present/text_table.h"
#include "wearwell/study/example.h"

namespace wearwell {
namespace {

namespace fs = std::filesystem;

struct NewOptions {
  std::string trade;
  fs::path folder, from;
};

const Model& model_of(Models models, const std::string& trade) {
  const auto found = std::find_if(models.begin(), models.end(),
                                  [&](const Model& each) { return each.trade == trade; });
  if (found != models.end()) return *found;
  std::vector<std::string> trades;
  for (const Model& model : models) trades.emplace_back(model.trade);
  throw InputError(fmt::format("TRADE: '{}' is not possible; it is one of {}{}", trade,
                               fmt::join(trades, ", "), did_you_mean(trade, trades)));
}

// The trade that the headings are of: the one that was named, or the only one.
FirstStudy guessed(const NewOptions& options, Models models, const Table& table) {
  const std::string file = options.from.filename().string();
  std::vector<std::string> headings;
  for (const Column& column : table.columns) headings.push_back(column.name);
  std::optional<FirstStudy> study;
  std::string first;
  for (const Model& model : models) {
    if (!model.first_study || (!options.trade.empty() && model.trade != options.trade)) continue;
    auto found = model.first_study(table, file);
    if (!found) continue;
    if (study) {
      throw InputError(
          fmt::format("{} may be a table for {} or {}; say which: wearwell new {} {} "
                      "--from {}",
                      file, first, model.trade, first, options.folder.string(), file));
    }
    study = std::move(found);
    first = model.trade;
  }
  if (!study) {
    throw InputError(fmt::format(
        "{}: no study follows from its headings ({}). Wanted are worn volumes and cycles (joint), "
        "wear depths and revolutions (bearing), or stresses and lives (fatigue); rename them, or "
        "start "
        "from an example: wearwell new TRADE DIR",
        file, fmt::join(headings, ", ")));
  }
  return *study;
}

int run_from(NewOptions options, Models models) {
  if (!options.trade.empty() && options.folder.empty()) {
    // One word is the folder, where it is no trade.
    const bool known = std::any_of(models.begin(), models.end(),
                                   [&](const Model& each) { return each.trade == options.trade; });
    if (!known) options.folder = std::exchange(options.trade, "");
  }
  if (!options.trade.empty() && !model_of(models, options.trade).first_study)
    throw InputError(
        fmt::format("--from: no study of a {} is guessed from one table; start from the "
                    "example: wearwell new {} DIR",
                    options.trade, options.trade));
  if (options.folder.empty()) options.folder = options.from.stem().string() + "-study";
  const Table table = read_table(options.from);
  const FirstStudy first = guessed(options, models, table);
  const fs::path study = write_first_study(first, options.from, options.folder);
  std::string text = "From the headings:\n";
  for (const std::string& each : first.taken) text += wrapped(each, 2, 4);
  if (!first.guesses.empty()) text += "Look at what is a guess:\n";
  for (const std::string& each : first.guesses) text += wrapped(each, 2, 4);
  if (!first.unstated.empty()) text += "State what no heading says:\n";
  for (const std::string& each : first.unstated) text += wrapped(each, 2, 4);
  fmt::print("{}", printable_lines(text));
  try {
    read_study(source_of(study), models)->in_words();
  } catch (const InputError& error) {
    fmt::print("It does not run yet:\n{}Correct {}, then run: wearwell check {}\n",
               wrapped(printable(error.what()), 2, 4), study.string(), study.string());
    return 1;
  }
  fmt::print("Now run: wearwell check {0} && wearwell fit {0}\n", study.string());
  return 0;
}

}  // namespace

void add_new_command(CLI::App& app, Models models, int& exit_code) {
  auto options = std::make_shared<NewOptions>();
  CLI::App* command =
      app.add_subcommand("new", "Write a commented study: an example, or one for your own table");
  std::vector<std::string> trades;
  for (const Model& model : models) trades.emplace_back(model.trade);
  command
      ->add_option("TRADE", options->trade,
                   fmt::format("What to start from: {}", fmt::join(trades, ", ")))
      ->type_name(fmt::format("TEXT:{}", fmt::join(trades, "|")));
  command->add_option("DIR", options->folder,
                      "Folder for it: new or empty (with --from: FILE-study if not said)");
  command->add_option("--from", options->from,
                      "Guess columns and units from the headings of FILE, and copy it there");
  command->footer(
      "Examples:\n  wearwell new joint my-joint && wearwell fit my-joint/study.toml\n"
      "  wearwell new --from lives.csv\n  wearwell new fatigue my-lives --from lives.csv\n\n"
      "Exit codes: 0 done; 1 the study that was guessed needs a hand before it runs; 2 the request "
      "is "
      "wrong, nothing written.");
  command->callback([options, models, &exit_code] {
    if (!options->from.empty()) {
      exit_code = run_from(*options, models);
      return;
    }
    if (options->trade.empty()) throw CLI::RequiredError("TRADE");
    const Model& model = model_of(models, options->trade);
    if (options->folder.empty()) throw CLI::RequiredError("DIR");
    const std::filesystem::path study = write_example(model, options->folder);
    fmt::print("Now run: wearwell fit {}\n", study.string());
    exit_code = 0;
  });
}

}  // namespace wearwell
