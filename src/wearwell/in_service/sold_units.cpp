#include "wearwell/in_service/sold_units.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/fleet/named_columns.h"
#include "wearwell/input/month_text.h"
#include "wearwell/input/status_words.h"

namespace wearwell::in_service {
namespace {

using fleet::Dialect;

const fleet::EngineColumn* column_named(const std::vector<fleet::EngineColumn>& known,
                                        const std::string& name) {
  const auto at = std::find_if(known.begin(), known.end(),
                               [&](const fleet::EngineColumn& each) { return each.name == name; });
  return at == known.end() ? nullptr : &*at;
}

// The number of the month of a date, or of a timestamp in UTC.
std::string month_of(Dialect dialect, const std::string& moment, bool is_time) {
  switch (dialect) {
    case Dialect::duckdb: {
      const std::string in_utc =
          is_time ? fmt::format("make_timestamp(epoch_us({}))", moment) : moment;
      return fmt::format("(year({0}) * 12 + month({0}) - 1)", in_utc);
    }
    case Dialect::postgresql: {
      const std::string in_utc =
          is_time ? fmt::format("(to_timestamp(extract(epoch from {})) at time zone 'UTC')", moment)
                  : moment;
      return fmt::format("(extract(year from {0}) * 12 + extract(month from {0}) - 1)", in_utc);
    }
    case Dialect::clickhouse:
      break;
  }
  return fmt::format("(toYear(toDateTime({0}, 'UTC')) * 12 + toMonth(toDateTime({0}, 'UTC')) - 1)",
                     moment);
}

// DuckDB has the dates of a CSV file as texts.
bool is_text_of_file(Dialect dialect, const fleet::EngineColumn& column) {
  return dialect == Dialect::duckdb && !column.is_date && !column.is_time && !column.is_number;
}

std::string cell_text(const std::string& column) {
  return fmt::format("nullif(trim({}), '')", column);
}

std::string text_moment(const std::string& column) {
  return fmt::format("try_cast({} as timestamp)", cell_text(column));
}

// Throws unless the column holds dates.
void require_dates(fleet::Engine& engine, const fleet::EngineColumn& column) {
  if (column.is_date || column.is_time) return;
  if (!is_text_of_file(engine.dialect(), column))
    throw InputError(
        fmt::format("{}: column '{}' does not hold dates; convert it in a view, for "
                    "example with cast(... as date)",
                    engine.source(), printable(column.name)));
  const std::string name = "t." + fleet::identifier(engine.dialect(), column.name);
  const std::string query = fmt::format(
      "select coalesce(min({0}), '') from {1} as t where {0} is not null and {2} is null",
      cell_text(name), engine.table(), text_moment(name));
  engine.rows(query, 1, [&](const fleet::Row& row) {
    if (!row.texts.front().empty())
      throw InputError(
          fmt::format("{}: column '{}' does not hold dates: '{}' is none; write them "
                      "as 2024-01-31",
                      engine.source(), printable(column.name), printable(row.texts.front())));
  });
}

// Rows of: mode; month of sale, month of return, units, rows, rows without a number of units.
std::string count_query(const fleet::Engine& engine, const SoldColumns& columns,
                        const std::vector<fleet::EngineColumn>& known) {
  const Dialect dialect = engine.dialect();
  const auto name = [&](const std::string& column) {
    return "t." + fleet::identifier(dialect, column);
  };
  const auto month = [&](const std::string& column) {
    const fleet::EngineColumn* found = column_named(known, column);
    if (is_text_of_file(dialect, *found))
      return month_of(dialect, text_moment(name(column)), false);
    return month_of(dialect, name(column), found->is_time);
  };
  const std::string mode =
      columns.mode.empty() ? fleet::literal(dialect, "") : fleet::text(dialect, name(columns.mode));
  std::string units = fleet::number(1);
  if (!columns.quantity.empty()) {
    const fleet::EngineColumn* found = column_named(known, columns.quantity);
    units = fleet::real(dialect, fleet::number_cell(name(columns.quantity), found->text_decimal));
  }
  const auto real = [&](const std::string& any) { return fleet::real(dialect, any); };
  return fmt::format(
      "select g.mode, {}, {}, {}, {}, {} from (select {} as mode, {} as sold, {} as returned, {} "
      "as units from {} as t) as g group by g.mode, g.sold, g.returned",
      real("g.sold"), real("g.returned"), real("sum(g.units)"), real("count(*)"),
      real("sum(case when g.units >= 0 and g.units = floor(g.units) then 0 else 1 end)"), mode,
      month(columns.sold), month(columns.returned), units, engine.table());
}

std::string rows_text(double rows) {
  return fmt::format("{:.0f} row{}", rows, rows == 1 ? "" : "s");
}

// Refuses a group of rows that cannot be counted.
void check_group(const fleet::Row& row, const SoldColumns& columns, const std::string& source) {
  const double sold = row.numbers[0], returned = row.numbers[1], units = row.numbers[2],
               rows = row.numbers[3], no_number = row.numbers[4];
  if (std::isnan(sold))
    throw InputError(fmt::format("{}: {} without a date in column '{}', the date of sale", source,
                                 rows_text(rows), printable(columns.sold)));
  const int sale = static_cast<int>(sold);
  if (no_number > 0 || !std::isfinite(units))
    throw InputError(
        fmt::format("{}: {} of units sold in {} have no whole number in column '{}', "
                    "the number of units",
                    source, rows_text(no_number), month_text(sale), printable(columns.quantity)));
  if (std::isnan(returned)) {
    const std::string& mode = row.texts.front();
    if (!mode.empty() && censoring_by_word(mode) != Censoring::right)
      throw InputError(fmt::format(
          "{}: {} of units sold in {} have the failure mode '{}', but no "
          "date in column '{}'; correct one of them",
          source, rows_text(rows), month_text(sale), printable(mode), printable(columns.returned)));
  } else if (returned < sold) {
    throw InputError(fmt::format(
        "{}: {} of units sold in {} have a return in {}, before the sale; if that date stands for "
        "no return, make it null in a view",
        source, rows_text(rows), month_text(sale), month_text(static_cast<int>(returned))));
  }
}

}  // namespace

SoldColumns read_sold_columns(const std::vector<std::string>& options) {
  const auto given = fleet::split_columns(options, {"sold", "returned", "quantity", "mode"});
  const auto named = [&](const char* name) {
    const auto at = given.find(name);
    return at == given.end() ? std::string() : at->second;
  };
  SoldColumns columns{named("sold"), named("returned"), named("quantity"), named("mode")};
  for (const auto& [name, column] :
       {std::pair{"sold", &columns.sold}, {"returned", &columns.returned}})
    if (column->empty())
      throw InputError(fmt::format(
          "--columns: '{0}' is missing: write '{0}=COLUMN', the date of {1}", name,
          name == std::string("sold") ? "sale" : "return, null for a unit that did not come back"));
  return columns;
}

void count_sold_units(fleet::Engine& engine, const SoldColumns& columns, int until,
                      SoldUnits& units) {
  const std::vector<fleet::EngineColumn> known = engine.columns();
  const std::string source = engine.source();
  for (const std::string* each : {&columns.sold, &columns.returned, &columns.mode})
    if (!each->empty()) fleet::require_column(known, *each, source, false);
  if (!columns.quantity.empty()) fleet::require_column(known, columns.quantity, source, true);
  const std::string query = count_query(engine, columns, known);
  engine.begin();
  for (const std::string* each : {&columns.sold, &columns.returned})
    require_dates(engine, *column_named(known, *each));
  engine.rows(query, 1, [&](const fleet::Row& row) {
    check_group(row, columns, source);
    const int sold = static_cast<int>(row.numbers[0]);
    const double count = row.numbers[2];
    if (sold > until) {
      units.late_sales += count;
      return;
    }
    units.sold[sold] += count;
    if (std::isnan(row.numbers[1])) return;
    const int returned = static_cast<int>(row.numbers[1]);
    if (returned > until)
      units.late_returns += count;
    else
      units.returned[row.texts.front()].units[{sold, returned}] += count;
  });
}

present::Table returns_table(const SoldUnits& units, bool with_modes, int until) {
  if (units.sold.empty())
    throw InputError(
        fmt::format("no unit was sold until {}, the month of --until", month_text(until)));
  present::Table table{"returns", "Returns triangle", {{"sold"}}};
  if (with_modes) table.columns.push_back({"mode"});
  table.columns.push_back({"units"});
  const int first = units.sold.begin()->first;
  for (int month = first; month <= until; ++month) table.columns.push_back({month_text(month)});
  SoldUnits::Returns none;
  std::map<std::string, const SoldUnits::Returns*> modes;
  for (const auto& [mode, returns] : units.returned) modes[mode] = &returns;
  if (modes.empty()) modes[""] = &none;
  for (const auto& [sale, sold] : units.sold) {
    for (const auto& [mode, returns] : modes) {
      std::vector<present::Cell> row = {month_text(sale)};
      if (with_modes) row.push_back(mode);
      row.push_back(sold);
      for (int month = first; month <= until; ++month) {
        present::Cell& cell = row.emplace_back();
        if (month < sale) continue;
        const auto at = returns->units.find({sale, month});
        cell = at == returns->units.end() ? 0.0 : at->second;
      }
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

}  // namespace wearwell::in_service
