#include "wearwell/study/axis_scale.h"

#include <fmt/format.h>

#include "wearwell/present/html.h"

namespace wearwell {

std::string AxisScale::title(const std::string& name) const {
  return unit.empty() ? name : fmt::format("{} [{}]", name, unit);
}

AxisScale scale_for(double typical, const std::string& unit) {
  const std::string shown = html::unit(unit);
  if (typical == 0 || !std::isfinite(typical)) return {1, shown};
  const int exponent = static_cast<int>(std::floor(std::log10(std::abs(typical))));
  if (exponent >= -2 && exponent <= 5) return {1, shown};
  // Beyond this the factor itself overflows a double.
  if (std::abs(exponent) > 300) return {1, shown};
  return {std::pow(10.0, -exponent),
          html::raised(fmt::format("10^{}", exponent)) + (shown.empty() ? "" : "\u00a0" + shown)};
}

AxisScale scale_of(const ParameterSummary& p) {
  return scale_for(p.exact ? p.exact->q50 : p.q50, p.unit);
}

Numbers counted(std::size_t n) {
  Numbers values;
  for (std::size_t i = 1; i <= n; ++i) values.push_back(static_cast<double>(i));
  return values;
}

Numbers within(double low, double high, Numbers values) {
  for (double& value : values) {
    if (!std::isnan(value)) value = std::clamp(value, low, high);
  }
  return values;
}

}  // namespace wearwell
