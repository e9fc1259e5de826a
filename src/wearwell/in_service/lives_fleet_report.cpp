#include "wearwell/in_service/lives_fleet_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "wearwell/base/printable.h"
#include "wearwell/in_service/fleet_tables.h"
#include "wearwell/input/parquet_writer.h"
#include "wearwell/math/quantile.h"
#include "wearwell/study/trust_blocks.h"

namespace wearwell::in_service {
namespace {

using present::digits;
using present::fixed;
using present::given;
using present::Prose;
using present::Range;
using present::Section;
using present::Table;
using prognosis::PopulationWeights;
using Json = nlohmann::ordered_json;

constexpr std::size_t worst_shown = 100;

// Units by the B10 of remaining life, ties by the median and by name.
std::vector<std::size_t> worst_first(const LivesFindings& found) {
  std::vector<std::size_t> order(found.rows.names.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const prognosis::FleetOutlook& out = found.outlook;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    if (out.b10[a] != out.b10[b]) return out.b10[a] < out.b10[b];
    if (out.median[a] != out.median[b]) return out.median[a] < out.median[b];
    return found.rows.names[a] < found.rows.names[b];
  });
  return order;
}

bool has_conditions(const LivesFindings& found) {
  return std::any_of(found.rows.sets.begin(), found.rows.sets.end(),
                     [](const ConditionSet& each) { return !each.description.empty(); });
}

double shown(const LivesFindings& found, double si) {
  return from_si(found.axis, si);
}

Table worst_table(const LivesFindings& found, const std::vector<std::size_t>& order) {
  const std::size_t count = std::min(worst_shown, order.size());
  const bool conditions = has_conditions(found);
  Table table{"worst",
              count == 1 ? std::string("The unit")
                         : fmt::format("The {} units with the shortest remaining life", count),
              {{"Unit"}, {"Age", found.axis.text, digits(5)}}};
  if (conditions) table.columns.push_back({"Conditions"});
  for (const double each : found.horizons)
    table.columns.push_back({"Fails within " + horizon_text(found.axis, each), "%", digits(3)});
  table.columns.push_back({"Remaining life, B10", found.axis.text, present::life(4)});
  table.columns.push_back({"Median", found.axis.text, present::life(4)});
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t u = order[i];
    std::vector<present::Cell>& row = table.rows.emplace_back();
    row = {found.rows.names[u], shown(found, found.rows.units.age[u])};
    if (conditions) row.push_back(found.rows.sets[found.rows.units.group[u]].description);
    for (const auto& each : found.outlook.failing) row.push_back(100 * each[u]);
    row.push_back(shown(found, found.outlook.b10[u]));
    row.push_back(shown(found, found.outlook.median[u]));
  }
  return table;
}

Table spread_table(const LivesFindings& found) {
  Table table{"spread", "Quantiles over the fleet", {{"Of each unit"}}};
  constexpr double levels[] = {0.05, 0.25, 0.5, 0.75, 0.95};
  for (const double p : levels)
    table.columns.push_back({fmt::format("{:g} %", 100 * p), "1", digits(4)});
  const auto add = [&](const std::string& name, std::vector<double> values, double scale) {
    std::sort(values.begin(), values.end());
    table.rows.push_back({name});
    for (const double p : levels) table.rows.back().push_back(quantile(values, p) / scale);
  };
  const std::string unit = found.axis.text;
  add(fmt::format("age [{}]", unit), found.rows.units.age, found.axis.scale);
  for (std::size_t h = 0; h < found.horizons.size(); ++h)
    add(fmt::format("fails within {} [%]", horizon_text(found.axis, found.horizons[h])),
        found.outlook.failing[h], 0.01);
  add(fmt::format("remaining life, B10 [{}]", unit), found.outlook.b10, found.axis.scale);
  add(fmt::format("remaining life, median [{}]", unit), found.outlook.median, found.axis.scale);
  return table;
}

