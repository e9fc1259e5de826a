#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "wearwell/study/posterior_summary.h"

namespace wearwell {

using Numbers = std::vector<double>;

/// Axes read best with numbers near 1: a parameter of 7e-4 is plotted in units of 1e-4.
struct AxisScale {
  double factor = 1;
  std::string unit;

  Numbers operator()(Numbers values) const {
    for (double& value : values) value *= factor;
    return values;
  }
  double operator()(double value) const { return value * factor; }
  std::string title(const std::string& name) const;
};

AxisScale scale_for(double typical, const std::string& unit);
AxisScale scale_of(const ParameterSummary& p);

/// 1, 2, ..., n.
Numbers counted(std::size_t n);

/// The range of an axis that a plot shows.
struct AxisWindow {
  double low = INFINITY, high = -INFINITY;
  void take(double a) {
    if (!std::isfinite(a)) return;
    low = std::min(low, a);
    high = std::max(high, a);
  }
  double margin(double share) const { return share * (high - low); }
};

/// Bars of a stage without information end far outside the plot. They are clipped just outside it,
/// because browsers cannot draw to 1e300.
Numbers within(double low, double high, Numbers values);

}  // namespace wearwell
