#include "wearwell/models/recurrence/recurrence_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/models/recurrence/mean_cumulative.h"
#include "wearwell/models/recurrence/projection_report.h"
#include "wearwell/models/recurrence/recurrence_classical.h"
#include "wearwell/models/recurrence/trend_tests.h"
#include "wearwell/present/plain.h"
#include "wearwell/present/text_table.h"
#include "wearwell/study/plot_study.h"

namespace wearwell::recurrence {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t most_units = 1000;  // with a forecast of their own
constexpr Eigen::Index draws_of_units = 400;

const char* process_name(ProcessKind kind) {
  switch (kind) {
    case ProcessKind::power_law:
      return "power_law";
    case ProcessKind::renewal:
      return "renewal";
    case ProcessKind::phases:
      return "phases";
  }
  return "";
}

present::Table mcf_table(const Asked& asked, const std::vector<MeanCumulativeStep>& steps) {
  present::Table table{"mcf",
                       fmt::format("Mean cumulative function: failures per unit until each age "
                                   "(Nelson), bounds hold {} pointwise",
                                   asked.interval_name()),
                       {{"age", asked.data.unit.text, present::given},
                        {"failures", "1", present::given},
                        {"units at risk", "1", present::given},
                        {"failures per unit", "1"},
                        {"standard error", "1"},
                        {asked.interval_name(), "1", {}, true}}};
  for (const MeanCumulativeStep& step : steps)
    table.rows.push_back({from_si(asked.data.unit, step.age), present::count(step.failures),
                          present::count(step.at_risk), step.mean, step.se,
                          present::Range{step.low, step.high}});
  return table;
}

struct NamedTest {
  std::string key, name, question;
  TrendTest test;
};

std::vector<NamedTest> classical_tests(const Asked& asked, const WeightedDraws& draws) {
  const std::vector<UnitHistory>& units = asked.data.units;
  std::vector<NamedTest> tests = {
      {"laplace", "Laplace", "is the intensity constant?", laplace_test(units)}};
  if (units.front().grouped)
    tests.push_back({"chi_square", "Chi-square", "is it a power law?",
                     grouped_power_law_test(asked.data.gaps)});
  else
    tests.push_back({"cramer_von_mises", "Cramer-von Mises", "is it a power law?",
                     cramer_von_mises_test(units)});
  if (!asked.process.minimal_repair()) return tests;
  std::vector<double> x;  // posterior medians
  for (Eigen::Index k = 0; k < draws.values.cols(); ++k)
    x.push_back(QuantityDistribution(draws, [k](const double* p) { return p[k]; }).quantile(0.5));
  std::vector<double> weights;
  for (const UnitHistory& unit : units)
    weights.push_back(asked.process.mean_by(x.data(), unit.end) -
                      asked.process.mean_by(x.data(), unit.start));
  tests.push_back(
      {"dispersion", "Dispersion", "are the units alike?", dispersion_test(units, weights)});
  return tests;
}

present::Table test_table(const std::vector<NamedTest>& tests) {
  present::Table table{"trend-tests",
                       "Classical tests; a small p is evidence that the answer is no",
                       {{"test", "1"},
                        {"question", "1"},
                        {"statistic", "1", present::digits(4)},
                        {"p", "1", present::digits(2)},
                        {"failures", "1", present::given},
                        {"remark", "1"}}};
  for (const NamedTest& each : tests) {
    if (!each.test.problem.empty()) {
      table.rows.push_back(
          {each.name, each.question, {}, {}, {}, "does not apply: " + each.test.problem});
    } else {
      table.rows.push_back({each.name,
                            each.question,
                            each.test.statistic,
                            each.test.p,
                            present::count(each.test.failures),
                            {}});
    }
  }
  return table;
}

// Crow's parameters in the unit of the data; lambda has the unit age^-beta.
present::Table crow_table(const Asked& asked, const WeightedDraws& draws) {
  present::Table table{
      "crow-amsaa",
      "Crow-AMSAA: lambda t^beta expected failures of one unit until age t, t in " +
          asked.data.unit.text,
      {{"quantity", "1"}, {"median", "1"}, {asked.interval_name(), "1", {}, true}}};
  const double reference = from_si(asked.data.unit, asked.process.reference);
  const auto add = [&](const char* name, const Function& value) {
    const QuantityDistribution known(draws, value);
    table.rows.push_back(
        {name, known.quantile(0.5),
         present::Range{known.quantile(asked.outside()), known.quantile(1 - asked.outside())}});
  };
  add("lambda", [=](const double* x) { return x[1] * std::pow(reference, -x[0]); });
  add("growth rate, 1 - beta", [](const double* x) { return 1 - x[0]; });
  return table;
}

std::vector<present::Column> forecast_columns(const std::string& interval) {
  return {{"of", "1"},
          {"from", "1"},
          {"next", "1"},
          {"expected failures", "1"},
          {interval + " of the expected", "1", {}, true},
          {interval + " of the number", "1", present::given, true},
          {"at least one", "%", present::digits(3)}};
}

std::vector<present::Cell> forecast_cells(const std::string& of, const std::string& from,
                                          const Quantity& ahead, const Forecast& f) {
  return {of,
          from,
          given_quantity(ahead),
          f.expected,
          present::Range{f.low, f.high},
          present::Range{f.count_low, f.count_high},
          100 * f.any};
}

Json forecast_json(const std::string& of, const std::string& from, const Quantity& ahead,
                   const Forecast& f) {
  return {{"of", of},
          {"from", from},
          {"next", ahead.value},
          {"unit", ahead.unit.text},
          {"expected", f.expected},
          {"expected_q05", f.low},
          {"expected_q95", f.high},
          {"number_q05", f.count_low},
          {"number_q95", f.count_high},
          {"at_least_one", f.any}};
}

// At the level that the study states, on its sides.
Json bounds_json(const Forecast& f, BoundSides sides) {
  Json json;
  if (has_lower(sides)) json.update({{"expected_lower", f.low}, {"number_lower", f.count_low}});
  if (has_upper(sides)) json.update({{"expected_upper", f.high}, {"number_upper", f.count_high}});
  return json;
}

struct Forecasts {
  present::Table table, units;
  Json json = Json::array();
  std::vector<std::vector<std::string>> lines;  // for a terminal
};

Forecasts forecasts_of(const Asked& asked, const WeightedDraws& draws) {
  Forecasts all;
  const std::string interval = asked.interval_name();
  const double outside = asked.outside();
  all.table = {"forecast", "Failures to come; the number is a whole number",
               forecast_columns(interval)};
  all.units = {"unit-forecasts", "Failures to come of each unit", forecast_columns(interval)};
  all.lines = {
      {"  of", "from", "next", "expected", interval + " of the number", "at least one [%]"}};
  const WeightedDraws few = thinned(draws, draws_of_units);
  for (const Quantity& ahead : asked.ahead) {
    for (const ForecastRow& row : asked.rows) {
      const Forecast f = forecast(asked.process, draws, row.units, ahead.si(), outside);
      all.table.rows.push_back(forecast_cells(row.of, row.from, ahead, f));
      all.json.push_back(
          forecast_json(row.of, row.from, ahead,
                        asked.levels ? forecast(asked.process, draws, row.units, ahead.si()) : f));
      if (asked.levels) all.json.back()["bounds"] = bounds_json(f, asked.levels->sides);
      all.lines.push_back(
          {"  " + row.of, row.from, given_quantity(ahead), plain_number(f.expected, 4),
           fmt::format("{} to {}", plain_given(f.count_low), plain_given(f.count_high)),
           plain_number(100 * f.any, 3)});
    }
    const std::vector<UnitHistory>& units = asked.data.units;
    for (std::size_t i = 0; i < std::min(units.size(), most_units) && units.size() > 1; ++i) {
      const Forecast f =
          forecast(asked.process, few, {state_at_end(units[i])}, ahead.si(), outside);
      const std::string from = fmt::format(
          "age {} {}, {} failure{} so far", age_number(from_si(asked.data.unit, units[i].end)),
          asked.data.unit.text, units[i].failures.size(), units[i].failures.size() == 1 ? "" : "s");
      all.units.rows.push_back(forecast_cells(units[i].name, from, ahead, f));
    }
  }
  return all;
}

std::string tests_text(const std::vector<NamedTest>& tests) {
  std::string text;
  for (const NamedTest& each : tests)
    text += wrapped(
        each.test.problem.empty()
            ? fmt::format("{} ({}): {}, p = {}", each.name, each.question,
                          plain_number(each.test.statistic, 4), plain_number(each.test.p, 2))
            : fmt::format("{} ({}): does not apply: {}", each.name, each.question,
                          each.test.problem),
        2, 4);
  return text;
}

Json tests_json(const std::vector<NamedTest>& tests) {
  Json json;
  for (const NamedTest& each : tests) {
    if (!each.test.problem.empty()) {
      json[each.key] = {{"problem", each.test.problem}};
    } else {
      json[each.key] = {
          {"statistic", each.test.statistic}, {"p", each.test.p}, {"failures", each.test.failures}};
    }
  }
  return json;
}

// All but the forecasts.
Json data_json(const Asked& asked, const WeightedDraws& draws, const std::vector<NamedTest>& tests,
               const std::vector<MeanCumulativeStep>& steps) {
  Json json = {{"process", process_name(asked.process.kind)},
               {"units", asked.data.units.size()},
               {"failures", asked.data.failures()},
               {"age_unit", asked.data.unit.text}};
  if (asked.process.kind == ProcessKind::power_law)
    json["reference_age"] = from_si(asked.data.unit, asked.process.reference);
  if (asked.process.kind != ProcessKind::phases)
    json["probability_beta_above_1"] =
        1 - QuantityDistribution(draws, [](const double* x) { return x[0]; }).cdf(1);
  if (asked.levels) {
    json["level"] = asked.levels->credible_level;
    json["sides"] = asked.levels->sides == BoundSides::both    ? "both"
                    : asked.levels->sides == BoundSides::upper ? "upper"
                                                               : "lower";
  }
  json["tests"] = tests_json(tests);
  json["mcf"] = Json::array();
  for (const MeanCumulativeStep& step : steps)
    json["mcf"].push_back({{"age", from_si(asked.data.unit, step.age)},
                           {"failures", step.failures},
                           {"at_risk", step.at_risk},
                           {"mean", step.mean},
                           {"se", step.se},
                           {"low", step.low},
                           {"high", step.high}});
  json["unobserved"] = Json::array();
  for (const auto& [from, to] : unobserved_ages(asked.data.units))
    json["unobserved"].push_back(
        {{"from", from_si(asked.data.unit, from)}, {"to", from_si(asked.data.unit, to)}});
  return json;
}

}  // namespace

