#include "wearwell/models/formula_model/returns_delay.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/input/columns.h"
#include "wearwell/input/prior.h"
#include "wearwell/present/plain.h"

namespace wearwell::formula_model {
namespace {

constexpr int quantiles_of_delay = 4000;

double mean_delay(const std::vector<WeightedPoint>& points) {
  double sum = 0;
  for (const WeightedPoint& each : points) sum += each.weight * each.at;
  return sum;
}

// In each cell two points in place of many; `points` ascend.
std::vector<WeightedPoint> in_cells(const std::vector<WeightedPoint>& points) {
  constexpr double shortest_cell = 0.25, relative_cell = 1.0 / 16;
  constexpr int points_of_cell = 2;
  std::vector<WeightedPoint> few;
  double end = 0;
  for (std::size_t begin = 0; begin < points.size();) {
    while (points[begin].at >= end) end += std::max(shortest_cell, relative_cell * end);
    std::size_t next = begin;
    while (next < points.size() && points[next].at < end) ++next;
    for (const WeightedPoint& each :
         gauss_of_points(std::span(points).subspan(begin, next - begin), points_of_cell))
      few.push_back(each);
    begin = next;
  }
  return few;
}

ReturnsDelay delay_by_distribution(const TomlReader& keys, const char* key, const Unit& period) {
  const std::vector<std::string> families = {"lognormal",         "gamma",       "weibull",
                                             "exponential",       "loglogistic", "inverse-gaussian",
                                             "birnbaum-saunders", "uniform"};
  const TomlReader asked = keys.required_table(key);
  if (!asked.choice("distribution", families))
    asked.fail("distribution",
               fmt::format("is missing: one of {}; or name a `file` with the columns `delay` and "
                           "`share`",
                           fmt::join(families, ", ")));
  const Parameter delay = read_prior(keys, {.name = key, .si = "s", .natural_lower = 0});
  ReturnsDelay found;
  for (int i = 0; i < quantiles_of_delay; ++i)
    found.points.push_back({quantile(delay.prior, (i + 0.5) / quantiles_of_delay) / period.scale,
                            1.0 / quantiles_of_delay});
  found.words = fmt::format("{}, mean {} {}", delay.distribution,
                            plain_number(mean_delay(found.points)), period.text);
  return found;
}

ReturnsDelay delay_by_table(const TomlReader& asked, const Source& source, const Unit& period) {
  const Table table = read_table(asked, source);
  const ColumnChoice time = required_column(asked, "delay", "s", table),
                     share = required_column(asked, "share", "1", table);
  const std::vector<double> times = si_numbers(table, time), shares = si_numbers(table, share);
  ReturnsDelay found;
  double sum = 0;
  for (std::size_t row = 0; row < table.rows; ++row) {
    require(times[row] >= 0, table, time, row, "0 or more");
    require(shares[row] >= 0 && shares[row] <= 1, table, share, row, "a share from 0 to 1");
    sum += shares[row];
    if (shares[row] > 0) found.points.push_back({times[row] / period.scale, shares[row]});
  }
  constexpr double rounding = 1e-6;
  if (!(std::abs(sum - 1) <= rounding))
    throw InputError(
        fmt::format("{}, column '{}': the shares add up to {}; they must add up to 1. If the "
                    "longest delays are "
                    "missing, add a row for them",
                    table.source, share.column, plain_given(sum)));
  for (WeightedPoint& each : found.points) each.weight /= sum;
  std::sort(found.points.begin(), found.points.end(),
            [](const WeightedPoint& a, const WeightedPoint& b) { return a.at < b.at; });
  found.words = fmt::format("{} times of {}, mean {} {}", found.points.size(), table.source,
                            plain_number(mean_delay(found.points)), period.text);
  return found;
}

}  // namespace

ReturnsDelay read_returns_delay(const TomlReader& keys, const char* key, const Source& source,
                                const Unit& period) {
  if (!keys.has(key)) return {{{0, 1}}};
  if (keys.is_text(key) || keys.is_integer(key)) {
    const Quantity time = keys.required_quantity(key, "s");
    if (!(time.si() >= 0)) keys.fail(key, "must not be negative");
    return {{{time.si() / period.scale, 1}}};
  }
  const TomlReader asked = keys.required_table(key);
  if (!asked.has("delay") && !asked.has("share")) return delay_by_distribution(keys, key, period);
  if (asked.has("distribution"))
    asked.fail("distribution",
               "is one reading of this delay, and the columns `delay` and `share` of "
               "a table are another: leave one out");
  return delay_by_table(asked, source, period);
}

ReportingDelay sum_of_delays(const ReturnsDelay& a, const ReturnsDelay& b, const Unit& period) {
  std::vector<WeightedPoint> sums;
  for (const WeightedPoint& first : in_cells(a.points))
    for (const WeightedPoint& second : in_cells(b.points))
      sums.push_back({first.at + second.at, first.weight * second.weight});
  std::sort(sums.begin(), sums.end(),
            [](const WeightedPoint& x, const WeightedPoint& y) { return x.at < y.at; });
  ReportingDelay sum;
  for (const WeightedPoint& each : in_cells(sums)) {
    sum.time.push_back(to_si(period, each.at));
    sum.share.push_back(each.weight);
  }
  return sum;
}

}  // namespace wearwell::formula_model
