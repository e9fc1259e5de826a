#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "wearwell/bayes/parameter.h"
#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/infer/maximum_likelihood.h"
#include "wearwell/present/table.h"
#include "wearwell/prob/standard_distribution.h"

namespace wearwell {

/// The estimates of predict.classical, as every model reports them.

/// The confidence of bounds.
struct ClassicalLevel {
  double level = 0.9;      ///< of each bound, or of the interval between both
  bool two_sided = false;  ///< of the interval

  /// The probability between a lower and an upper bound.
  double within() const { return two_sided ? level : 2 * level - 1; }
  /// The probability below a lower bound, and that above an upper one.
  double outside() const { return 0.5 * (1 - within()); }
  /// The number of standard errors of a normal bound.
  double deviate() const { return quantile(StandardDistribution::normal, 0.5 * (1 + within())); }
};

/// Bounds from the exact distribution of an estimate, in the unit of reports.
struct ExactBounds {
  double lower = 0, upper = 0;  ///< the upper one of a mean time without failures is infinite
  std::string method;           ///< "chi-square", "Crow"
};

/// An estimate with its bounds, in the unit of reports.
struct ClassicalEstimate {
  std::string name, of, at, unit;
  double value = 0, standard_error = 0;
  std::string scale;  ///< of the normal approximation: "log", "natural", "Weibull paper"
  double lower = 0, upper = 0;
  ProfileEnd ratio_lower, ratio_upper;              ///< likelihood ratio
  double posterior_lower = 0, posterior_upper = 0;  ///< quantiles of the posterior
  std::optional<ExactBounds> exact = {};
};

/// Searches from the starts of the parameters and from points that represent `draws`.
MaximumLikelihood maximum_of(std::shared_ptr<const LogDensity> likelihood,
                             const std::vector<NormalScale>& scales,
                             const std::vector<Parameter>& parameters, const WeightedDraws& draws);

/// Sets value, standard error (delta method), normal and likelihood-ratio bounds; `shown` takes the scale of
/// `bounds` to the unit of reports.
void set_bounds(ClassicalEstimate& estimate, const ClassicalBounds& bounds,
                const std::function<double(double)>& shown);

/// "two-sided bounds with 90 % confidence".
std::string confidence_text(const ClassicalLevel& level);

/// The table maximum-likelihood-estimates of a report; names are complete.
present::Table estimate_table(std::span<const ClassicalEstimate> estimates,
                              const ClassicalLevel& level);
/// The same for a terminal.
std::string estimate_text(std::span<const ClassicalEstimate> estimates);
nlohmann::ordered_json estimate_json(const ClassicalEstimate& each);

}  // namespace wearwell
