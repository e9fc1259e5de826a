#include "wearwell/models/formula_model/field_returns.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/models/formula_model/returns_count.h"
#include "wearwell/models/formula_model/returns_delay.h"
#include "wearwell/present/plain.h"

namespace wearwell::formula_model {
namespace {

// The length of a period; months of the calendar are months.
Unit read_period(const TomlReader& keys, const PeriodNames& names) {
  const auto text = keys.text("period");
  if (!text) {
    if (!names.calendar)
      keys.fail("period",
                fmt::format("is missing: the periods are numbers ('{}'); how long is one, for "
                            "example \"month\" or \"week\"?",
                            names.text(1)));
    return read_unit("month", "s");
  }
  try {
    const Unit unit = read_unit(*text, "s");
    if (names.calendar && *text != "month")
      keys.fail("period", "must be \"month\": the periods are months of the calendar");
    return unit;
  } catch (const InputError& error) {
    keys.fail("period", error.what());
  }
}

double in_periods(const TomlReader& keys, const char* key, const Unit& period, double otherwise) {
  const auto quantity = keys.quantity(key, "s");
  if (!quantity) return otherwise;
  if (!(quantity->si() >= 0)) keys.fail(key, "must not be negative");
  return quantity->si() / period.scale;
}

void read_delays(const TomlReader& keys, const Source& source, FieldReturns& returns) {
  const ReturnsDelay to_use = read_returns_delay(keys, "delay_to_use", source, returns.period),
                     of_report =
                         read_returns_delay(keys, "delay_of_report", source, returns.period);
  if (!to_use.varies() && !of_report.varies()) {
    returns.delay = to_use.points.front().at + of_report.points.front().at;
    return;
  }
  if (returns.whole)
    keys.fail("ages",
              "must be \"middle\", \"start\" or \"end\" if delays vary: \"whole\" states one exact "
              "life for each return");
  returns.reporting = sum_of_delays(to_use, of_report, returns.period);
  returns.reporting->warranty = to_si(returns.period, returns.warranty);
  if (to_use.varies()) returns.delay_words.push_back("delay from the sale to use: " + to_use.words);
  if (of_report.varies())
    returns.delay_words.push_back("delay from a failure to its report: " + of_report.words);
}

struct LifeRows {
  std::vector<double> lower, upper, count;
  std::vector<std::string> sold, mode;
  std::vector<std::size_t> row;  // of the triangle

