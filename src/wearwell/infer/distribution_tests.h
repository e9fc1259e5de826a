#pragma once

#include "wearwell/infer/fit_check.h"

namespace wearwell {

/// Scores of single observations under draws of a posterior: draws x observations. `row` says which observation
/// of `FitData` each is (one that was seen several times stands there as often).
struct ScoreSample {
  const std::vector<std::vector<double>>& scores;
  const std::vector<std::size_t>& row;
  const std::vector<bool>& exact;  ///< of each observation of `FitData`: its score is no interval
  const std::vector<std::vector<double>>&
      effects;  ///< draws x effects of units, as `FitData::effects`
  const WeightedDraws& draws;
};

/// Whether scores have the shape of their distribution, and scatter alike along drivers, along what the law expects and
/// between labels; of laws that start from zero, whether an offset was left out. Of right laws these warn in 4.5 of 1000
/// studies at most, and fail in 4.5 of 10,000, together (`FitTest::share`).
std::vector<FitTest> distribution_tests(const FitData& data, const ScoreSample& sample);

}  // namespace wearwell
