#pragma once

#include <cmath>
#include <nlohmann/json.hpp>

#include "wearwell/prognosis/tracker_units.h"

namespace wearwell::prognosis {

/// JSON has no number for infinity and NaN.
inline nlohmann::ordered_json finite_or_null(double x) {
  return std::isfinite(x) ? nlohmann::ordered_json(x) : nlohmann::ordered_json(nullptr);
}

inline nlohmann::ordered_json interval_json(const Interval& interval) {
  return {{"q05", finite_or_null(interval.q05)},
          {"q50", finite_or_null(interval.q50)},
          {"q95", finite_or_null(interval.q95)}};
}

}  // namespace wearwell::prognosis
