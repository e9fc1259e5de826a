#pragma once

#include <functional>
#include <string>
#include <vector>

#include "wearwell/models/formula_model/classical_estimates.h"

namespace wearwell::formula_model {

/// A parameter or a quantity on the scale of its normal approximation, and back to SI.
struct ScaledQuantity {
  std::string name, of, at;
  Unit unit;
  std::string scale;
  std::function<MaximumLikelihood::Quantity()> make;  ///< one for each thread
  std::function<double(double)> si;
  std::function<QuantityDistribution(const WeightedDraws&)> posterior;  ///< SI
  bool increasing = true;
  std::function<MaximumLikelihood::Comparison()> compare = {};  ///< if faster than by the quantity
};

/// The scale of a parameter: that of its place in the family, or by the support of its prior.
NormalScale normal_scale(const FormulaModel& model, const Parameter& parameter);

/// Parameter i; it has no `make`.
ScaledQuantity scaled_parameter(const Parameter& parameter, std::size_t i, NormalScale scale);

/// B-lives, mean life and survival of each life that is asked for.
std::vector<ScaledQuantity> scaled_quantities(const AskedOfClassics& asked);

}  // namespace wearwell::formula_model