Table sets_table(const LivesFindings& found) {
  Table table{"conditions",
              "Units by their conditions",
              {{"Conditions"}, {"Units", "1", fixed(0)}, {"Outside the tests"}}};
  for (const ConditionSet& set : found.rows.sets) {
    std::string outside;
    std::size_t number = 0;
    for (const UnitColumns::Given& each : found.columns.conditions) {
      if (each.condition.si.empty()) continue;
      const double x = set.values[number++];
      if (x >= each.condition.low && x <= each.condition.high) continue;
      outside += (outside.empty() ? "" : ", ") + each.condition.name;
    }
    table.rows.push_back({set.description, present::count(set.units), outside});
  }
  return table;
}

Check population_check(const LivesFindings& found) {
  const PopulationWeights& population = found.outlook.population;
  const std::vector<char>& in_study = found.rows.units.in_study;
  if (std::all_of(in_study.begin(), in_study.end(), [](char each) { return each != 0; }))
    return {"population", Verdict::pass,
            fmt::format("failures are counted over {} points of the population; the study has the "
                        "survival of all units",
                        found.points),
            ""};
  if (population.resolved)
    return {"population", Verdict::pass,
            fmt::format("failures are counted over {} points of the population, weighted by the "
                        "survival of the units to their ages (effective number {:.1f})",
                        found.points, population.effective),
            ""};
  return {"population", Verdict::warn,
          fmt::format("the survival of the units is more evidence on the population than its {} "
                      "points resolve (effective number {:.1f}): the numbers of failures rest on "
                      "the population as the study has it, the numbers of each unit on that with "
                      "its own survival",
                      found.points, population.effective),
          "Fit with these units as run-outs, beside the failures that happened (wearwell update), "
          "and give --in-study."};
}

Check extrapolation_check_of(const LivesFindings& found) {
  Findings findings("extrapolation");
  const std::string advice =
      "These numbers rest on the distribution and its relation to the conditions, not on data.";
  std::size_t old = 0, later = 0;
  const double last = found.horizons.back();
  for (const double age : found.rows.units.age) {
    old += age > found.longest_seen;
    later += age + last > found.longest_seen;
  }
  add_units_beyond(findings, old, later, "older than the longest life in the study",
                   {found.axis, found.longest_seen, last}, advice);
  std::size_t number = 0;
  for (const UnitColumns::Given& each : found.columns.conditions) {
    const Condition& condition = each.condition;
    if (condition.si.empty()) continue;
    std::size_t outside = 0;
    for (const ConditionSet& set : found.rows.sets)
      if (set.values[number] < condition.low || set.values[number] > condition.high)
        outside += set.units;
    ++number;
    if (outside == 0) continue;
    findings.add(Verdict::warn,
                 fmt::format("{} a {} outside the study's {:.6g} to {:.6g} {}",
                             outside == 1 ? "1 unit has" : fmt::format("{} units have", outside),
                             condition.name, from_si(condition.unit, condition.low),
                             from_si(condition.unit, condition.high), condition.unit.text),
                 advice);
  }
  return findings.result("ages, horizons and conditions lie within the study");
}

std::vector<Check> checks_of(const LivesFindings& found, bool skip_bad) {
  std::vector<Check> checks;
  checks.push_back(fit_check(found.trusted_fit));
  checks.push_back(population_check(found));
  checks.push_back(extrapolation_check_of(found));
  if (skip_bad) checks.push_back(left_out_check(found.rows));
  return checks;
}

Json body_of(const LivesFindings& found, const std::vector<std::size_t>& order, bool skip_bad) {
  const prognosis::FleetOutlook& out = found.outlook;
  Json body = {{"fleet",
                {{"units", found.rows.names.size()},
                 {"noun", found.noun},
                 {"rows", found.rows.rows},
                 {"engine", found.engine},
                 {"model", found.fingerprint},
                 {"life_unit", found.axis.text},
                 {"conditions", found.rows.sets.size()},
                 {"interpolated", out.interpolated},
                 {"populations",
                  {{"count", found.points},
                   {"effective", out.population.effective},
                   {"resolved", out.population.resolved}}}}},
               {"failures", failures_json(found.axis, found.horizons, out.failures)},
               {"worst", Json::array()}};
  if (!found.layout.empty()) body["fleet"]["layout"] = found.layout;
  for (std::size_t i = 0; i < std::min(worst_shown, order.size()); ++i) {
    const std::size_t u = order[i];
    Json failing = Json::array();
    for (const auto& each : out.failing) failing.push_back(each[u]);
    body["worst"].push_back({{"unit", found.rows.names[u]},
                             {"age", shown(found, found.rows.units.age[u])},
                             {"conditions", found.rows.sets[found.rows.units.group[u]].description},
                             {"failing", std::move(failing)},
                             {"b10", shown(found, out.b10[u])},
                             {"median", shown(found, out.median[u])}});
  }
  if (skip_bad) body["left_out"] = left_out_json(found.rows);
  return body;
}

