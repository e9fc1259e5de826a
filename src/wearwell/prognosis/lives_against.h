#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/prognosis/named_life.h"

namespace wearwell::prognosis {

/// A value over two independent posteriors.
struct ComparedValue {
  double q05 = 0, q50 = 0, q95 = 0;
  double mean = 0;
  double lower = 0;   ///< lies below the value with probability `confidence`
  double larger = 0;  ///< the probability that it is larger than where both lives are the same
};

/// Lives of new items of two results, whose posteriors are independent.
struct LivesAgainst {
  double confidence = 0.9;
  /// The probability that an item lives longer than one of the other; its mean is that of the next
  /// two items. The same: 1/2.
  ComparedValue outlives;
  struct Ratio {
    double percent = 0;
    ComparedValue of;  ///< of this life over that of the other. The same: 1
  };
  std::vector<Ratio> ratios;  ///< of B1, B10 and B50 lives that both reach
  /// The others: at some points of the posteriors neither life is reached.
  std::vector<double> without_ratio;
  /// The share of items that live longer than `use`, less that of the other. The same: 0.
  std::optional<ComparedValue> survival;
};

/// A life of a study with its posterior.
struct LifeOfResult {
  NamedLife life;
  const WeightedDraws& posterior;
};

/// `use` is in SI, of both lives, whose units have one dimension. Each posterior is thinned to at most 400
/// points, and every pair of points counts by its weights.
LivesAgainst lives_against(const LifeOfResult& life, const LifeOfResult& other, double confidence,
                           std::optional<double> use);

}  // namespace wearwell::prognosis
