#include "wearwell/cli/new_from.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cstdio>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/base/printable.h"
#include "wearwell/cli/first_selection.h"
#include "wearwell/cli/table_question.h"
#include "wearwell/input/date_text.h"
#include "wearwell/input/workbook.h"
#include "wearwell/present/text_table.h"
#include "wearwell/study/example.h"
#include "wearwell/study/guessed_studies.h"

namespace wearwell {
namespace {

namespace fs = std::filesystem;

constexpr const char* selection = "select";  // not a study, but a command

std::string settings_text(const NewOptions& options) {
  return data_lines(options.table, options.wide);
}

// The given command with these further options.
std::string command(const NewOptions& options, const std::vector<std::string>& more = {}) {
  std::string text = "wearwell new";
  const auto add = [&](const std::string& word) { text += " " + shell_word(word); };
  if (!options.preset.empty()) add(options.preset);
  if (!options.folder.empty()) add(options.folder.string());
  text += " --from";
  add(options.from.string());
  for (const auto& [key, value] : options.table) {
    add(option_of(key));
    add(value);
  }
  for (const std::string& each : options.columns) {
    add("--column");
    add(each);
  }
  if (options.failure) text += fmt::format(" --failure {}", *options.failure);
  if (!options.limit.empty()) {
    add("--limit");
    add(options.limit);
  }
  for (const std::string& each : more) add(each);
  return text;
}

// Applies the options of a reading as if the user had given them.
void choose(NewOptions& options, const std::vector<std::string>& words) {
  for (std::size_t i = 0; i + 1 < words.size(); i += 2) {
    if (words[i] == "--column") options.columns.push_back(words[i + 1]);
    if (words[i] == "--failure") options.failure = std::stoi(words[i + 1]);
    if (words[i] == "--sheet") options.table["sheet"] = words[i + 1];
    if (words[i] == "PRESET") options.preset = words[i + 1];
  }
}

// Throws the question where no terminal is there to answer it.
struct Unanswered {
  std::string text;
};

void ask(NewOptions& options, const TableQuestion& question) {
  if (is_somebody_there()) {
    choose(options, question.readings[read_choice(question)].options);
    return;
  }
  std::vector<std::string> commands;
  for (const TableReading& each : question.readings) {
    NewOptions chosen = options;
    choose(chosen, each.options);
    commands.push_back(command(chosen));
  }
  throw Unanswered{as_refusal(question, commands)};
}

// The table; empty where the user was asked for the sheet and the answer is in `options`.
std::optional<Table> read_from(NewOptions& options) {
  options.wide.reset();
  try {
    const std::string text = settings_text(options);
    const TableSettings settings =
        text.empty() ? TableSettings()
                     : read_table_settings(TomlReader::parse({"options of the table", text}));
    const Table table = read_table(options.from, {}, {}, settings);
    options.wide = options.columns.empty() ? wide_table(table) : std::nullopt;
    return options.wide ? read_table(options.from, options.wide->sql, {}, settings) : table;
  } catch (const SeveralSheets& several) {
    TableQuestion question{fmt::format("{} has several sheets.", options.from.filename().string()),
                           {}};
    for (const std::string& each : several.names)
      question.readings.push_back({fmt::format("sheet '{}'", each), {"--sheet", each}});
    ask(options, question);
    return {};
  } catch (const InputError& error) {
    const std::string message = error.what();
    if (message.find("[data]") == message.npos) throw;
    std::vector<std::string> names;
    for (const auto& [key, help] : table_keys) names.push_back(option_of(key));
    throw InputError(
        fmt::format("{}. Until the study exists, keys of [data] are options of wearwell new: {}",
                    message, fmt::join(names, ", ")));
  }
}

TableChoices choices_of(const NewOptions& options, const Table& table) {
  TableChoices choices;
  choices.failure = options.failure;
  choices.limit = options.limit;
  choices.settings = settings_text(options);
  if (!options.limit.empty() && !std::isdigit(static_cast<unsigned char>(options.limit.front())))
    throw InputError(fmt::format("--limit: '{}' is not a quantity like '100 um'", options.limit));
  for (const std::string& each : options.columns) choose_column(table, each, choices);
  return choices;
}

std::vector<GuessedStudy> candidates(const NewOptions& options, Models models, const Table& table,
                                     const TableChoices& choices) {
  return guessed_studies(models, table, options.from.filename().string(), choices, options.preset,
                         {{selection, first_selection}});
}

[[noreturn]] void refuse_all(const NewOptions& options, const Table& table) {
  std::vector<std::string> headings;
  for (const Column& column : table.columns) headings.push_back(column.name);
  const std::string file = options.from.filename().string();
  std::string dates = columns_of_dates(table);
  if (!dates.empty())
    dates += fmt::format(
        ", not numbers: run wearwell open {} and choose dates in a heading, which makes a time of "
        "them, or add a column such as 'life [d]'; without a time ",
        shell_word(options.from.string()));
  throw InputError(fmt::format(
      "{}: {}no study{} follows from its headings ({}){}. A study needs lives (life, cycles to "
      "failure, or hours with a status), a measurement (wear, volume, mass, crack) against cycles, "
      "time or distance, stresses and lives, or a response with inputs. Name the columns, for "
      "example wearwell new --from {} --column life={}, or start from an example: wearwell new "
      "PRESET DIR",
      file, dates, options.preset.empty() ? "" : " of a " + options.preset,
      fmt::join(headings, ", "),
      options.columns.empty() ? ""
                              : fmt::format(" with --column {}", fmt::join(options.columns, ", ")),
      shell_word(file), shell_word(headings.front())));
}

// An option without effect is a mistake.
void require_used(const NewOptions& options, const Scaffold& study) {
  const auto refuse = [&](const char* option, const char* what) {
    throw InputError(fmt::format("{}: {} is read as {}, which has no {}", option,
                                 options.from.filename().string(), study.reading, what));
  };
  if (!options.limit.empty() && study.text.find(toml_text(options.limit)) == std::string::npos)
    refuse("--limit", "guessed failure threshold; state it in the study");
  if (options.failure && study.text.find("failure = ") == std::string::npos)
    refuse("--failure", "column of codes for how a life ended");
}

// The best reading; empty where the user was asked and the answer is in `options`.
std::optional<std::vector<GuessedStudy>> chosen(NewOptions& options, Models models,
                                                const Table& table) {
  const TableChoices choices = choices_of(options, table);
  std::vector<GuessedStudy> found = candidates(options, models, table, choices);
  if (found.empty()) refuse_all(options, table);
  const std::size_t best = equally_good(found);
  if (best > 1) {
    TableQuestion question{
        fmt::format("{} can be read in several ways.", options.from.filename().string()), {}};
    for (const GuessedStudy& each : found) {
      question.readings.push_back(
          {fmt::format("{}: {}", each.preset, each.study.reading), {"PRESET", each.preset}});
    }
    ask(options, question);
    return {};
  }
  if (!found.front().study.questions.empty()) {
    ask(options, found.front().study.questions.front());
    return {};
  }
  require_used(options, found.front().study);
  if (options.wide) {
    for (GuessedStudy& each : found)
      each.study.guesses.insert(each.study.guesses.begin(), wide_description(*options.wide));
  }
  return found;
}

std::string listed(const char* title, const std::vector<std::string>& lines) {
  if (lines.empty()) return "";
  std::string text = fmt::format("{}:\n", title);
  for (const std::string& each : lines) text += wrapped(each, 2, 4);
  return text;
}

// Under a message may stand the line of the study, with a mark: these keep their columns.
std::string problem_text(std::string_view message) {
  const std::size_t end = std::min(message.find('\n'), message.size());
  std::string text = wrapped(printable(message.substr(0, end)), 2, 4);
  if (end < message.size()) text += printable_lines(message.substr(end + 1)) + "\n";
  return text;
}

std::string description(const NewOptions& options, const std::vector<GuessedStudy>& found) {
  const Scaffold& first = found.front().study;
  std::vector<std::string> others;
  for (std::size_t i = 1; i < found.size(); ++i) {
    NewOptions other = options;
    other.preset = found[i].preset;
    other.folder = options.from.stem().string() + "-" + other.preset;
    others.push_back(fmt::format("{}: {}", found[i].study.reading, command(other)));
  }
  return fmt::format("Read as {}.\n", first.reading) + listed("From the headings", first.taken) +
         listed("Check these guesses", first.guesses) +
         listed("State what no heading tells", first.unstated) +
         listed("Other readings of this table", others);
}

int run(NewOptions options, Models models) {
  const auto is_preset = [&](const std::string& word) {
    return word == selection || std::any_of(models.begin(), models.end(),
                                            [&](const Model& each) { return each.preset == word; });
  };
  // A single word is the folder, unless it names an application.
  if (!options.preset.empty() && options.folder.empty() && !is_preset(options.preset))
    options.folder = std::exchange(options.preset, "");
  if (!options.preset.empty() && options.preset != selection &&
      !model_of(models, options.preset).scaffold)
    throw InputError(
        fmt::format("--from: a study of a {} cannot be guessed from one table; start from the "
                    "example: wearwell new {} DIR",
                    options.preset, options.preset));
  std::optional<std::vector<GuessedStudy>> found;
  while (!found) {
    const auto table = read_from(options);
    if (table) found = chosen(options, models, *table);
  }
  const Scaffold& first = found->front().study;
  fmt::print("{}", printable_lines(description(options, *found)));
  if (found->front().preset == selection) {
    if (!options.table.empty())
      throw InputError("wearwell select reads plain tables: save the sheet or range as a CSV file");
    fmt::print("Now run: wearwell select {} {}\n", shell_word(options.from.string()),
               printable(first.text));
    return 0;
  }
  if (options.folder.empty()) options.folder = options.from.stem().string() + "-study";
  const fs::path study = write_scaffold(first, options.from, options.folder);
  const std::string file = shell_word(study.string());
  try {
    read_study(source_of(study), models)->description();
  } catch (const InputError& error) {
    fmt::print(
        "The study does not run yet:\n"
        "{}Correct {}, then run: wearwell check {}\n",
        problem_text(error.what()), study.string(), file);
    return 1;
  }
  fmt::print(
      "Now run: wearwell fit {0}    (wearwell check {0} describes the model without fitting)\n",
      file);
  return 0;
}

}  // namespace

std::string option_of(const std::string& key) {
  std::string option = "--" + key;
  std::replace(option.begin(), option.end(), '_', '-');
  return option;
}

const Model& model_of(Models models, const std::string& preset) {
  const auto found = std::find_if(models.begin(), models.end(),
                                  [&](const Model& each) { return each.preset == preset; });
  if (found != models.end()) return *found;
  std::vector<std::string> presets;
  for (const Model& model : models) presets.emplace_back(model.preset);
  throw InputError(fmt::format("PRESET: '{}' is not allowed; use one of {}{}", preset,
                               fmt::join(presets, ", "), did_you_mean(preset, presets)));
}

int run_from(NewOptions options, Models models) {
  try {
    return run(std::move(options), models);
  } catch (const Unanswered& question) {
    fmt::print(stderr, "wearwell: {}\n", printable_lines(question.text));
    return 2;
  }
}

}  // namespace wearwell
