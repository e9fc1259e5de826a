#include "wearwell/models/formula_model/varied_conditions.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "wearwell/base/error.h"
#include "wearwell/input/prior.h"
#include "wearwell/models/formula_model/effect_lines.h"
#include "wearwell/prob/standard_distribution.h"
#include "wearwell/study/describe.h"

namespace wearwell::formula_model {
namespace {

// Steps 0.5, 0.25, ... in the normal score; of a product fewer, because it has the square of the nodes.
constexpr int finest_rule = 6, finest_product = 2;
// Nodes of a product with a smaller share are left out.
constexpr double least_node = 1e-10;

VariedCondition read_values(const TomlReader& table, const std::string& column,
                            const std::string& si) {
  VariedCondition found{column, {}, {}, {}};
  std::vector<Quantity> values = table.quantities("values", si);
  if (values.empty()) table.fail("values", "is empty; write the conditions of the units");
  for (const Quantity& each : values) found.values.push_back(each.si());
  found.distribution.name = column;
  found.distribution.unit = values.front().unit;
  for (const Quantity& each : table.quantities("shares", "1")) {
    if (!(each.si() > 0) || !std::isfinite(each.si()))
      table.fail("shares", "must be positive: the share of units, or their number");
    found.shares.push_back(each.si());
  }
  if (found.shares.empty()) found.shares.assign(values.size(), 1);
  if (found.shares.size() != values.size())
    table.fail("shares", fmt::format("has {} entries for {} values; write one for each",
                                     found.shares.size(), values.size()));
  const double sum = std::accumulate(found.shares.begin(), found.shares.end(), 0.0);
  for (double& each : found.shares) each /= sum;
  return found;
}

ConditionNodes nodes_of(const VariedCondition& condition, double step) {
  if (!condition.values.empty()) return {1, condition.values, condition.shares, {false}};
  const NormalNodes nodes(1, 6.5, step);
  ConditionNodes found{1, {}, nodes.weight, {true}};
  for (const double z : nodes.z)
    found.at.push_back(
        quantile(condition.distribution.prior, cdf(StandardDistribution::normal, z)));
  return found;
}

ConditionNodes product(const ConditionNodes& one, const ConditionNodes& other) {
  ConditionNodes found{one.columns + other.columns, {}, {}, one.drawn};
  found.drawn.insert(found.drawn.end(), other.drawn.begin(), other.drawn.end());
  double sum = 0;
  for (std::size_t i = 0; i < one.count(); ++i) {
    for (std::size_t j = 0; j < other.count(); ++j) {
      const double share = one.share[i] * other.share[j];
      if (!(share > least_node)) continue;
      const auto at = [](const ConditionNodes& nodes, std::size_t k) {
        return nodes.at.begin() + static_cast<std::ptrdiff_t>(k * nodes.columns);
      };
      found.at.insert(found.at.end(), at(one, i), at(one, i + 1));
      found.at.insert(found.at.end(), at(other, j), at(other, j + 1));
      found.share.push_back(share);
      sum += share;
    }
  }
  for (double& each : found.share) each /= sum;
  return found;
}

bool is_discrete(const VariedCondition& condition) {
  return !condition.values.empty();
}

}  // namespace

double VariedCondition::quantile(double p) const {
  if (values.empty()) return wearwell::quantile(distribution.prior, p);
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  double sum = 0;
  for (const std::size_t each : order)
    if ((sum += shares[each]) >= p) return values[each];
  return values[order.back()];
}

VariedCondition read_varied_condition(const TomlReader& table, const std::string& column,
                                      const std::string& si) {
  const TomlReader own = table.required_table(column);
  if (own.has("values")) {
    if (own.has("distribution"))
      own.fail("values", "stands beside distribution; write one of the two");
    return read_values(own, column, si);
  }
  if (own.has("shares")) own.fail("shares", "needs values: the conditions of the units");
  ParameterSpec spec{column, si};
  spec.varies_between_units = true;
  VariedCondition found{column, read_prior(table, spec), {}, {}};
  if (!found.distribution.prior.proper)
    own.fail("distribution",
             fmt::format("{} is no distribution of units; use one with a finite integral, for "
                         "example normal or uniform",
                         found.distribution.distribution));
  if (si == "K" && !(found.quantile(least_node) > 0))
    own.fail("", "reaches below absolute zero; state a lower bound (lower)");
  return found;
}

std::string description(const VariedCondition& condition) {
  const Unit& unit = condition.distribution.unit;
  if (is_discrete(condition)) {
    std::vector<std::string> parts;
    constexpr std::size_t most_shown = 4;
    for (std::size_t i = 0; i < std::min(condition.values.size(), most_shown); ++i)
      parts.push_back(fmt::format("{:.6g}: {:.4g} %", from_si(unit, condition.values[i]),
                                  100 * condition.shares[i]));
    if (condition.values.size() > most_shown)
      parts.push_back(fmt::format("{} more", condition.values.size() - most_shown));
    return fmt::format("{}{} ~ {}", condition.column,
                       unit.text == "1" ? "" : " [" + unit.text + "]", fmt::join(parts, ", "));
  }
  std::string words = prior_text(condition.distribution);
  const std::size_t at = words.find(", ");
  if (at != words.npos) words.replace(at, 2, " (") += ")";
  return condition.column + " ~ " + words;
}

std::shared_ptr<const VariedConditions> varied_conditions(std::vector<VariedCondition> conditions) {
  VariedConditions found;
  const auto drawn = std::count_if(conditions.begin(), conditions.end(),
                                   [](const auto& each) { return !is_discrete(each); });
  const int finest = drawn == 0 ? 0 : drawn == 1 ? finest_rule : finest_product;
  for (int k = 0; k <= finest; ++k) {
    ConditionNodes all = nodes_of(conditions.front(), std::ldexp(0.5, -k));
    for (std::size_t i = 1; i < conditions.size(); ++i)
      all = product(all, nodes_of(conditions[i], std::ldexp(0.5, -k)));
    for (const double each : all.at)
      if (!std::isfinite(each)) throw InputError("is too wide: its quantiles are not finite");
    found.rules.push_back(std::move(all));
  }
  found.conditions = std::move(conditions);
  return std::make_shared<const VariedConditions>(std::move(found));
}

}  // namespace wearwell::formula_model
