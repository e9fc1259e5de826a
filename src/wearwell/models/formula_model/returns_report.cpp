#include "wearwell/models/formula_model/returns_report.h"

#include <fmt/format.h>

#include <cmath>

#include "wearwell/present/plain.h"
#include "wearwell/present/text_table.h"

namespace wearwell::formula_model {
namespace {

using Json = nlohmann::ordered_json;
using present::Range;

constexpr std::size_t most_lines = 60;  // of a terminal

Range number_range(const ReturnsCount& count) {
  return {count.count_low, count.count_high};
}
Range expected_range(const ReturnsCount& count) {
  return {count.low, count.high};
}

present::Cell observed_cell(const std::optional<int>& observed) {
  return observed ? present::Cell(static_cast<double>(*observed)) : present::Cell();
}

present::Table fitted_table(const AskedReturns& asked, const ReturnsResult& result) {
  present::Table table{
      "returns-fitted",
      fmt::format("Returns by {} as the fit gives them, given those before", asked.period(1)),
      {{asked.period(1)},
       {"returned", "1", present::given},
       {"expected", "1"},
       {"90 % of the number", "1", present::given, true},
       {"residual", "1", present::fixed(2)}}};
  for (const ReturnsPeriod& each : result.fitted)
    table.rows.push_back({asked.returns->triangle.names.text(each.at), observed_cell(each.observed),
                          each.number.expected, number_range(each.number),
                          residual(*each.observed, each.number)});
  return table;
}

present::Table forecast_table(const AskedReturns& asked, const ReturnsResult& result) {
  const std::string unit = asked.currency.empty() ? "1" : asked.currency;
  present::Table table{"returns-forecast",
                       "Returns to come; the number is a whole number",
                       {{asked.period(1)},
                        {"expected", "1"},
                        {"90 % of the expected", "1", {}, true},
                        {"90 % of the number", "1", present::given, true},
                        {"of units in use", "1"},
                        {"of later sales", "1"},
                        {"until then", "1"},
                        {"until then, 90 % of the number", "1", present::given, true},
                        {"cost until then", unit},
                        {"cost until then, 90 %", unit, {}, true},
                        {"returned (held out)", "1", present::given}}};
  for (const ReturnsPeriod& each : result.forecast) {
    std::vector<present::Cell> row = {asked.returns->triangle.names.text(each.at),
                                      each.number.expected,
                                      expected_range(each.number),
                                      number_range(each.number),
                                      each.field.expected,
                                      each.planned.expected,
                                      each.until.expected,
                                      number_range(each.until)};
    if (asked.cost) {
      row.emplace_back(*asked.cost * each.until.expected);
      row.emplace_back(
          Range{*asked.cost * each.until.count_low, *asked.cost * each.until.count_high});
    } else {
      row.resize(row.size() + 2);
    }
    row.push_back(observed_cell(each.observed));
    table.rows.push_back(std::move(row));
  }
  return table;
}

present::Table sales_table(const AskedReturns& asked, const ReturnsResult& result) {
  const std::string next = fmt::format("next {} {}", asked.ahead, asked.period(asked.ahead));
  present::Table table{"returns-by-sale",
                       fmt::format("Returns by {} of sale", asked.period(1)),
                       {{"sold in"},
                        {"sold", "1", present::given},
                        {"returned", "1", present::given},
                        {"returned", "%", present::digits(3)},
                        {"expected", "1"},
                        {"90 % of the number", "1", present::given, true},
                        {"residual", "1", present::fixed(2)},
                        {next + ", expected", "1"},
                        {next + ", 90 % of the number", "1", present::given, true}}};
  for (const ReturnsOfSale& each : result.sales) {
    constexpr double percent = 100;
    std::vector<present::Cell> row = {asked.returns->triangle.names.text(each.at),
                                      static_cast<double>(each.sold),
                                      static_cast<double>(each.returned),
                                      percent * each.returned / each.sold,
                                      each.fitted.expected,
                                      number_range(each.fitted),
                                      residual(each.returned, each.fitted)};
    if (asked.ahead > 0) {
      row.emplace_back(each.ahead.expected);
      row.emplace_back(number_range(each.ahead));
    } else {
      row.resize(row.size() + 2);
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

present::Table cells_table(const AskedReturns& asked, const ReturnsResult& result) {
  present::Table table{"returns-cells",
                       fmt::format("Returns to come by {0} of sale and {0}", asked.period(1)),
                       {{"sold in"},
                        {asked.period(1)},
                        {"expected", "1"},
                        {"90 % of the number", "1", present::given, true}}};
  const PeriodNames& names = asked.returns->triangle.names;
  for (const ReturnsOfSale& each : result.sales) {
    for (std::size_t k = 0; k < each.cells.size(); ++k)
      table.rows.push_back({names.text(each.at),
                            names.text(asked.returns->last() + 1 + static_cast<int>(k)),
                            each.cells[k].expected, number_range(each.cells[k])});
  }
  return table;
}

std::string count_text(const ReturnsCount& count) {
  return fmt::format("{} to {}", plain_given(count.count_low), plain_given(count.count_high));
}

// How the forecast of held-out periods did.
struct HeldOut {
  int periods = 0, inside = 0, returned = 0;
  const ReturnsPeriod* last = nullptr;
};
HeldOut held_out(const ReturnsResult& result) {
  HeldOut held;
  for (const ReturnsPeriod& each : result.forecast) {
    if (!each.observed) break;
    ++held.periods;
    held.inside +=
        *each.observed >= each.number.count_low && *each.observed <= each.number.count_high;
    held.returned += *each.observed;
    held.last = &each;
  }
  return held;
}

std::string held_out_text(const AskedReturns& asked, const HeldOut& held) {
  return fmt::format(
      "Held out: {} {}. {} of them lie in their 90 % intervals. Together {} were returned; the "
      "forecast is {} ({} with 90 %).",
      held.periods, asked.period(held.periods), held.inside, plain_given(held.returned),
      plain_number(held.last->until.expected), count_text(held.last->until));
}

std::string forecast_text(const AskedReturns& asked, const ReturnsResult& result) {
  std::vector<std::vector<std::string>> lines = {{"  " + asked.period(1), "expected",
                                                  "90 % of the number", "until then",
                                                  "90 % of the number"}};
  if (asked.cost)
    lines.front().push_back("cost until then" +
                            (asked.currency.empty() ? "" : fmt::format(" [{}]", asked.currency)));
  for (const ReturnsPeriod& each : result.forecast) {
    if (lines.size() > most_lines) break;
    lines.push_back({"  " + asked.returns->triangle.names.text(each.at),
                     plain_number(each.number.expected), count_text(each.number),
                     plain_number(each.until.expected), count_text(each.until)});
    if (asked.cost) lines.back().push_back(plain_number(*asked.cost * each.until.expected));
  }
  return text_table(lines);
}

Json period_json(const AskedReturns& asked, const ReturnsPeriod& each, bool to_come) {
  Json json = {{"period", asked.returns->triangle.names.text(each.at)}};
  if (each.observed) json["observed"] = *each.observed;
  if (each.observed && !asked.modes.empty()) json["unknown_mode"] = each.masked;
  for (const auto& [mode, count] : each.unfitted)
    json["unfitted_modes"].push_back({{"mode", mode}, {"observed", count}});
  json.update(count_json(each.number));
  if (!to_come) {
    json["residual"] = residual(*each.observed, each.number);
    if (!each.by_mode.empty()) json["modes"] = modes_json(asked, each, false);
    return json;
  }
  json["of_units_in_use"] = each.field.expected;
  json["of_later_sales"] = each.planned.expected;
  json["until_then"] = count_json(each.until);
  if (asked.cost) json["cost_until_then"] = *asked.cost * each.until.expected;
  if (!each.by_mode.empty()) json["modes"] = modes_json(asked, each, true);
  return json;
}

Json returns_json(const AskedReturns& asked, const ReturnsResult& result) {
  const FieldReturns& returns = *asked.returns;
  Json json = {{"period", returns.period.text},
               {"last", returns.triangle.names.text(returns.last())},
               {"fitted", Json::array()},
               {"by_sale", Json::array()},
               {"forecast", Json::array()}};
  for (const ReturnsPeriod& each : result.fitted)
    json["fitted"].push_back(period_json(asked, each, false));
  for (const ReturnsOfSale& each : result.sales) {
    json["by_sale"].push_back({{"sold_in", returns.triangle.names.text(each.at)},
                               {"sold", each.sold},
                               {"returned", each.returned},
                               {"fitted", count_json(each.fitted)},
                               {"residual", residual(each.returned, each.fitted)}});
    if (asked.ahead > 0) json["by_sale"].back()["ahead"] = count_json(each.ahead);
  }
  for (const ReturnsPeriod& each : result.forecast)
    json["forecast"].push_back(period_json(asked, each, true));
  const HeldOut held = held_out(result);
  if (held.periods > 0)
    json["held_out"] = {{"periods", held.periods},
                        {"inside", held.inside},
                        {"returned", held.returned},
                        {"forecast", count_json(held.last->until)}};
  if (asked.cost) {
    json["cost_per_return"] = *asked.cost;
    json["currency"] = asked.currency;
  }
  return json;
}

}  // namespace

Json count_json(const ReturnsCount& count) {
  return {{"expected", count.expected},
          {"expected_q05", count.low},
          {"expected_q95", count.high},
          {"number_q05", count.count_low},
          {"number_q95", count.count_high}};
}

PresetAddition returns_addition(const AskedReturns& asked, const WeightedDraws& draws) {
  const ReturnsResult result = returns_result(asked, draws, {.sales = true, .modes = true});
  PresetAddition added;
  added.body["returns"] = returns_json(asked, result);
  std::vector<present::Block>& predictions = added.blocks["predictions"];
  const HeldOut held = held_out(result);
  if (asked.ahead > 0) {
    added.text += "Returns to come\n" + forecast_text(asked, result);
    if (held.periods > 0) {
      added.text += wrapped(held_out_text(asked, held), 2);
      predictions.push_back({present::Prose{held_out_text(asked, held)}});
    }
    predictions.push_back({forecast_table(asked, result)});
    if (asked.modes.size() > 1) {
      added.text += "Returns to come by failure mode\n" + modes_text(asked, result);
      predictions.push_back({modes_forecast_table(asked, result)});
    }
    predictions.push_back({cells_table(asked, result)});
  }
  for (const std::string& remark : modes_remarks(asked, result)) added.text += wrapped(remark, 2);
  added.blocks["fit"].push_back({fitted_table(asked, result)});
  if (asked.modes.size() > 1) added.blocks["fit"].push_back({modes_fitted_table(asked, result)});
  added.blocks["fit"].push_back({sales_table(asked, result)});
  return added;
}

std::string returns_clause(const AskedReturns& asked, const WeightedDraws& draws) {
  const ReturnsResult result = returns_result(asked, draws);
  const ReturnsPeriod& last = result.forecast.back();
  const std::string cost =
      asked.cost
          ? fmt::format("; expected cost {}{}", plain_number(*asked.cost * last.until.expected),
                        asked.currency.empty() ? "" : " " + asked.currency)
          : "";
  const PeriodNames& names = asked.returns->triangle.names;
  const std::string when =
      asked.ahead == 1 ? "in " + names.text(last.at)
                       : fmt::format("from {} to {}", names.text(result.forecast.front().at),
                                     names.text(last.at));
  return fmt::format("{} returns are expected {}; {} with 90 %{}",
                     plain_number(last.until.expected), when, count_text(last.until), cost);
}

}  // namespace wearwell::formula_model
