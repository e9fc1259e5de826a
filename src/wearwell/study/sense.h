#pragma once

#include <string>
#include <vector>

#include "wearwell/infer/check.h"
#include "wearwell/study/posterior_summary.h"

namespace wearwell {

/// Beyond so many times what was seen a prediction is warned of.
inline constexpr double farthest_reach = 3;

/// Beyond so many times it fails: no number there is to be used.
inline constexpr double absurd_reach = 100;

/// A 90 % interval of a result that spans more decades is warned of.
inline constexpr double widest_interval = 3;

/// One that spans so many fails.
inline constexpr double absurd_interval = 6;

/// Something asked for, against the largest of its kind that the data hold; one unit, in words.
struct Reach {
  std::string what;     ///< "the prediction at 60000 cycles"
  std::string seen_as;  ///< "the last inspection was after 10000"
  double asked = 0, seen = 0;
};

/// Nothing asked for lies beyond `farthest_reach` times what was seen. Name: extrapolation.
Check extrapolation_check(const std::vector<Reach>& reaches);

/// The limit is not passed already with more than the tolerated risk. Name: limit.
Check limit_check(const LifeSummary& life);

/// Results are numbers, and their intervals say something. Name: sense.
Check sense_check(const PosteriorSummary& result);

}  // namespace wearwell
