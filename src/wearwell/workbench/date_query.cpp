#include "wearwell/workbench/date_query.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/algorithm/string/predicate.hpp>
#include <optional>
#include <set>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/input/cell_text.h"
#include "wearwell/input/date_text.h"
#include "wearwell/input/quoted.h"

namespace wearwell::workbench {
namespace {

constexpr const char* until_layout = "%Y-%m-%d";

struct DateColumn {
  const Column* column = nullptr;
  std::string layout;
  std::vector<std::optional<long long>> seconds;  // of each row; empty where the cell is
};

// As the SQL below trims.
std::string without_blanks(const std::string& cell) {
  const std::size_t begin = cell.find_first_not_of(date_blanks);
  return begin == cell.npos ? ""
                            : cell.substr(begin, cell.find_last_not_of(date_blanks) + 1 - begin);
}

InputError refused_cell(const Table& table, const Column& column, std::size_t row,
                        const std::string& reason) {
  return InputError(fmt::format("{}: {}", place(table, column.name, row), reason));
}

std::string shown_cell(const Column& column, std::size_t row) {
  return fmt::format("'{}'", printable(shortened(column.text[row])));
}

DateColumn dates_in(const Table& table, const std::string& heading, const std::string& layout) {
  const Column& column = table.column(heading);
  const std::vector<std::string> layouts = date_layouts(column);
  if (std::find(layouts.begin(), layouts.end(), layout) == layouts.end())
    throw InputError(fmt::format("{}, column '{}': its cells are not dates of the form {}",
                                 table.source, printable(column.name),
                                 printable(layout_words(shortened(layout)))));
  DateColumn dates{&column, layout, {}};
  for (std::size_t row = 0; row < table.rows; ++row) {
    dates.seconds.push_back(date_in(column.text[row], layout));
    if (!dates.seconds.back() && !is_absent(column.text[row]))
      throw refused_cell(table, column, row,
                         fmt::format("{} is not a date of the form {}", shown_cell(column, row),
                                     layout_words(layout)));
  }
  return dates;
}

// The dates from which time counts: in the layout of the others, or in their only one.
DateColumn beginnings(const Table& table, const DatesWanted& wanted) {
  const std::vector<std::string> layouts = date_layouts(table.column(wanted.since));
  const bool same =
      std::find(layouts.begin(), layouts.end(), wanted.layout) != layouts.end() || layouts.empty();
  if (!same && layouts.size() > 1)
    throw InputError(fmt::format(
        "{}, column '{}': its dates can be read as {} and as {}; write them as year-month-day",
        table.source, printable(wanted.since), layout_words(layouts[0]), layout_words(layouts[1])));
  return dates_in(table, wanted.since, same ? wanted.layout : layouts.front());
}

// Throws at a life that has no beginning, ends before it, or is in use until a date before it.
void require_order(const Table& table, const DateColumn& begin, const DateColumn& end,
                   std::optional<long long> until) {
  for (std::size_t row = 0; row < table.rows; ++row) {
    if (!begin.seconds[row])
      throw refused_cell(table, *begin.column, row,
                         fmt::format("is empty; the time to '{}' counts from this date",
                                     printable(end.column->name)));
    if (!end.seconds[row] && !until)
      throw refused_cell(table, *end.column, row,
                         "is empty; state until which date such units were in use");
    if (end.seconds[row] && until && *end.seconds[row] > *until)
      throw refused_cell(table, *end.column, row,
                         fmt::format("{} is after the date until which units without a date were "
                                     "in use",
                                     shown_cell(*end.column, row)));
    if ((end.seconds[row] ? *end.seconds[row] : *until) < *begin.seconds[row])
      throw refused_cell(
          table, *begin.column, row,
          fmt::format("{} is after {}", shown_cell(*begin.column, row),
                      end.seconds[row] ? shown_cell(*end.column, row)
                                       : "the date until which such units were in use"));
  }
}

// The cell as a text, null where it is empty or marks a missing value.
std::string cell_sql(const Column& column) {
  std::set<std::string> marks = {""};
  for (const std::string& cell : column.text) {
    if (is_missing_mark(cell)) marks.insert(without_blanks(cell));
  }
  std::string sql =
      fmt::format("trim(cast({} as varchar), ' ' || chr(9))", quoted(column.name, '"'));
  for (const std::string& mark : marks)
    sql = fmt::format("nullif({}, {})", sql, quoted(mark, '\''));
  return sql;
}

std::string moment_sql(const DateColumn& dates) {
  return fmt::format("strptime({}, {})", cell_sql(*dates.column), quoted(dates.layout, '\''));
}

std::string difference_sql(const std::string& begin, const std::string& end, bool in_hours) {
  return in_hours ? fmt::format("(epoch({}) - epoch({})) / 3600", end, begin)
                  : fmt::format("date_diff('day', cast({} as date), cast({} as date))", begin, end);
}

// A heading that the table does not have yet.
std::string new_heading(const Table& table, const std::string& name, const std::string& of) {
  using namespace boost::algorithm;
  const bool taken =
      std::any_of(table.columns.begin(), table.columns.end(), [&](const Column& each) {
        return iequals(each.name, name) || istarts_with(each.name, name + " ");
      });
  return taken ? fmt::format("{} {}", of, name) : name;
}

// The columns beside the new ones. A unit that is not in the heading does not pass through a query.
std::string others_sql(const Table& table, const std::vector<std::string>& without) {
  std::vector<std::string> left_out, renamed;
  for (const std::string& each : without) left_out.push_back(quoted(each, '"'));
  for (const Column& each : table.columns) {
    if (each.unit.empty() || std::find(without.begin(), without.end(), each.name) != without.end())
      continue;
    left_out.push_back(quoted(each.name, '"'));
    renamed.push_back(fmt::format("{} as {}", left_out.back(),
                                  quoted(fmt::format("{} [{}]", each.name, each.unit), '"')));
  }
  std::string sql = "*";
  for (std::size_t i = 0; i < left_out.size(); ++i)
    sql += fmt::format("{}{}", i == 0 ? " exclude (" : ", ", left_out[i]);
  sql += ")";
  for (const std::string& each : renamed) sql += ", " + each;
  return sql;
}

std::string with_unit_of_time(const std::string& heading, bool in_hours) {
  return fmt::format("{} [{}]", heading, in_hours ? "h" : "d");
}

std::optional<long long> until_date(const DatesWanted& wanted) {
  if (wanted.until.empty()) return {};
  const auto until = date_in(wanted.until, until_layout);
  if (!until)
    throw InputError(fmt::format("'{}' is not a date; write it as 2024-12-31",
                                 printable(shortened(wanted.until))));
  return until;
}

// The time between two columns of dates: a life, which may not have ended.
std::string life_query(const Table& table, const DatesWanted& wanted, const std::string& source) {
  const DateColumn end = dates_in(table, wanted.column, wanted.layout);
  const DateColumn begin = beginnings(table, wanted);
  const auto until = until_date(wanted);
  require_order(table, begin, end, until);
  const bool in_hours = has_time_of_day(end.layout) || has_time_of_day(begin.layout);
  const bool open = std::any_of(end.seconds.begin(), end.seconds.end(),
                                [](const auto& each) { return !each.has_value(); });
  std::string last = moment_sql(end);
  if (open)
    last = fmt::format("coalesce({}, strptime({}, '{}'))", last, quoted(wanted.until, '\''),
                       until_layout);
  std::string sql = fmt::format(
      "select {}, {} as {}", others_sql(table, {end.column->name}),
      difference_sql(moment_sql(begin), last, in_hours),
      quoted(with_unit_of_time(new_heading(table, "life", end.column->name), in_hours), '"'));
  if (open)
    sql += fmt::format(", case when {} is null then 'runout' else 'failure' end as {}",
                       cell_sql(*end.column),
                       quoted(new_heading(table, "status", end.column->name), '"'));
  return sql + " from " + source;
}

// The time since the first date, of the table or of each unit. A window leaves no order, so the rows get one.
std::string age_query(const Table& table, const DatesWanted& wanted, const std::string& source) {
  const DateColumn dates = dates_in(table, wanted.column, wanted.layout);
  const std::string moment = moment_sql(dates);
  const bool in_hours = has_time_of_day(dates.layout);
  const std::string heading =
      quoted(with_unit_of_time(new_heading(table, "time", dates.column->name), in_hours), '"');
  if (wanted.unit.empty())
    return fmt::format(
        "select {} as {}, {} from {}",
        difference_sql(fmt::format("(select min({}) from {})", moment, source), moment, in_hours),
        heading, others_sql(table, {dates.column->name}), source);
  const Column& unit = table.column(wanted.unit);
  const std::string name = quoted(unit.name, '"');
  return fmt::format(
      "select {}, {} as {}, {} from {} order by all", name,
      difference_sql(fmt::format("min({}) over (partition by {})", moment, name), moment, in_hours),
      heading, others_sql(table, {unit.name, dates.column->name}), source);
}

}  // namespace

DatesWanted read_dates_wanted(const nlohmann::json& wish) {
  const auto text = [&](const char* key) {
    if (!wish.is_object() || !wish.contains(key) || !wish.at(key).is_string())
      throw InputError(fmt::format("\"dates\": \"{}\" is missing: it must be a text", key));
    return wish.at(key).get<std::string>();
  };
  return {text("column"), text("layout"), text("since"), text("unit"), text("until")};
}

std::string time_query(const Table& table, const DatesWanted& wanted, const std::string& before) {
  const std::string source = before.empty() ? "data" : fmt::format("({}) as data", before);
  if (wanted.since == wanted.column)
    throw InputError(fmt::format("'{}': the time from a date to itself is 0; choose another column",
                                 printable(shortened(wanted.since))));
  return wanted.since.empty() ? age_query(table, wanted, source)
                              : life_query(table, wanted, source);
}

}  // namespace wearwell::workbench
