#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "wearwell/models/formula_model/returns_report.h"

namespace wearwell::formula_model {
namespace {

// Returns within the warranty.
int claims(const FieldReturns& returns, const SalesPeriod& sale, int after) {
  if (after < 0 || static_cast<std::size_t>(after) >= sale.returns.size()) return 0;
  return returns.claimed(after) ? sale.returns[static_cast<std::size_t>(after)] : 0;
}

int claims_in(const FieldReturns& returns, int period) {
  int sum = 0;
  for (const SalesPeriod& each : returns.triangle.sales)
    sum += claims(returns, each, period - each.at);
  return sum;
}

// Of one period by failure mode; those of several possible modes, and of modes without a life in the fit, apart.
void add_observed(const AskedReturns& asked, ReturnsPeriod& found) {
  const FieldReturns& returns = *asked.returns;
  for (const SalesPeriod& sale : returns.triangle.sales) {
    const int after = found.at - sale.at;
    if (after < 0 || !returns.claimed(after)) continue;
    for (const ModeReturns& each : sale.by_mode) {
      const int count = each.returns[static_cast<std::size_t>(after)];
      if (count == 0) continue;
      const auto mode = std::find(asked.modes.begin(), asked.modes.end(), each.mode);
      const auto k = static_cast<std::size_t>(mode - asked.modes.begin());
      if (each.mode.empty() || each.mode.find('|') != each.mode.npos)
        found.masked += count;
      else if (mode == asked.modes.end())
        found.unfitted[each.mode] += count;
      else if (k < found.by_mode.size())
        found.by_mode[k].observed += count;
    }
  }
}

// Units that are sold after the fit: held out, or planned.
std::vector<std::pair<int, int>> later_sales(const AskedReturns& asked) {
  std::vector<std::pair<int, int>> later;
  for (const SalesPeriod& each : asked.returns->triangle.sales)
    if (each.at > asked.returns->last()) later.emplace_back(each.at, each.sold);
  later.insert(later.end(), asked.planned.begin(), asked.planned.end());
  return later;
}

// From period `from` to `to`, both after the fit.
std::vector<UnitsAtRisk> in_field(const FieldReturns& returns, int from, int to) {
  std::vector<UnitsAtRisk> groups;
  const int last = returns.last();
  for (const SalesPeriod& each : returns.triangle.sales) {
    if (each.at > last) continue;
    groups.push_back({static_cast<double>(each.sold - each.returned(last)), last - each.at,
                      from - each.at, to - each.at});
  }
  return groups;
}

std::vector<UnitsAtRisk> sold_later(const AskedReturns& asked, int from, int to) {
  std::vector<UnitsAtRisk> groups;
  for (const auto& [at, quantity] : later_sales(asked)) {
    if (at > to) continue;
    groups.push_back({static_cast<double>(quantity), -1, std::max(0, from - at), to - at});
  }
  return groups;
}

// Given what came back before.
std::vector<UnitsAtRisk> in_fitted_period(const FieldReturns& returns, int period) {
  std::vector<UnitsAtRisk> groups;
  for (const SalesPeriod& each : returns.triangle.sales) {
    const int after = period - each.at;
    if (after < 0) continue;
    groups.push_back(
        {static_cast<double>(each.sold - each.returned(period - 1)), after - 1, after, after});
  }
  return groups;
}

ReturnsPeriod forecast_of(const AskedReturns& asked, const ReturnsForecast& forecast, int period) {
  const FieldReturns& returns = *asked.returns;
  const int first = returns.last() + 1;
  ReturnsPeriod found;
  found.at = period;
  if (period <= returns.triangle.last) found.observed = claims_in(returns, period);
  std::vector<UnitsAtRisk> field = in_field(returns, period, period),
                           later = sold_later(asked, period, period);
  found.field = forecast.count(field);
  found.planned = forecast.count(later);
  field.insert(field.end(), later.begin(), later.end());
  found.number = forecast.count(field);
  std::vector<UnitsAtRisk> until = in_field(returns, first, period);
  const std::vector<UnitsAtRisk> sold = sold_later(asked, first, period);
  until.insert(until.end(), sold.begin(), sold.end());
  found.until = forecast.count(until);
  for (std::size_t k = 0; k < forecast.modes(); ++k)
    found.by_mode.push_back({0, forecast.count(field, k), forecast.count(until, k)});
  if (found.observed && !asked.modes.empty()) add_observed(asked, found);
  return found;
}

ReturnsOfSale sale_of(const AskedReturns& asked, const ReturnsForecast& forecast,
                      const SalesPeriod& sale) {
  const FieldReturns& returns = *asked.returns;
  const int now = returns.last() - sale.at;
  ReturnsOfSale found{sale.at, sale.sold, 0, {}, {}, {}};
  for (int after = 0; after <= now; ++after) found.returned += claims(returns, sale, after);
  const UnitsAtRisk all{static_cast<double>(sale.sold), -1, 0, now};
  found.fitted = forecast.count({&all, 1});
  const double left = sale.sold - sale.returned(returns.last());
  for (int k = 1; k <= asked.ahead; ++k) {
    const UnitsAtRisk cell{left, now, now + k, now + k};
    found.cells.push_back(forecast.count({&cell, 1}));
  }
  const UnitsAtRisk ahead{left, now, now + 1, now + asked.ahead};
  if (asked.ahead > 0) found.ahead = forecast.count({&ahead, 1});
  return found;
}

}  // namespace

int AskedReturns::most_after() const {
  return returns->last() + ahead - returns->triangle.sales.front().at;
}

std::string AskedReturns::period(int count) const {
  return returns->period.text + (count == 1 ? "" : "s");
}

ReturnsResult returns_result(const AskedReturns& asked, const WeightedDraws& draws,
                             const ReturnsParts& parts) {
  const FieldReturns& returns = *asked.returns;
  const ReturnsForecast forecast(returns, asked.risks, draws, asked.most_after(), parts.modes);
  ReturnsResult result;
  const int begin = std::max(returns.triangle.first, returns.triangle.sales.front().at);
  for (int period = begin; period <= returns.last(); ++period)
    result.fitted.push_back({period, claims_in(returns, period), {}, {}, {}, {}, {}, 0, {}});
  tbb::parallel_for(std::size_t{0}, result.fitted.size(), [&](std::size_t i) {
    ReturnsPeriod& each = result.fitted[i];
    const std::vector<UnitsAtRisk> groups = in_fitted_period(returns, each.at);
    each.number = forecast.count(groups);
    for (std::size_t k = 0; k < forecast.modes(); ++k)
      each.by_mode.push_back({0, forecast.count(groups, k), {}});
    if (!asked.modes.empty()) add_observed(asked, each);
  });
  result.forecast.resize(static_cast<std::size_t>(asked.ahead));
  tbb::parallel_for(0, asked.ahead, [&](int k) {
    result.forecast[static_cast<std::size_t>(k)] =
        forecast_of(asked, forecast, returns.last() + 1 + k);
  });
  if (!parts.sales) return result;
  const auto end = std::find_if(returns.triangle.sales.begin(), returns.triangle.sales.end(),
                                [&](const SalesPeriod& each) { return each.at > returns.last(); });
  result.sales.resize(static_cast<std::size_t>(end - returns.triangle.sales.begin()));
  tbb::parallel_for(std::size_t{0}, result.sales.size(), [&](std::size_t i) {
    result.sales[i] = sale_of(asked, forecast, returns.triangle.sales[i]);
  });
  return result;
}

double residual(int observed, const ReturnsCount& number) {
  return number.sd > 0 ? (observed - number.expected) / number.sd : std::nan("");
}

}  // namespace wearwell::formula_model
