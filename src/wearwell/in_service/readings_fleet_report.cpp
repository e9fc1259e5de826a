#include "wearwell/in_service/readings_fleet_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "wearwell/in_service/fleet_tables.h"
#include "wearwell/input/parquet_writer.h"
#include "wearwell/prognosis/interval_json.h"
#include "wearwell/study/trust_blocks.h"

namespace wearwell::in_service {
namespace {

using present::digits;
using present::fixed;
using present::Prose;
using present::Range;
using present::Section;
using present::Table;
using prognosis::finite_or_null;
using prognosis::interval_json;
using Json = nlohmann::ordered_json;

constexpr std::size_t riskiest_shown = 100;
constexpr std::size_t most_named = 5;

// By the probability of failure within the first horizon, ties by the last, the B10 and the name;
// units of which nothing is known last.
std::vector<std::size_t> riskiest_first(const std::vector<FollowedUnit>& units) {
  std::vector<std::size_t> order(units.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  using Key = std::tuple<bool, double, double, double, const std::string&>;
  const auto key = [&](std::size_t i) {
    const FollowedUnit& unit = units[i];
    return Key(!unit.known, unit.known ? -unit.failing.front() : 0,
               unit.known ? -unit.failing.back() : 0, unit.b10, unit.name);
  };
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  return order;
}

bool any_in_doubt(const ReadingsFindings& found) {
  return std::any_of(found.units.begin(), found.units.end(),
                     [](const FollowedUnit& each) { return !each.doubt.empty(); });
}

Table riskiest_table(const ReadingsFindings& found, const std::vector<std::size_t>& order) {
  const std::size_t count = std::min(riskiest_shown, order.size());
  Table table{"riskiest",
              count == 1 ? std::string("The unit")
                         : fmt::format("The {} units that most likely fail first", count),
              {{"Unit"},
               {"At", found.axis.text, digits(5)},
               {fmt::format("Now: {}", found.limited), found.level.text, digits(4)},
               {"5 to 95 %", found.level.text, digits(4), true}}};
  for (const double each : found.horizons)
    table.columns.push_back({"Fails within " + horizon_text(found.axis, each), "%", digits(3)});
  table.columns.push_back({"Remaining life, B10", found.axis.text, present::life(4)});
  table.columns.push_back({"Median", found.axis.text, present::life(4)});
  if (any_in_doubt(found)) table.columns.push_back({"In doubt"});
  for (std::size_t i = 0; i < count; ++i) {
    const FollowedUnit& unit = found.units[order[i]];
    std::vector<present::Cell>& row = table.rows.emplace_back();
    row = {unit.name};
    if (unit.known) {
      row.insert(row.end(), {unit.at, unit.level.q50, Range{unit.level.q05, unit.level.q95}});
      for (const double each : unit.failing) row.push_back(100 * each);
      row.insert(row.end(), {unit.b10, unit.remaining.q50});
    } else {
      row.resize(found.horizons.size() + 6, std::monostate{});
    }
    if (any_in_doubt(found)) row.push_back(unit.doubt.empty() ? "" : "yes");
  }
  return table;
}

std::vector<Table> doubt_tables(const ReadingsFindings& found,
                                const std::vector<std::size_t>& order) {
  Table table{"doubt", "Units whose readings do not follow the forecast", {{"Unit"}, {"Reason"}}};
  for (const std::size_t u : order) {
    if (found.units[u].doubt.empty()) continue;
    if (table.rows.size() == riskiest_shown) break;
    table.rows.push_back({found.units[u].name, found.units[u].doubt});
  }
  if (table.rows.empty()) return {};
  return {std::move(table)};
}

Check common_population_check(const ReadingsFindings& found) {
  if (found.why.empty())
    return {"population", Verdict::pass,
            fmt::format("failures are counted over {} points of the population, weighted by the "
                        "readings of all units (effective number {:.1f})",
                        found.points, found.population.effective),
            ""};
  return {"population", Verdict::warn,
          fmt::format("{}: failures are counted as if units were independent, so their number may "
                      "scatter more",
                      found.why),
          "Fit with these readings (wearwell update)."};
}

// The first units for which something holds, and their number.
template <class Holds>
std::string units_that(const ReadingsFindings& found, const Holds& holds, std::size_t& count) {
  std::string names;
  count = 0;
  for (const FollowedUnit& each : found.units) {
    if (!holds(each)) continue;
    if (++count <= most_named) names += (names.empty() ? "" : ", ") + each.name;
  }
  return count > most_named ? names + ", ..." : names;
}

Check readings_check(const ReadingsFindings& found) {
  Findings findings("readings");
  std::size_t count = 0;
  std::string names = units_that(
      found, [](const FollowedUnit& each) { return !each.doubt.empty(); }, count);
  if (count > 0)
    findings.add(
        Verdict::warn,
        fmt::format("units whose readings do not follow the forecast: {} ({})", count, names),
        "Their numbers say nothing: see the table doubt. A part that was replaced is "
        "another unit.");
  names = units_that(
      found, [](const FollowedUnit& each) { return each.refused > 0; }, count);
  if (count > 0)
    findings.add(Verdict::warn,
                 fmt::format("units with readings that no unit of the population can show: {} ({})",
                             count, names),
                 "These readings are left out; check them.");
  names = units_that(
      found, [](const FollowedUnit& each) { return !each.known; }, count);
  if (count > 0)
    findings.add(
        Verdict::warn,
        fmt::format("units without a forecast, which are not counted: {} ({})", count, names),
        "Nothing in their readings or the study determines how they go on.");
  return findings.result("the readings of all units follow their forecasts");
}

Check reach_check(const ReadingsFindings& found) {
  Findings findings("extrapolation");
  const double last = found.horizons.back() / found.axis.scale;
  const double longest = from_si(found.axis, found.longest_seen);
  std::size_t now = 0, later = 0;
  for (const FollowedUnit& each : found.units) {
    now += each.known && each.at > longest;
    later += each.known && each.at + last > longest;
  }
  add_units_beyond(findings, now, later, "farther than the study's last reading",
                   {found.axis, found.longest_seen, found.horizons.back()},
                   "These numbers rest on the form of the path, not on data.");
  return findings.result("readings and horizons lie within the study");
}

std::vector<Check> readings_checks(const ReadingsFindings& found, bool skip_bad) {
  std::vector<Check> checks = {fit_check(found.trusted_fit), readings_check(found),
                               common_population_check(found), reach_check(found)};
  if (skip_bad) checks.push_back(left_out_check(found.rows));
  return checks;
}

Json followed_json(const FollowedUnit& unit) {
  Json json = {{"unit", unit.name},     {"of_study", unit.of_study},
               {"known", unit.known},   {"readings", unit.readings},
               {"beyond", unit.beyond}, {"doubt", unit.doubt.empty() ? Json() : Json(unit.doubt)}};
  if (!unit.known) return json;
  Json failing = Json::array();
  for (const double each : unit.failing) failing.push_back(each);
  json["at"] = unit.at;
  json["level"] = interval_json(unit.level);
  json["passed"] = unit.passed;
  json["failing"] = std::move(failing);
  json["b10"] = finite_or_null(unit.b10);
  json["remaining"] = interval_json(unit.remaining);
  return json;
}

Json readings_body(const ReadingsFindings& found, const std::vector<std::size_t>& order,
                   bool skip_bad) {
  Json body = {{"fleet",
                {{"units", found.units.size()},
                 {"noun", found.noun},
                 {"rows", found.rows.rows},
                 {"rows_of_study", found.in_study},
                 {"engine", found.engine},
                 {"model", found.fingerprint},
                 {"axis", found.axis_name},
                 {"axis_unit", found.axis.text},
                 {"limited", found.limited},
                 {"level_unit", found.level.text},
                 {"limit", found.limit},
                 {"populations",
                  {{"count", found.points},
                   {"effective", found.population.effective},
                   {"shared", found.why.empty()}}}}},
               {"failures", failures_json(found.axis, found.horizons, found.failures)},
               {"riskiest", Json::array()}};
  if (!found.layout.empty()) body["fleet"]["layout"] = found.layout;
  for (std::size_t i = 0; i < std::min(riskiest_shown, order.size()); ++i)
    body["riskiest"].push_back(followed_json(found.units[order[i]]));
  if (skip_bad) body["left_out"] = left_out_json(found.rows);
  return body;
}

std::string followed_units_file(const ReadingsFindings& found,
                                const std::vector<std::size_t>& order) {
  std::vector<WordColumn> words = {{"unit", {}}, {"doubt", {}}};
  std::vector<NumberColumn> numbers;
  const auto add = [&](const std::string& heading, const auto& value) {
    NumberColumn column{heading, {}};
    for (const std::size_t u : order)
      column.values.push_back(found.units[u].known ? value(found.units[u]) : std::nan(""));
    numbers.push_back(std::move(column));
  };
  for (const std::size_t u : order) {
    words[0].values.push_back(found.units[u].name);
    words[1].values.push_back(found.units[u].doubt);
  }
  const std::string axis = found.axis.text, level = found.level.text;
  add(fmt::format("{} [{}]", found.axis_name, axis), [](const auto& u) { return u.at; });
  add(fmt::format("level_q05 [{}]", level), [](const auto& u) { return u.level.q05; });
  add(fmt::format("level_median [{}]", level), [](const auto& u) { return u.level.q50; });
  add(fmt::format("level_q95 [{}]", level), [](const auto& u) { return u.level.q95; });
  add("passed", [](const auto& u) { return u.passed; });
  for (std::size_t h = 0; h < found.horizons.size(); ++h)
    add("failing_within " + horizon_text(found.axis, found.horizons[h]),
        [h](const auto& u) { return u.failing[h]; });
  add(fmt::format("left_q05 [{}]", axis), [](const auto& u) { return u.remaining.q05; });
  add(fmt::format("left_b10 [{}]", axis), [](const auto& u) { return u.b10; });
  add(fmt::format("left_median [{}]", axis), [](const auto& u) { return u.remaining.q50; });
  add(fmt::format("left_q95 [{}]", axis), [](const auto& u) { return u.remaining.q95; });
  add("readings", [](const auto& u) { return static_cast<double>(u.readings); });
  return parquet_of(words, numbers);
}

}  // namespace

Result readings_fleet_result(const ReadingsFindings& found, bool skip_bad) {
  const std::vector<std::size_t> order = riskiest_first(found.units);
  Result result;
  Header& header = result.header;
  header.version = WEARWELL_VERSION;
  header.title = fmt::format("A fleet of {} units: {}", found.units.size(), found.title);
  header.model = "readings-fleet";
  header.equation =
      "failures within h = sum over units of P(threshold reached by now + h | readings)";
  header.data = {found.files, static_cast<std::size_t>(found.rows.rows), found.fingerprint};
  header.checks = readings_checks(found, skip_bad);
  header.trusted = std::none_of(header.checks.begin(), header.checks.end(),
                                [](const Check& each) { return each.verdict == Verdict::fail; });
  result.body = readings_body(found, order, skip_bad);
  result.files.emplace_back("units.parquet", followed_units_file(found, order));
  Section failures{"failures", "Failures"};
  failures.add(failures_lead(found.axis, found.horizons, found.failures, found.units.size()));
  failures.add(failures_table(found.axis, found.horizons, found.failures, found.units.size()));
  failures.add(
      Prose{fmt::format("A unit fails where {} reaches {:.6g} {}. Each counts once; horizons begin "
                        "at its last reading.",
                        found.limited, found.limit, found.level.text)});
  Section units{"units", "Units"};
  units.add(riskiest_table(found, order));
  for (Table& each : doubt_tables(found, order)) units.add(std::move(each));
  for (Table& each : left_out_tables(found.rows, found.axis, "At")) units.add(std::move(each));
  Section how{"how", "How"};
  present::Facts facts{{{"engine", found.engine},
                        {"rows read", fmt::format("{:.0f}", found.rows.rows)},
                        {"rows of the study", fmt::format("{:.0f}", found.in_study)},
                        {"points of the population", fmt::format("{}", found.points)},
                        {"model", found.fingerprint}}};
  if (!found.layout.empty()) facts.facts.push_back({"layout of the files", found.layout});
  how.add(std::move(facts));
  result.sections = {std::move(failures), std::move(units), checks_section(header.checks),
                     std::move(how)};
  return result;
}

}  // namespace wearwell::in_service
