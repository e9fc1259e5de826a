#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "wearwell/models/formula_model/formula_life.h"
#include "wearwell/models/formula_model/formula_likelihood.h"

namespace wearwell::formula_model {

/// How far the data reach on the axis of a life.
class ObservedLives {
 public:
  ObservedLives() = default;
  explicit ObservedLives(std::shared_ptr<const FormulaRows> rows);

  /// The same of another life of these items, such as that of one failure mode.
  ObservedLives of_other_life() const;

  /// The longest observed life, SI: a failure, a run-out, the end of an interval. If lives depend on
  /// conditions, the life under those of `life` to which it corresponds: the largest share that has failed
  /// at an observation, at the mean of the posterior. None where that is not defined (failure modes,
  /// another life or random effects under conditions).
  std::optional<double> longest(const LifeDistribution& life, const WeightedDraws& draws) const;

 private:
  std::optional<double> longest_;
  std::shared_ptr<const FormulaRows> rows_;  // null if lives do not depend on conditions
};

}  // namespace wearwell::formula_model
