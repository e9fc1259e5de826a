#pragma once

#include <string>
#include <vector>

#include "wearwell/infer/check.h"
#include "wearwell/study/posterior_summary.h"

namespace wearwell {

/// A prediction beyond this multiple of the observed range is a warning.
inline constexpr double farthest_reach = 3;

/// A prediction beyond this multiple fails the check.
inline constexpr double absurd_reach = 100;

/// A 90 % interval that spans more decades is a warning.
inline constexpr double widest_interval = 3;

/// A 90 % interval that spans more decades fails the check.
inline constexpr double absurd_interval = 6;

/// A requested value compared with the largest in the data, both in the same unit, with texts for
/// messages.
struct Reach {
  std::string what;     ///< "the prediction at 60000 cycles"
  std::string seen_as;  ///< "the last inspection was after 10000"
  double asked = 0, seen = 0;
};

/// Checks that no request lies beyond `farthest_reach` times the observed range. Name:
/// extrapolation.
Check extrapolation_check(const std::vector<Reach>& reaches);

/// Checks that the risk that the limit is already passed is tolerated. Name: limit.
Check limit_check(const LifeSummary& life);

/// Checks that results are finite and that their intervals are informative. Name: sense.
Check sense_check(const PosteriorSummary& result);

}  // namespace wearwell
