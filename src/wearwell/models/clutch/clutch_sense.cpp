// Whether what a clutch study says of lives can be used.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "wearwell/models/clutch/clutch_study.h"

namespace wearwell::clutch {

Check extrapolation_check(const WearModel& model, const std::vector<NamedLife>& lives) {
  Findings findings("extrapolation");
  for (const NamedLife& each : lives) {
    std::vector<std::string> names;
    double farthest = 0;  // in widths of the range
    for (const Input& input : inputs) {
      const bool speed = input.value == &OperatingPoint::slip_speed;
      const bool celsius = input.value == &OperatingPoint::temperature;
      const double unit = speed ? rpm : 1;
      const double low = model.lowest.*input.value / unit, high = model.highest.*input.value / unit,
                   at = each.at.*input.value / unit;
      const double width = high > low ? high - low : std::abs(high);
      const double beyond = std::max({low - at, at - high, 0.0}) / width;
      if (!(beyond > validity_slack)) continue;
      farthest = std::max(farthest, beyond);
      names.push_back(fmt::format("{} {:.4g}, modelled from {:.4g} to {:.4g} {}", input.name, at,
                                  low, high,
                                  speed     ? "rpm"
                                  : celsius ? "degC"
                                            : input.si));
    }
    if (names.empty()) continue;
    findings.add(farthest > farthest_outside ? Verdict::fail : Verdict::warn,
                 fmt::format("the life '{}' lies outside the range of validity by {:.2g} of its "
                             "width: {}",
                             each.name, farthest, fmt::join(names, ", ")),
                 "The map is a polynomial: outside the points it was fitted to it may do anything. "
                 "Run points there, or ask inside.");
  }
  return findings.result(
      "every operating point whose life is asked for lies in the range of the "
      "points modelled with");
}

Check sense_check(const std::vector<NamedLife>& lives) {
  Findings findings("sense");
  double widest = 0;
  for (const NamedLife& each : lives) {
    double relative = 0;
    for (const LifeAtLevel& at : each.life.levels) relative = std::max(relative, at.full_relative);
    widest = std::max(widest, relative);
    if (!(relative > half_the_volume)) continue;
    findings.add(
        relative > 1 ? Verdict::fail : Verdict::warn,
        fmt::format("the volume of '{}' is known to +- {:.3g} % only", each.name, 100 * relative),
        "Such an interval says next to nothing of this life: it is not to be used.");
  }
  return findings.result(
      fmt::format("every volume asked for is known to +- {:.3g} % or better", 100 * widest));
}

}  // namespace wearwell::clutch
