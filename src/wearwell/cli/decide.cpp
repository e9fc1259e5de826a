#include "wearwell/cli/decide.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/base/printable.h"
#include "wearwell/cli/followed_result.h"
#include "wearwell/cli/monitored.h"
#include "wearwell/cli/option_rules.h"
#include "wearwell/input/option_value.h"
#include "wearwell/monitor/stored_units.h"
#include "wearwell/present/page.h"
#include "wearwell/present/result_folder.h"
#include "wearwell/prognosis/decisions_report.h"

namespace wearwell {
namespace prognosis {
namespace {

struct DecideOptions {
  std::filesystem::path lives, output;
  std::string failure, replacement, inspection, downtime, month, unit, after;
  std::vector<std::string> given;
  int months = 12;
  double service = 95;
  bool json = false;
};

// "12000 EUR": all amounts are in one currency, or in none.
double amount(const std::string& option, const std::string& text, std::string& currency,
              bool& first) {
  const std::size_t end = text.find_first_of(" ");
  const double value = option_value(option, text.substr(0, end), "1", Allowed::not_negative);
  const std::size_t word = end == std::string::npos ? end : text.find_first_not_of(' ', end);
  const std::string said = word == std::string::npos ? "" : text.substr(word);
  if (first) {
    currency = said;
    first = false;
  } else if (said != currency) {
    throw InputError(fmt::format(
        "{}: '{}' is in another currency than '{}'; give all amounts in one, or all without",
        option, printable(text), currency.empty() ? "no currency" : printable(currency)));
  }
  return value;
}

// "50 EUR/h": an amount per unit of use.
double amount_per(const std::string& option, const std::string& text, const Unit& axis,
                  std::string& currency, bool& first) {
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos)
    throw InputError(fmt::format("{}: '{}' must be an amount per use, like '50 EUR/{}'", option,
                                 printable(text), axis.text));
  const std::string per = text.substr(slash + 1);
  double use = 0;
  try {
    use = read_unit(per, axis.text).scale;
  } catch (const InputError&) {
    throw InputError(fmt::format("{}: '{}' is not a unit like {}, in which lives are counted",
                                 option, printable(per), axis.text));
  }
  std::string before = text.substr(0, slash);
  while (!before.empty() && before.back() == ' ') before.pop_back();
  return amount(option, before, currency, first) / use;
}

// A number with a unit of the dimension of a known unit, in SI.
double like_value(const std::string& option, const std::string& text, const Unit& like,
                  Allowed allowed = Allowed::any) {
  Quantity quantity;
  try {
    quantity = read_quantity(text, like.text);
    refuse_two_readings(quantity, like);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: '{}' must be a number with a unit like {}: {}", option,
                                 printable(text), like.text, error.what()));
  }
  return checked_option(option, text, quantity.si(), allowed);
}

Question question_of(const DecideOptions& options, const Unit& axis) {
  Question question;
  bool first = true;
  question.costs.failure = amount("--failure-cost", options.failure, question.currency, first);
  question.costs.replacement =
      amount("--replacement-cost", options.replacement, question.currency, first);
  if (question.costs.replacement <= 0)
    throw InputError("--replacement-cost: must be above 0; otherwise waiting saves nothing");
  if (!options.inspection.empty()) {
    question.costs.inspection =
        amount("--inspection-cost", options.inspection, question.currency, first);
    question.inspected = true;
    if (question.costs.inspection <= 0)
      throw InputError(
          "--inspection-cost: must be above 0; otherwise the optimal interval is zero");
  }
  if (!options.downtime.empty()) {
    if (!question.inspected)
      throw InputError(
          "--downtime-cost: applies to failures that only an inspection shows; it needs "
          "--inspection-cost");
    question.hidden =
        amount_per("--downtime-cost", options.downtime, axis, question.currency, first);
  }
  if (!options.month.empty())
    question.per_month = like_value("--month", options.month, axis, Allowed::positive);
  question.months = options.months;
  question.service = options.service / 100;
  return question;
}

// All readings of a unit that its state has processed; the store outlives it.
History history_of(monitor::Store& store, const std::string& name, std::int64_t until) {
  return [&store, name, until](const std::function<void(const Reading&)>& visit) {
    store.of_unit(name, 0, until, [&](const monitor::StoredReading& each) {
      visit({each.numbers, each.labels});
    });
  };
}

struct Read {
  KnownLives lives;
  std::unique_ptr<const Tracker> tracker;  ///< of a result
  std::unique_ptr<monitor::Store> store;   ///< of a monitored fleet
  std::map<std::string, monitor::UnitRecord> stored = {};

