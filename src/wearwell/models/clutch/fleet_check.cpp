#include "wearwell/models/clutch/fleet_check.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/models/clutch/clutch_tables.h"

namespace wearwell::clutch {
namespace {

/// "unit 7, cycle 4: torque is -1", of one row that cannot be summed.
std::string invalid_row(fleet::Engine& engine, const ClutchSql& sql) {
  std::string found;
  engine.rows(sql.invalid_row, 1, [&](const fleet::Row& row) {
    constexpr const char* names[] = {"cycle",       "slip_speed",   "torque",
                                     "temperature", "closing_time", "energy"};
    found = fmt::format("unit {}, cycle {}:", printable(row.texts.front()), row.numbers[0]);
    for (std::size_t i = 0; i < std::size(names); ++i) {
      const double x = row.numbers[i];
      const bool temperature = std::string_view(names[i]) == "temperature";
      const bool good = i == 0 ? x >= 1 && x <= 9e15 && x == std::floor(x)
                               : (temperature ? x >= -273.15 : x > 0) && x < 1e300;
      if (good) continue;
      found += fmt::format(" {} is {},", names[i],
                           std::isnan(x) ? "not a number" : fmt::format("{:.6g}", x));
    }
    found.pop_back();
  });
  return found;
}

/// "torque 20 .. 31 N m" in the table's own unit; databases sort NaN as the largest number.
std::string range_text(const char* name, const SqlColumn& column, double low, double high) {
  const auto end = [&](double x) {
    return std::isfinite(x) ? fmt::format("{:.6g}", (x - column.offset) / column.scale)
                            : "not a number";
  };
  return fmt::format("{} {} to {} {}", name, end(low), end(high), column.unit);
}

/// The cycles with impossible energy, by the largest one.
FleetOutliers outliers_of(fleet::Engine& engine, const ClutchSql& sql, double count) {
  FleetOutliers found;
  if (!(count > 0)) return found;
  engine.rows(sql.outlier, 1, [&](const fleet::Row& row) {
    found.unit = row.texts.front();
    found.all = {static_cast<long long>(count), static_cast<long long>(row.numbers[0]),
                 row.numbers[1], row.numbers[2]};
  });
  return found;
}

}  // namespace

FleetCheck check_rows(fleet::Engine& engine, const ClutchSql& sql, const SqlSource& source,
                      LeftOut& left_out) {
  FleetCheck check;
  double refused = 0, nameless = 0, outliers = 0;
  engine.rows(sql.check, 0, [&](const fleet::Row& row) {
    check.rows = row.numbers[0];
    refused = row.numbers[1];
    outliers = row.numbers[4 + 2 * inputs.size()];
    nameless = row.numbers[2];
    if (check.rows == 0) throw InputError(fmt::format("{} has no rows", engine.source()));
    check.ranges.clear();
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      check.low[i] = row.numbers[3 + 2 * i];
      check.high[i] = row.numbers[4 + 2 * i];
      check.ranges += range_text(inputs[i].name, source.inputs[i], row.numbers[3 + 2 * i],
                                 row.numbers[4 + 2 * i]) +
                      ", ";
    }
    const double energy = row.numbers[3 + 2 * inputs.size()];
    check.ranges +=
        std::isfinite(energy)
            ? fmt::format("energy up to {:.6g} {}",
                          (energy - source.energy.offset) / source.energy.scale, source.energy.unit)
            : "energy not a number";
  });
  if (left_out.asked && refused + nameless > 0) {
    left_out.read(engine, sql);
    if (left_out.rows < check.rows) refused = nameless = 0;
  }
  const char* const advice =
      left_out.asked ? "" : "; --skip-bad leaves such rows out and reports how much they matter";
  if (nameless > 0)
    throw InputError(
        fmt::format("{}: {:.0f} rows have no unit{}", engine.source(), nameless, advice));
  if (refused > 0)
    throw InputError(fmt::format(
        "{}: {:.0f} rows of {:.0f} have a missing or impossible value ({}, in SI and "
        "degC): cycles are integers of at least 1, temperatures above absolute zero, "
        "all else positive (these are: {}){}",
        engine.source(), refused, check.rows, invalid_row(engine, sql), check.ranges, advice));
  check.outliers = outliers_of(engine, sql, outliers);
  return check;
}

void refuse_other_temperature(fleet::Engine& engine, const ClutchSql& sql, const SqlSource& source,
                              const WearModel& model) {
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const SqlColumn& column = source.inputs[i];
    const bool celsius = column.unit == "degC", kelvin = column.unit == "K";
    if (inputs[i].value != &OperatingPoint::temperature || !column.unit_by_option ||
        (!celsius && !kelvin))
      continue;
    LeftOut ignored{.asked = true};
    const FleetCheck check = check_rows(engine, sql, source, ignored);
    const double from = model.lowest.*inputs[i].value, to = model.highest.*inputs[i].value;
    const double margin = (to - from) / 2, shift = kelvin ? celsius_zero : -celsius_zero;
    const auto inside = [&](double x) { return x >= from - margin && x <= to + margin; };
    const bool outside = check.low[i] > to || check.high[i] < from;
    if (!outside || !inside(check.low[i] + shift) || !inside(check.high[i] + shift)) continue;
    const auto shown = [&](double x) { return (x - column.offset) / column.scale; };
    throw InputError(fmt::format(
        "{}: column '{}' has values from {:.6g} to {:.6g}. In {} that is {:.6g} to {:.6g} degC, "
        "all "
        "outside the calibrated range of {:.6g} to {:.6g} degC; in {} it is {:.6g} to {:.6g} degC. "
        "Write --columns '{}={}:{}'; if {} is right, name the column '{} [{}]' (in a view)",
        engine.source(), printable(column.name), shown(check.low[i]), shown(check.high[i]),
        column.unit, check.low[i], check.high[i], from, to, kelvin ? "degC" : "K",
        check.low[i] + shift, check.high[i] + shift, inputs[i].name, printable(column.name),
        kelvin ? "degC" : "K", column.unit, inputs[i].name, column.unit));
  }
}

}  // namespace wearwell::clutch
