// The statements about rows that cannot be summed.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "wearwell/models/clutch/energy_balance.h"
#include "wearwell/models/clutch/left_out.h"
#include "wearwell/models/clutch/sql_writer.h"

namespace wearwell::clutch {

using fleet::number;

/// The conditions of `wearwell clutch predict` on a row. NaN exceeds every number, or no comparison
/// with it is true.
std::vector<std::string> SqlWriter::conditions() const {
  std::vector<std::string> all = {"cycle >= 1 and cycle <= 9e15 and cycle = floor(cycle)"};
  for (const char* each : {"slip_speed", "torque", "temperature", "closing_time", "energy"}) {
    const bool temperature = std::string_view(each) == "temperature";
    all.push_back(
        fmt::format("raw_{0} {1} and raw_{0} < 1e300", each, temperature ? ">= -273.15e0" : "> 0"));
  }
  return all;
}

std::string SqlWriter::valid() const {
  return fmt::format("{}", fmt::join(conditions(), " and "));
}

/// Whether the values of a row are invalid. ClickHouse has no null boolean.
std::string SqlWriter::refused() const {
  return fmt::format(fmt::runtime(clickhouse() ? "not ({})" : "not coalesce({}, false)"), valid());
}

namespace {

/// The condition on a row that is summed: valid values, and a unit.
std::string usable(const std::string& valid, bool clickhouse) {
  return fmt::format("{} and {}", valid, clickhouse ? "unit <> ''" : "unit is not null");
}

/// The energy of a row over that of its closing; 0 if the row does not meet `condition`, or if a
/// value is so extreme that the product overflows.
std::string closing_ratio(const std::string& condition) {
  std::string can_be = condition;
  for (const char* each : {"slip_speed", "torque", "closing_time"})
    can_be += fmt::format(" and raw_{0} > 1e-60 and raw_{0} < 1e60", each);
  return fmt::format(
      "case when {} then raw_energy / (0.5e0 * raw_torque * raw_slip_speed * raw_closing_time) "
      "else 0e0 end",
      can_be);
}

}  // namespace

std::string SqlWriter::check() const {
  SqlColumns columns;
  columns.keep(fleet::real(dialect_, "count(*)"));
  columns.keep(fleet::real(dialect_, count_if(refused())));
  columns.keep(fleet::real(dialect_, count_if(clickhouse() ? "unit = ''" : "unit is null")));
  for (const char* each : input_columns) {
    columns.keep(fmt::format("min(raw_{})", each));
    columns.keep(fmt::format("max(raw_{})", each));
  }
  columns.keep("max(raw_energy)");
  columns.keep(fleet::real(
      dialect_, count_if(fmt::format("({}) > {}", closing_ratio(usable(valid(), clickhouse())),
                                     number(EnergyOutliers::most)))));
  return fmt::format("select\n  {}\nfrom (\n{}\n) as si", columns.text(), si(false));
}

std::string SqlWriter::outlier() const {
  SqlColumns columns;
  columns.add(fleet::text(dialect_, "unit"), "name");
  columns.add(fleet::real(dialect_, "cycle"), "number");
  columns.keep("raw_energy");
  columns.add(closing_ratio(usable(valid(), clickhouse())), "ratio");
  return fmt::format("select\n  {}\nfrom (\n{}\n) as si order by ratio desc, name, number limit 1",
                     columns.text(), si(false));
}

std::string SqlWriter::invalid_row() const {
  SqlColumns columns;
  columns.keep(fleet::text(dialect_, "unit"));
  columns.keep(fleet::real(dialect_, "cycle"));
  for (const char* each : input_columns) columns.keep(std::string("raw_") + each);
  columns.keep("raw_energy");
  return fmt::format("select\n  {}\nfrom (\n{}\n) as si where {} order by unit, cycle limit 1",
                     columns.text(), si(false), refused());
}

/// Every row in SI with the number of its first reason, as in LeftOut: 0 if it can be summed.
std::string SqlWriter::reasons() const {
  std::string text =
      fmt::format("case when {} then 1", clickhouse() ? "unit = ''" : "unit is null");
  int reason = 1;
  for (const std::string& each : conditions())
    text += fmt::format(fmt::runtime(clickhouse() ? " when not ({}) then {}"
                                                  : " when not coalesce({}, false) then {}"),
                        each, ++reason);
  return fmt::format("select *, {} else 0 end as reason from (\n{}\n) as si", text, si(false));
}

std::string SqlWriter::left_out() const {
  return fmt::format(
      "select {}, {}, {} from (\n{}\n) as rows_left_out where reason > 0 group by reason order by "
      "reason",
      fleet::real(dialect_, "reason"), fleet::real(dialect_, "count(*)"),
      fleet::real(dialect_, "count(distinct unit)"), reasons());
}

std::string SqlWriter::left_out_rows() const {
  SqlColumns columns;
  columns.keep(fleet::text(dialect_, "unit"));
  columns.keep(fleet::real(dialect_, "reason"));
  columns.keep(fleet::real(dialect_, "cycle"));
  for (const char* each : input_columns) columns.keep(std::string("raw_") + each);
  columns.keep("raw_energy");
  return fmt::format(
      "select\n  {}\nfrom (\n{}\n) as rows_left_out where reason > 0 order by unit, cycle, reason "
      "limit {}",
      columns.text(), reasons(), LeftOut::most_listed);
}

std::string SqlWriter::left_out_units() const {
  return fmt::format("select {}, {} from (\n{}\n) as rows_left_out where reason > 1 group by unit",
                     fleet::text(dialect_, "unit"), fleet::real(dialect_, "count(*)"), reasons());
}

}  // namespace wearwell::clutch