std::string units_file(const LivesFindings& found, const std::vector<std::size_t>& order) {
  std::vector<WordColumn> words = {{"unit", {}}};
  if (has_conditions(found)) words.push_back({"conditions", {}});
  const std::string unit = found.axis.text;
  std::vector<NumberColumn> columns = {{fmt::format("age [{}]", unit), {}}};
  for (const double each : found.horizons)
    columns.push_back({"failing_within " + horizon_text(found.axis, each), {}});
  columns.push_back({fmt::format("left_b10 [{}]", unit), {}});
  columns.push_back({fmt::format("left_median [{}]", unit), {}});
  for (const std::size_t u : order) {
    words.front().values.push_back(found.rows.names[u]);
    if (words.size() > 1)
      words.back().values.push_back(found.rows.sets[found.rows.units.group[u]].description);
    std::size_t c = 0;
    columns[c++].values.push_back(shown(found, found.rows.units.age[u]));
    for (const auto& each : found.outlook.failing) columns[c++].values.push_back(each[u]);
    columns[c++].values.push_back(shown(found, found.outlook.b10[u]));
    columns[c].values.push_back(shown(found, found.outlook.median[u]));
  }
  return parquet_of(words, columns);
}

}  // namespace

Result lives_fleet_result(const LivesFindings& found, bool skip_bad) {
  const std::vector<std::size_t> order = worst_first(found);
  Result result;
  Header& header = result.header;
  header.version = WEARWELL_VERSION;
  header.title = fmt::format("A fleet of {} units: {}", found.rows.names.size(), found.title);
  header.model = "life-fleet";
  header.equation = "failures within h = sum over units of 1 - S(age + h)/S(age)";
  header.data = {found.files, static_cast<std::size_t>(found.rows.rows), found.fingerprint};
  header.checks = checks_of(found, skip_bad);
  header.trusted = std::none_of(header.checks.begin(), header.checks.end(),
                                [](const Check& each) { return each.verdict == Verdict::fail; });
  result.body = body_of(found, order, skip_bad);
  result.files.emplace_back("units.parquet", units_file(found, order));
  Section failures{"failures", "Failures"};
  failures.add(failures_lead(found.axis, found.horizons, found.outlook.failures, order.size()));
  failures.add(failures_table(found.axis, found.horizons, found.outlook.failures, order.size()));
  failures.add(Prose{"Each unit counts once: parts that fail again are not counted."});
  Section worst{"worst", "Worst units"};
  worst.add(worst_table(found, order));
  Section fleet{"fleet", "Fleet"};
  fleet.add(spread_table(found));
  if (has_conditions(found)) fleet.add(sets_table(found));
  for (Table& each : left_out_tables(found.rows, found.axis, "Age")) fleet.add(std::move(each));
  Section how{"how", "How"};
  present::Facts facts{{{"engine", found.engine},
                        {"rows read", fmt::format("{:.0f}", found.rows.rows)},
                        {"lives of", found.noun},
                        {"points of the population", fmt::format("{}", found.points)},
                        {"model", found.fingerprint}}};
  if (!found.layout.empty()) facts.facts.push_back({"layout of the files", found.layout});
  how.add(std::move(facts));
  result.sections = {std::move(failures), std::move(worst), std::move(fleet),
                     checks_section(header.checks), std::move(how)};
  return result;
}

}  // namespace wearwell::in_service
