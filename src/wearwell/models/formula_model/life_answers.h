#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "wearwell/base/unit.h"
#include "wearwell/models/formula_model/formula_life.h"
#include "wearwell/models/formula_model/observed_lives.h"
#include "wearwell/study/life_levels.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell::formula_model {

/// What [predict] asks of a life that is measured itself.
struct AskedOfLife {
  std::shared_ptr<const LifeDistribution> life;   ///< under the conditions
  std::shared_ptr<const LifeDistribution> fast;   ///< under those of a test; may be null
  std::shared_ptr<const LifeDistribution> other;  ///< compared with; may be null
  LifeLevels levels;
  bool mean = false;                 ///< the mean life, and the mean remaining useful life
  std::optional<Quantity> survived;  ///< lives are also reported from there on
  std::vector<Quantity> survival, hazard;
  ObservedLives observed = {};  ///< how far the data reach
};

/// In this order: the life of the next item, its B-lives, its mean life; the same from `survived`
/// on; survival; against `other`: probability to outlive it, ratios of B-lives, differences of
/// survival; hazard, acceleration factor.
std::vector<QuantityQuantiles> life_answers(const AskedOfLife& asked, const WeightedDraws& draws);

/// The life of the next item, and from `survived` on.
std::vector<PredictiveLife> predictive_lives(const AskedOfLife& asked, const WeightedDraws& draws);

}  // namespace wearwell::formula_model