std::string Asked::interval_name() const {
  if (!levels) return "90 %";
  const std::string percent = fmt::format("{:.6g} %", 100 * levels->credible_level);
  return levels->sides == BoundSides::both ? percent : "one-sided " + percent;
}

std::string given_quantity(const Quantity& quantity) {
  return fmt::format("{} {}", plain_given(quantity.value), quantity.unit.text);
}

std::string age_number(double in_unit) {
  return plain_given(std::stod(fmt::format("{:.6g}", in_unit)));
}

std::string age_text(const RecurrenceData& data, double si) {
  return fmt::format("{} {}", age_number(from_si(data.unit, si)), data.unit.text);
}

std::string unobserved_text(const Asked& asked) {
  std::string text;
  const Unit& unit = asked.data.unit;
  for (const auto& [from, to] : unobserved_ages(asked.data.units))
    text += fmt::format("{}between {} and {} {}", text.empty() ? "" : ", ",
                        age_number(from_si(unit, from)), age_number(from_si(unit, to)), unit.text);
  return text;
}

PresetAddition recurrence_addition(const Asked& asked, const Fit& fit) {
  const WeightedDraws& draws = fit.exact ? fit.exact->nodes : fit.pooled;
  PresetAddition added;
  const std::vector<NamedTest> tests = classical_tests(asked, draws);
  const std::vector<MeanCumulativeStep> steps =
      mean_cumulative(asked.data.units, 1 - 2 * asked.outside());
  Json json = data_json(asked, draws, tests, steps);
  const std::string gaps = unobserved_text(asked);
  if (asked.process.kind == ProcessKind::power_law)
    added.blocks["parameters"].push_back({crow_table(asked, draws)});
  added.blocks["fit"].push_back({test_table(tests)});
  added.blocks["fit"].push_back({mcf_table(asked, steps)});
  if (!gaps.empty())
    added.blocks["fit"].push_back({present::Prose{fmt::format(
        "No unit was observed {}: the mean cumulative function lacks the failures there.", gaps)}});
  if (!asked.ahead.empty()) {
    const Forecasts all = forecasts_of(asked, draws);
    added.blocks["predictions"].push_back({all.table});
    if (!all.units.rows.empty()) added.blocks["predictions"].push_back({all.units});
    if (asked.data.units.size() > most_units)
      added.blocks["predictions"].push_back(
          {present::Prose{fmt::format("The table of units has the first {} of {} units.",
                                      most_units, asked.data.units.size())}});
    json["forecast"] = all.json;
    added.text += "Failures to come\n" + text_table(all.lines) + "\n";
  }
  added.text += "Classical tests\n" + tests_text(tests);
  if (!gaps.empty())
    added.text += wrapped(
        fmt::format(
            "No unit was observed {}: the mean cumulative function lacks the failures there.",
            gaps),
        2, 4);
  added.body["repairable"] = std::move(json);
  if (asked.growth_test) add_projection(asked, *asked.growth_test, added);
  if (asked.classical) add_classical(asked, fit, added);
  return added;
}

}  // namespace wearwell::recurrence
