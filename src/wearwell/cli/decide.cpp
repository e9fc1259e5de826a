#include "wearwell/cli/decide.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/cli/lives_input.h"
#include "wearwell/cli/option_rules.h"
#include "wearwell/input/option_value.h"
#include "wearwell/present/page.h"
#include "wearwell/present/result_folder.h"
#include "wearwell/prognosis/decisions_report.h"
#include "wearwell/prognosis/money.h"
#include "wearwell/prognosis/next_reading.h"
#include "wearwell/prognosis/quantity_like.h"

namespace wearwell {
namespace prognosis {
namespace {

struct DecideOptions {
  LivesOptions lives;
  std::filesystem::path output;
  std::string failure, replacement, inspection, downtime, month, unit, after, claims;
  std::vector<std::string> given;
  int months = 12;
  double service = 95;
  bool json = false;
};

Question question_of(const DecideOptions& options, const Unit& axis) {
  Question question;
  Currency currency;
  question.costs.failure = amount("--failure-cost", options.failure, currency);
  question.costs.replacement = amount("--replacement-cost", options.replacement, currency);
  if (question.costs.replacement <= 0)
    throw InputError("--replacement-cost: must be above 0; otherwise waiting saves nothing");
  if (!options.inspection.empty()) {
    question.costs.inspection = amount("--inspection-cost", options.inspection, currency);
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
    question.hidden = amount_per("--downtime-cost", options.downtime, axis, currency);
  }
  if (!options.month.empty())
    question.per_month = quantity_like("--month", options.month, axis, Allowed::positive);
  question.currency = currency.text;
  question.months = options.months;
  question.service = options.service / 100;
  if (!options.claims.empty()) {
    question.claims = option_value("--claims", options.claims, "1", Allowed::positive);
    if (!(*question.claims < 1))
      throw InputError(fmt::format("--claims: {} must lie between 0 and 100 %", options.claims));
  }
  return question;
}

// The value of another reading of one unit.
WorthReport worth_of(const DecideOptions& options, const FollowedUnits& units,
                     const Question& question, double rate) {
  if (!units.tracker)
    throw InputError(
        "--inspect-after: a table of lives does not predict what a reading would show");
  if (!question.inspected) throw InputError("--inspect-after: needs --inspection-cost");
  const Tracker& tracker = *units.tracker;
  require_known(units, options.unit);
  const auto unit = units.unit(options.unit);
  const Forecast now = unit->forecast();
  WorthReport report;
  report.unit = options.unit;
  report.after =
      quantity_like("--inspect-after", options.after, tracker.axis().unit, Allowed::not_negative);
  const Reading reading = next_reading(tracker, now.now + report.after, options.given);
  const std::optional<std::size_t> measured = measured_column(tracker);
  if (!measured)
    throw InputError(
        fmt::format("--inspect-after: a reading of a {} shows only whether it has "
                    "failed",
                    tracker.noun()));
  report.column = tracker.columns()[*measured].name;
  report.reading_unit = tracker.columns()[*measured].unit;
  report.outcomes =
      possible_outcomes(tracker, *unit, reading, *measured, units.history(options.unit));
  report.worth = inspection_worth(now.remaining, now.passed, report.outcomes, report.after,
                                  question.costs, rate);
  return report;
}

int run_decide(const DecideOptions& options, Models models) {
  DecisionsReport report;
  if (options.unit.empty() != options.after.empty())
    throw InputError("--unit and --inspect-after go together; give both");
  LivesInput read = read_lives(options.lives, models);
  report.lives = std::move(read.lives);
  report.question = question_of(options, report.lives.unit);
  if (report.question.per_month && report.lives.units.empty())
    throw InputError("--month: there is no running unit to count");
  report.decisions = decide(report.lives, report.question);
  if (!options.unit.empty())
    report.worth = worth_of(options, read.followed(), report.question, report.decisions.reference);
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
      ->add_option("LIVES", options->lives.path,
                   "Folder that wearwell fit wrote for lives, for a formula model or bearings with "
                   "a failure threshold, or for S-N parts; configuration of a monitor (.toml) for "
                   "the units of its store; or a table of lives with column 'life [h]' and "
                   "optionally weight, unit, population")
      ->required();
  add_lives_options(*command, options->lives);
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
  command->add_option("--claims", options->claims,
                      "Share of units that may fail under warranty, '2 %': adds its length");
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
      "  wearwell decide life-results --failure-cost '800 EUR' --replacement-cost '120 EUR' \\\n"
      "    --claims '2 %' --in-service ages.csv --month '600 h'\n"
      "  wearwell decide fleet.toml --failure-cost 12 --replacement-cost 1 --month '600 h'\n"
      "  wearwell decide study-results --failure-cost 12 --replacement-cost 1 --inspection-cost "
      "0.1 \\\n"
      "    --unit 7 --inspect-after '5 km' --given 'force = 20 N'\n\n"
      "Exit codes: 0 done; 1 the study is not trusted; 2 the request is wrong, nothing written.");
  command->callback(
      [options, models, &exit_code] { exit_code = prognosis::run_decide(*options, models); });
}

}  // namespace wearwell