  // A unit in its current state, with all its readings since the study.
  std::unique_ptr<TrackedUnit> unit(const std::string& name) const {
    const auto at = stored.find(name);
    return at == stored.end() ? tracker->begin(name) : tracker->restore(at->second.state->save());
  }
  History history(const std::string& name) const {
    const auto at = stored.find(name);
    if (at == stored.end()) return [](const std::function<void(const Reading&)>&) {};
    return history_of(*store, name, at->second.place);
  }
  std::vector<std::string> names() const {
    std::vector<std::string> all(tracker->seen().begin(), tracker->seen().end());
    for (const auto& [name, record] : stored) all.push_back(name);
    return all;
  }
};

// Units of a monitored fleet, as its store holds them.
void read_fleet(const DecideOptions& options, Models models, Read& read) {
  MonitoredFleet fleet = monitored_fleet(options.lives, models);
  try {
    read.store = store_to_read(fleet);
    read.stored =
        monitor::stored_units(*read.store, {*fleet.tracker, fleet.fingerprint, fleet.trusted});
  } catch (const monitor::StoreError& error) {
    throw MachineError(error.what());
  }
  read.lives = lives_of_new(*fleet.tracker, options.lives.string(), fleet.trusted);
  for (const auto& [name, record] : read.stored) {
    // `stored` must stay alive as long as lives are requested.
    const std::shared_ptr<const TrackedUnit> unit(std::shared_ptr<void>(), record.state.get());
    read.lives.units.push_back(known_unit(name, unit, history_of(*read.store, name, record.place)));
  }
  read.tracker = std::move(fleet.tracker);
}

Read read_lives(const DecideOptions& options, Models models) {
  Read read;
  if (options.lives.extension() == ".toml") {
    read_fleet(options, models, read);
    return read;
  }
  if (!std::filesystem::is_directory(options.lives)) {
    read.lives = lives_of_table(read_table(options.lives));
    return read;
  }
  FollowedResult result = followed_result(options.lives, models);
  read.tracker = std::move(result.tracker);
  read.lives = lives_of_tracker(*read.tracker, options.lives.string(), result.trusted);
  return read;
}

std::size_t column_at(const Tracker& tracker, const std::string& name) {
  std::vector<std::string> names;
  for (const ReadingColumn& each : tracker.columns()) {
    if (each.name == name) return names.size();
    names.push_back(each.name);
  }
  throw InputError(fmt::format("--given: there is no '{}'; it is one of {}{}", printable(name),
                               fmt::join(names, ", "), did_you_mean(name, names)));
}

// "force = 20 N": the conditions of the next reading.
void add_given(const Tracker& tracker, const std::string& text, Reading& reading) {
  const std::size_t sign = text.find('=');
  if (sign == std::string::npos)
    throw InputError(fmt::format("--given: '{}' must be like 'force = 20 N'", printable(text)));
  const auto trimmed = [](std::string word) {
    while (!word.empty() && word.back() == ' ') word.pop_back();
    return word.substr(std::min(word.find_first_not_of(' '), word.size()));
  };
  const std::string name = trimmed(text.substr(0, sign)), value = trimmed(text.substr(sign + 1));
  const auto labels = tracker.labels();
  const auto label = std::find(labels.begin(), labels.end(), name);
  if (label != labels.end()) {
    reading.labels[static_cast<std::size_t>(label - labels.begin())] = value;
    return;
  }
  const std::size_t column = column_at(tracker, name);
  reading.numbers[column] = like_value("--given", value, tracker.columns()[column].unit);
}

// The value of another reading of one unit.
WorthReport worth_of(const DecideOptions& options, const Read& read, const Question& question,
                     double rate) {
  if (!read.tracker)
    throw InputError(
        "--inspect-after: a table of lives does not predict what a reading would show");
  if (!question.inspected) throw InputError("--inspect-after: needs --inspection-cost");
  const Tracker& tracker = *read.tracker;
  const std::vector<std::string> known = read.names();
  if (std::find(known.begin(), known.end(), options.unit) == known.end())
    throw InputError(fmt::format("--unit: the {} has no {} '{}'{}", read.store ? "fleet" : "study",
                                 tracker.noun(), printable(options.unit),
                                 did_you_mean(options.unit, known)));
  const auto unit = read.unit(options.unit);
  const Forecast now = unit->forecast();
  WorthReport report;
  report.unit = options.unit;
  report.after =
      like_value("--inspect-after", options.after, tracker.axis().unit, Allowed::not_negative);
  const auto columns = tracker.columns();
  Reading reading{std::vector<double>(columns.size(), std::nan("")),
                  std::vector<std::string>(tracker.labels().size())};
  for (const std::string& each : options.given) add_given(tracker, each, reading);
  reading.numbers[column_at(tracker, tracker.axis().name)] = now.now + report.after;
  std::size_t measured = columns.size();
  for (std::size_t i = 0; i < columns.size() && measured == columns.size(); ++i)
    if (columns[i].measured) measured = i;
  report.column = columns[measured].name;
  report.reading_unit = columns[measured].unit;
  report.outcomes =
      possible_outcomes(tracker, *unit, reading, measured, read.history(options.unit));
  report.worth = inspection_worth(now.remaining, now.passed, report.outcomes, report.after,
                                  question.costs, rate);
  return report;
}

