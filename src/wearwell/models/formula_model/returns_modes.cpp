#include <fmt/format.h>

#include "wearwell/models/formula_model/returns_report.h"
#include "wearwell/present/plain.h"
#include "wearwell/present/text_table.h"

namespace wearwell::formula_model {
namespace {

using Json = nlohmann::ordered_json;

// Returns of several possible modes are known in all, not by mode.
int masked_in(const std::vector<ReturnsPeriod>& periods) {
  int sum = 0;
  for (const ReturnsPeriod& each : periods) sum += each.masked;
  return sum;
}

std::string masked_text(int masked) {
  if (masked == 0) return "";
  return fmt::format("; {} return{} of unknown mode in no row", masked,
                     masked == 1 ? " is" : "s are");
}

}  // namespace

present::Table modes_fitted_table(const AskedReturns& asked, const ReturnsResult& result) {
  const int masked = masked_in(result.fitted);
  present::Table table{
      "returns-fitted-by-mode",
      fmt::format("Returns by {} and failure mode as the fit gives them, given those before{}",
                  asked.period(1), masked_text(masked)),
      {{asked.period(1)},
       {"failure mode"},
       {"returned", "1", present::given},
       {"expected", "1"},
       {"90 % of the number", "1", present::given, true},
       {"residual", "1", present::fixed(2)}}};
  for (const ReturnsPeriod& each : result.fitted) {
    for (std::size_t k = 0; k < each.by_mode.size(); ++k) {
      const ReturnsByMode& of = each.by_mode[k];
      table.rows.push_back(
          {asked.returns->triangle.names.text(each.at), asked.modes[k],
           static_cast<double>(of.observed), of.number.expected,
           present::Range{of.number.count_low, of.number.count_high},
           each.masked > 0 ? present::Cell() : present::Cell(residual(of.observed, of.number))});
    }
  }
  return table;
}

present::Table modes_forecast_table(const AskedReturns& asked, const ReturnsResult& result) {
  const int masked = masked_in(result.forecast);
  present::Table table{
      "returns-forecast-by-mode",
      "Returns to come by failure mode; the number is a whole number" + masked_text(masked),
      {{asked.period(1)},
       {"failure mode"},
       {"expected", "1"},
       {"90 % of the expected", "1", {}, true},
       {"90 % of the number", "1", present::given, true},
       {"until then", "1"},
       {"until then, 90 % of the number", "1", present::given, true},
       {"returned (held out)", "1", present::given}}};
  for (const ReturnsPeriod& each : result.forecast) {
    for (std::size_t k = 0; k < each.by_mode.size(); ++k) {
      const ReturnsByMode& of = each.by_mode[k];
      table.rows.push_back(
          {asked.returns->triangle.names.text(each.at), asked.modes[k], of.number.expected,
           present::Range{of.number.low, of.number.high},
           present::Range{of.number.count_low, of.number.count_high}, of.until.expected,
           present::Range{of.until.count_low, of.until.count_high},
           each.observed ? present::Cell(static_cast<double>(of.observed)) : present::Cell()});
    }
    for (const auto& [mode, count] : each.unfitted) {
      table.rows.push_back({asked.returns->triangle.names.text(each.at), mode});
      table.rows.back().resize(table.columns.size() - 1);
      table.rows.back().emplace_back(static_cast<double>(count));
    }
  }
  return table;
}

std::string modes_text(const AskedReturns& asked, const ReturnsResult& result) {
  const ReturnsPeriod& last = result.forecast.back();
  std::vector<std::vector<std::string>> lines = {
      {fmt::format("  until {}", asked.returns->triangle.names.text(last.at)), "expected",
       "90 % of the expected", "90 % of the number"}};
  for (std::size_t k = 0; k < last.by_mode.size(); ++k) {
    const ReturnsCount& until = last.by_mode[k].until;
    lines.push_back(
        {"  " + asked.modes[k], plain_number(until.expected),
         fmt::format("{} to {}", plain_number(until.low), plain_number(until.high)),
         fmt::format("{} to {}", plain_given(until.count_low), plain_given(until.count_high))});
  }
  return text_table(lines);
}

std::vector<std::string> modes_remarks(const AskedReturns& asked, const ReturnsResult& result) {
  std::vector<std::string> remarks;
  const auto add_masked = [&](const std::vector<ReturnsPeriod>& periods, const std::string& when) {
    const int masked = masked_in(periods);
    long long all = 0;
    for (const ReturnsPeriod& each : periods) all += each.observed.value_or(0);
    if (masked == 0) return;
    remarks.push_back(fmt::format(
        "Of {} returns {}, {} {} of unknown mode or of one of several: they count in all returns, "
        "in those of no single mode.",
        plain_given(static_cast<double>(all)), when, plain_given(masked),
        masked == 1 ? "is" : "are"));
  };
  add_masked(result.fitted, fitted_periods(*asked.returns));
  add_masked(result.forecast, fmt::format("in the held-out {}s", asked.period(1)));
  std::map<std::string, int> unfitted;
  for (const ReturnsPeriod& each : result.forecast)
    for (const auto& [mode, count] : each.unfitted) unfitted[mode] += count;
  for (const auto& [mode, count] : unfitted)
    remarks.push_back(fmt::format(
        "Held out: {} return{} by '{}', which has no return {}, so that the forecast does not "
        "have it.",
        plain_given(count), count == 1 ? "" : "s", mode, fitted_periods(*asked.returns)));
  return remarks;
}

Json modes_json(const AskedReturns& asked, const ReturnsPeriod& each, bool to_come) {
  Json all = Json::array();
  for (std::size_t k = 0; k < each.by_mode.size(); ++k) {
    const ReturnsByMode& of = each.by_mode[k];
    Json json = {{"mode", asked.modes[k]}};
    if (each.observed) json["observed"] = of.observed;
    json.update(count_json(of.number));
    if (to_come)
      json["until_then"] = count_json(of.until);
    else if (each.masked == 0)
      json["residual"] = residual(of.observed, of.number);
    all.push_back(std::move(json));
  }
  return all;
}

}  // namespace wearwell::formula_model
