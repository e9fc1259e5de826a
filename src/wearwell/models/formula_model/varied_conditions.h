#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "wearwell/bayes/parameter.h"
#include "wearwell/input/toml_reader.h"

namespace wearwell::formula_model {

/// A condition of use that differs from unit to unit; each unit keeps its own for life. Either a distribution or
/// values with the share of units of each.
struct VariedCondition {
  std::string column;
  Parameter distribution;                   ///< over units, SI
  std::vector<double> values, shares = {};  ///< SI; empty for a distribution
  double quantile(double p) const;          ///< SI
};

/// Reads { distribution = "normal", mean = "40 degC", sd = "5 K" }, with the distributions and keys of a prior, or
/// { values = ["20 degC", "35 degC"], shares = [0.7, 0.3] }, under `column` of `table`. Throws InputError.
VariedCondition read_varied_condition(const TomlReader& table, const std::string& column,
                                      const std::string& si);

/// "temperature ~ normal (mean 40, sd 5 degC)".
std::string description(const VariedCondition& condition);

/// Units by their conditions: values in SI, `columns` to each node, and the share of each node. Shares sum to 1.
struct ConditionNodes {
  std::size_t columns = 0;
  std::vector<double> at, share;
  std::vector<bool>
      drawn;  ///< of each column: from a distribution, so that a finer rule has nodes between
  std::size_t count() const { return share.size(); }
};

/// Independent conditions as nodes: products of the trapezoidal rule in the normal score of each. Its error for a
/// smooth integrand falls like exp(-2 pi^2/step^2), so the rules, from coarse to fine, halve the step from 0.5 on.
struct VariedConditions {
  static constexpr std::size_t most = 2;  ///< columns with a distribution
  std::vector<VariedCondition> conditions;
  std::vector<ConditionNodes> rules;
};
/// Throws InputError where a quantile is not finite. At most VariedConditions::most distributions.
std::shared_ptr<const VariedConditions> varied_conditions(std::vector<VariedCondition> conditions);

}  // namespace wearwell::formula_model