int run_decide(const DecideOptions& options, Models models) {
  DecisionsReport report;
  if (options.unit.empty() != options.after.empty())
    throw InputError("--unit and --inspect-after go together; give both");
  Read read = read_lives(options, models);
  report.lives = std::move(read.lives);
  report.question = question_of(options, report.lives.unit);
  if (report.question.per_month && report.lives.units.empty())
    throw InputError("--month: there is no running unit to count");
  report.decisions = decide(report.lives, report.question);
  if (!options.unit.empty())
    report.worth = worth_of(options, read, report.question, report.decisions.reference);
  std::optional<ResultFolder> folder;
  if (!options.output.empty()) folder.emplace(options.output);
  if (folder) {
    const std::vector<present::Section> sections = decisions_sections(report);
    folder->write("decisions.json", printable_json(decisions_json(report).dump(2)) + "\n");
    for (const present::Table* table : present::tables(sections))
      folder->write(fmt::format("tables/{}.csv", table->id), present::csv(*table));
    folder->write("report.html",
                  html_page({WEARWELL_VERSION, "Decisions", report.lives.title, sections}));
    folder->commit();
  }
  if (options.json) {
    fmt::print("{}\n", printable_json(decisions_json(report).dump(2)));
  } else {
    fmt::print("{}", decisions_text(report));
    if (folder) fmt::print("Results are in {}\n", options.output.string());
  }
  return report.lives.trusted ? 0 : 1;
}

}  // namespace
}  // namespace prognosis

void add_decide_command(CLI::App& app, Models models, int& exit_code) {
  auto options = std::make_shared<prognosis::DecideOptions>();
  CLI::App* command = app.add_subcommand(
      "decide", "Find the cheapest replacement age, inspection interval and stock of spare parts");
  command
      ->add_option("LIVES", options->lives,
                   "Folder that wearwell fit wrote for a formula model or bearings with a failure "
                   "threshold, or for S-N parts; configuration of a monitor (.toml) for the units "
                   "of its store; or a table of lives with column 'life [h]' and optionally "
                   "weight, unit, population")
      ->required();
  command
      ->add_option("--failure-cost", options->failure,
                   "Cost of a failure in service, including the replacement: '12000 EUR'")
      ->required();
  command
      ->add_option("--replacement-cost", options->replacement,
                   "Cost of a preventive replacement: '900 EUR'")
      ->required();
  command->add_option("--inspection-cost", options->inspection,
                      "Cost of one inspection; adds the optimal inspection interval");
  command->add_option("--downtime-cost", options->downtime,
                      "Cost of an undetected failure per use until the next inspection: '5 EUR/h'");
  command->add_option("--unit", options->unit,
                      "One unit of a result: adds the value of another reading of it");
  command->add_option("--inspect-after", options->after,
                      "Use from now until that reading is taken: '5 km'; '0 km' for now");
  command->add_option(
      "--given", options->given,
      "Conditions of that reading: 'force = 20 N', for each column that a reading needs");
  command->add_option(
      "--month", options->month,
      "Use of a unit per month, '600 h': adds the failures and spare parts per month");
  command->add_option("--months", options->months, "Number of months ahead")
      ->check(number_between(1, 600))
      ->capture_default_str();
  command
      ->add_option("--service-level", options->service,
                   "Probability that the spare parts suffice, %")
      ->check(number_between(1, 99.9999))
      ->capture_default_str();
  command->add_option("-o,--output", options->output, "Folder for the page, tables and JSON");
  command->add_flag("--json", options->json, "Print one JSON object and nothing else");
  command->footer(
      "Examples:\n"
      "  wearwell decide lives.csv --failure-cost '12000 EUR' --replacement-cost '900 EUR'\n"
      "  wearwell decide lives.csv --failure-cost 12 --replacement-cost 1 --inspection-cost 0.1 "
      "--month '600 h'\n"
      "  wearwell decide fleet.toml --failure-cost 12 --replacement-cost 1 --month '600 h'\n"
      "  wearwell decide study-results --failure-cost 12 --replacement-cost 1 --inspection-cost "
      "0.1 \\\n"
      "    --unit 7 --inspect-after '5 km' --given 'force = 20 N'\n\n"
      "Exit codes: 0 done; 1 the study is not trusted; 2 the request is wrong, nothing written.");
  command->callback(
      [options, models, &exit_code] { exit_code = prognosis::run_decide(*options, models); });
}

}  // namespace wearwell
