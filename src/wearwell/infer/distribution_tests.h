#pragma once

#include "wearwell/infer/fit_check.h"

namespace wearwell {

/// Scores of single observations under draws of a posterior: draws x observations. `row` is the
/// observation of `FitData` for each score; repeated observations occur repeatedly.
struct ScoreSample {
  const std::vector<std::vector<double>>& scores;
  const std::vector<std::size_t>& row;
  const std::vector<bool>& exact;  ///< for each observation of `FitData`: its score is not an
                                   ///< interval
  const std::vector<std::vector<double>>&
      effects;  ///< draws x random effects, as in `FitData::effects`
  const WeightedDraws& draws;
};

/// Tests the shape of the scores' distribution, equal scatter along drivers, fitted values and
/// labels, and, for models that start from zero, a missing offset. For a correct model they
/// together warn in at most 4.5 of 1000 studies and fail in 4.5 of 10,000 (`FitTest::share`).
std::vector<FitTest> distribution_tests(const FitData& data, const ScoreSample& sample);

}  // namespace wearwell