  void add(double from, double to, int units, const std::string& period, const ModeReturns& by) {
    lower.push_back(from);
    upper.push_back(to);
    count.push_back(units);
    sold.push_back(period);
    mode.push_back(by.mode);
    row.push_back(by.row);
  }
};

// The returns of one cell, mode by mode where the table has modes.
std::vector<ModeReturns> cell_of(const SalesPeriod& sale, std::size_t after) {
  if (sale.by_mode.empty()) return {{"", sale.row, {sale.returns[after]}}};
  std::vector<ModeReturns> cell;
  for (const ModeReturns& each : sale.by_mode)
    if (each.returns[after] > 0) cell.push_back({each.mode, each.row, {each.returns[after]}});
  return cell;
}

void add_failures(const FieldReturns& returns, const SalesPeriod& sale, LifeRows& rows) {
  const std::string period = returns.triangle.names.text(sale.at);
  int surviving = sale.sold;
  for (int after = 0; sale.at + after <= returns.last(); ++after) {
    const int count = sale.returns[static_cast<std::size_t>(after)];
    if (count == 0) continue;
    const double lower = returns.age(after - 1), upper = returns.age(after);
    if (!(returns.age_in_use(after) > 0))
      throw InputError(fmt::format(
          "{}: {} of the units sold in {} came back in {}, but {}", returns.triangle.table.source,
          count, period, returns.triangle.names.text(sale.at + after),
          returns.delay > 0 || returns.reporting
              ? fmt::format("with delays of {}{} {}s no failure can be reported so early",
                            returns.reporting ? "at least " : "",
                            plain_given(returns.least_delay()), returns.period.text)
              : "with this key `ages` none can come back in the period of its sale; use ages = "
                "\"middle\""));
    if (!returns.claimed(after)) continue;  // beyond the warranty: they survived it
    surviving -= count;
    const double from = returns.whole ? upper : lower > 0 ? lower : NAN;
    for (const ModeReturns& by : cell_of(sale, static_cast<std::size_t>(after)))
      rows.add(from, upper, by.returns.front(), period, by);
  }
  const int after = returns.last() - sale.at;
  const double now = returns.age(after);
  if (surviving > 0 && returns.age_in_use(after) > 0)
    rows.add(now, NAN, surviving, period, {"", sale.row});
}

NumberColumn column_of_lives(const char* name, const Unit& period, std::vector<double> values) {
  for (double& each : values) each = to_si(period, each);
  formula::AnyUnit unit = formula::read_any_unit(period.text);
  return {name, name, std::move(unit), std::move(values)};
}

Column table_column(const std::string& name, const Unit& unit, const std::vector<double>& values) {
  Column column{name, true, values, {}};
  column.unit = unit.text;
  return column;
}

}  // namespace

double FieldReturns::age(int after) const {
  const double end = whole ? after : after + 1 - start;
  return reporting ? std::max(end, 0.0) : std::clamp(end - delay, 0.0, warranty);
}

double FieldReturns::least_delay() const {
  return reporting ? reporting->least() / period.scale : delay;
}

double FieldReturns::age_in_use(int after) const {
  return reporting ? std::clamp(age(after) - least_delay(), 0.0, warranty) : age(after);
}

bool FieldReturns::claimed(int after) const {
  if (!reporting) return age(after) > age(after - 1);
  return age_in_use(after) > 0 &&
         to_si(period, age(after - 1)) < reporting->most() + reporting->warranty;
}

std::shared_ptr<const FieldReturns> read_field_returns(const TomlReader& root,
                                                       const Source& source) {
  const TomlReader data = root.required_table("data");
  const TomlReader keys = data.required_table("returns");
  if (data.has("columns"))
    data.fail("columns", "does not go with [data.returns], which names the columns of a triangle");
  FieldReturns returns;
  const auto modes = root.table("failure_modes");
  if (modes && modes->has("runout") && keys.has("mode") && !keys.has("returned"))
    modes->fail("runout",
                fmt::format("does not go with a returns triangle: its rows count returns, so each "
                            "word of column '{}' is a failure mode; remove the rows of returns "
                            "that are no failures",
                            keys.required_text("mode")));
  const ModeWords words = modes ? read_mode_words(*modes) : ModeWords();
  returns.triangle = keys.has("returned") ? counted_triangle(keys, read_table(data, source), words)
                                          : read_triangle(keys, read_table(data, source), words);
  returns.period = read_period(keys, returns.triangle.names);
  const std::string ages =
      keys.choice("ages", {"middle", "start", "end", "whole"}).value_or("middle");
  returns.start = ages == "start" ? 0 : ages == "middle" ? 0.5 : 1;
  returns.whole = ages == "whole";
  returns.warranty = in_periods(keys, "warranty", returns.period, returns.warranty);
  if (!(returns.warranty > 0)) keys.fail("warranty", "must be positive");
  read_delays(keys, source, returns);
  const double held = in_periods(keys, "hold_out", returns.period, 0);
  constexpr double close = 1e-9;
  if (std::abs(held - std::round(held)) > close)
    keys.fail("hold_out", fmt::format("must be whole {}s", returns.period.text));
  returns.held_out = static_cast<int>(std::lround(held));
  if (returns.last() < returns.triangle.sales.front().at)
    keys.fail("hold_out", "leaves no period to fit");
  return std::make_shared<const FieldReturns>(std::move(returns));
}

std::vector<std::string> modes_without_returns(const FieldReturns& returns) {
  std::vector<std::string> without = returns.triangle.modes;
  for (const SalesPeriod& sale : returns.triangle.sales) {
    for (const ModeReturns& each : sale.by_mode) {
      bool any = false;
      for (int after = 0; sale.at + after <= returns.last(); ++after)
        any |= each.returns[static_cast<std::size_t>(after)] > 0 && returns.claimed(after);
      if (!any || each.mode.empty()) continue;
      for (const std::string& mode : modes_in(each.mode, [] { return std::string(); }))
        std::erase(without, mode);
    }
  }
  return without;
}

std::string fitted_periods(const FieldReturns& returns) {
  return fmt::format("in the fitted {}s (until {})", returns.period.text,
                     returns.triangle.names.text(returns.last()));
}

FormulaData lives_of_returns(const FieldReturns& returns) {
  LifeRows rows;
  for (const SalesPeriod& each : returns.triangle.sales)
    if (each.at <= returns.last()) add_failures(returns, each, rows);
  if (rows.count.empty())
    throw InputError(fmt::format("{}: no unit has been in use yet, so there is nothing to fit",
                                 returns.triangle.table.source));
  FormulaData data;
  const Unit plain{"1", 1, 0};
  data.table.source = returns.triangle.table.source;
  data.table.layout = returns.triangle.table.layout;
  data.table.rows = rows.count.size();
  data.reporting = returns.reporting;
  data.table.columns = {table_column("lower", returns.period, rows.lower),
                        table_column("upper", returns.period, rows.upper),
                        table_column("count", plain, rows.count)};
  data.table.columns.push_back(Column{"sold", false, {}, rows.sold});
  if (!returns.triangle.mode_column.empty()) {  // messages about modes name the cell of the file
    const Table& file = returns.triangle.table;
    data.table.columns.push_back(Column{returns.triangle.mode_column, false, {}, rows.mode});
    for (const std::size_t row : rows.row)
      data.table.origins.push_back(file.origins.empty() ? row + 1 : file.origins[row]);
    data.table.lines = file.lines;
  }
  data.numbers.push_back(column_of_lives("lower", returns.period, rows.lower));
  data.numbers.push_back(column_of_lives("upper", returns.period, rows.upper));
  data.numbers.push_back(column_of_lives("count", plain, rows.count));
  return data;
}

std::vector<std::string> notes_of_returns(const FieldReturns& returns) {
  const ReturnsTriangle& triangle = returns.triangle;
  const PeriodNames& names = triangle.names;
  long long sold = 0, returned = 0, late = 0;
  for (const SalesPeriod& each : triangle.sales) {
    if (each.at > returns.last()) continue;
    sold += each.sold;
    returned += each.returned(returns.last());
    for (int after = 0; each.at + after <= returns.last(); ++after)
      if (!returns.claimed(after)) late += each.returns[static_cast<std::size_t>(after)];
  }
  std::vector<std::string> notes = {
      fmt::format("returns triangle: {} units sold from {} to {}, {} returned until {}", sold,
                  names.text(triangle.sales.front().at),
                  names.text(std::min(triangle.sales.back().at, returns.last())), returned,
                  names.text(returns.last()))};
  if (returns.whole) {
    notes.push_back(fmt::format("a return k {0}s after the sale counts as a life of exactly k {0}s",
                                returns.period.text));
  } else {
    notes.push_back(
        fmt::format("ages count from the {} of the {} of sale; a return lies anywhere in its {}",
                    returns.start == 0   ? "start"
                    : returns.start == 1 ? "end"
                                         : "middle",
                    returns.period.text, returns.period.text));
  }
  notes.insert(notes.begin(), triangle.notes.begin(), triangle.notes.end());
  notes.insert(notes.end(), returns.delay_words.begin(), returns.delay_words.end());
  if (returns.reporting)
    notes.push_back(
        "delays vary: the fit takes each report as a life and a delay, over all delays that are "
        "possible");
  if (late > 0)
    notes.push_back(fmt::format(
        "{} return{} after the end of the warranty: counted as survivors of the warranty", late,
        late == 1 ? "" : "s"));
  if (triangle.sales.front().at < triangle.first && !returns.whole)
    notes.push_back(fmt::format("no column of {}: none is taken to have come back in it",
                                names.text(triangle.sales.front().at)));
  for (const std::string& mode : modes_without_returns(returns))
    notes.push_back(fmt::format(
        "failure mode '{}' has no return {}: it has no life in the fit and no part of the forecast",
        mode, fitted_periods(returns)));
  if (returns.held_out > 0)
    notes.push_back(
        fmt::format("{} {}s after {} are held out of the fit and compared with the "
                    "forecast",
                    returns.held_out, returns.period.text, names.text(returns.last())));
  if (!triangle.unread.empty())
    notes.push_back(
        fmt::format("columns that are not read: '{}'", fmt::join(triangle.unread, "', '")));
  return notes;
}

}  // namespace wearwell::formula_model
