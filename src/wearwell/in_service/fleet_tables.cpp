#include "wearwell/in_service/fleet_tables.h"

#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>

#include "wearwell/present/html.h"

namespace wearwell::in_service {
namespace {

using present::digits;
using present::fixed;
using present::given;
using present::Prose;
using present::Range;
using present::Table;
using Json = nlohmann::ordered_json;

constexpr double much_left_out = 0.05;

}  // namespace

std::string horizon_text(const Unit& axis, double horizon) {
  const bool factor = std::isdigit(static_cast<unsigned char>(axis.text.front())) != 0;
  return fmt::format("{:.6g} {}{}", from_si(axis, horizon), factor ? "x " : "", axis.text);
}

Prose failures_lead(const Unit& axis, std::span<const double> horizons,
                    std::span<const prognosis::FleetFailures> failures, std::size_t units) {
  const prognosis::FleetFailures& n = failures.front();
  return {
      fmt::format("Of {} units in service, {:.4g} ({:.0f} to {:.0f}, 90 %) are expected to fail "
                  "within {}.",
                  html::given(static_cast<double>(units)), n.expected, n.low, n.high,
                  horizon_text(axis, horizons.front())),
      true};
}

Table failures_table(const Unit& axis, std::span<const double> horizons,
                     std::span<const prognosis::FleetFailures> failures, std::size_t units) {
  Table table{"failures",
              fmt::format("Failures among {} units in service, from now on", units),
              {{"Horizon", axis.text, given},
               {"Failures expected", "1", digits(4)},
               {"5 to 95 %", "1", fixed(0), true},
               {"Share of fleet", "%", digits(3)}}};
  for (std::size_t h = 0; h < horizons.size(); ++h) {
    const prognosis::FleetFailures& n = failures[h];
    table.rows.push_back({from_si(axis, horizons[h]), n.expected, Range{n.low, n.high},
                          100 * n.expected / static_cast<double>(units)});
  }
  return table;
}

Json failures_json(const Unit& axis, std::span<const double> horizons,
                   std::span<const prognosis::FleetFailures> failures) {
  Json all = Json::array();
  for (std::size_t h = 0; h < horizons.size(); ++h)
    all.push_back({{"horizon", from_si(axis, horizons[h])},
                   {"expected", failures[h].expected},
                   {"low", failures[h].low},
                   {"high", failures[h].high}});
  return all;
}

std::vector<Table> left_out_tables(const RowsRead& rows, const Unit& axis,
                                   const std::string& place) {
  if (rows.left_out == 0) return {};
  Table reasons{"left-out-reasons",
                "Rows left out, by the first reason",
                {{"Reason"}, {"Rows", "1", fixed(0)}, {"Share", "%", digits(3)}}};
  for (const auto& [reason, count] : rows.reasons)
    reasons.rows.push_back({reason, count, 100 * count / rows.rows});
  Table list{"left-out",
             rows.left_out > static_cast<double>(rows.first_left_out.size())
                 ? fmt::format("The first {} rows left out", rows.first_left_out.size())
                 : std::string("Rows left out"),
             {{"Unit"}, {"Reason"}, {place, axis.text, given}}};
  for (const LeftOutRow& each : rows.first_left_out) {
    list.rows.push_back({each.unit, each.reason});
    if (std::isfinite(each.age)) {
      list.rows.back().push_back(from_si(axis, each.age));
    } else {
      list.rows.back().push_back(std::monostate{});
    }
  }
  return {std::move(reasons), std::move(list)};
}

Json left_out_json(const RowsRead& rows) {
  Json reasons = Json::array();
  for (const auto& [reason, count] : rows.reasons)
    reasons.push_back({{"reason", reason}, {"rows", count}});
  return {{"rows", rows.left_out}, {"reasons", std::move(reasons)}};
}

void add_units_beyond(Findings& findings, std::size_t now, std::size_t later,
                      const std::string& beyond, const Reach& reach, const std::string& advice) {
  const std::string data = horizon_text(reach.axis, reach.data);
  if (now > 0)
    findings.add(Verdict::warn, fmt::format("units {}, {}: {}", beyond, data, now), advice);
  if (later > now)
    findings.add(Verdict::warn,
                 fmt::format("units that will be {}, {}, within {}: {}", beyond, data,
                             horizon_text(reach.axis, reach.horizon), later),
                 advice);
}

Check fit_check(bool trusted) {
  return {"fit", trusted ? Verdict::pass : Verdict::fail,
          trusted ? "the fit is trusted" : "the fit is not trusted, nor is what follows from it",
          trusted ? "" : "See the checks of the fit: wearwell report."};
}

Check left_out_check(const RowsRead& rows) {
  const double share = rows.left_out / rows.rows;
  return {"left-out",
          share > much_left_out ? Verdict::fail
          : share > 0           ? Verdict::warn
                                : Verdict::pass,
          fmt::format(
              "{:.0f} of {:.0f} rows were left out (--skip-bad); their failures are not counted",
              rows.left_out, rows.rows),
          share > 0 ? "Correct the rows of the table left-out." : ""};
}

}  // namespace wearwell::in_service
