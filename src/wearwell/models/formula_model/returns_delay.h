#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wearwell/input/source.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/math/gauss_of_points.h"
#include "wearwell/prob/reporting_delay.h"

namespace wearwell::formula_model {

/// A delay of [data.returns]: one time, or a distribution of times.
struct ReturnsDelay {
  std::vector<WeightedPoint> points;  ///< in periods, ascending; weights add up to 1
  std::string words = {};             ///< "lognormal, mean 1.2 month"; empty for a fixed time

  bool varies() const { return !words.empty(); }
};

/// Reads `key`: a time ("1 month"), a distribution as of a prior (input/prior.h), or a table with columns `delay` and
/// `share`. Without the key it is 0. Throws InputError: a negative delay, shares that do not add up to 1.
ReturnsDelay read_returns_delay(const TomlReader& keys, const char* key, const Source& source,
                                const Unit& period);

/// The sum of two independent delays, SI. In each cell of a quarter of a period (of a sixteenth of the delay, where that is
/// longer) two points have the mass and the first three moments of the distribution there (Gauss's rule); one or two
/// different times are kept as they are.
ReportingDelay sum_of_delays(const ReturnsDelay& a, const ReturnsDelay& b, const Unit& period);

}  // namespace wearwell::formula_model
