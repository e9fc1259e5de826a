// Whether the lives of a clutch study are usable.
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
      names.push_back(fmt::format("{} {:.4g}, calibrated from {:.4g} to {:.4g} {}", input.name, at,
                                  low, high,
                                  speed     ? "rpm"
                                  : celsius ? "degC"
                                            : input.si));
    }
    if (names.empty()) continue;
    findings.add(
        farthest > farthest_outside ? Verdict::fail : Verdict::warn,
        fmt::format("the life '{}' lies outside the calibrated range by {:.2g} of its width: {}",
                    each.name, farthest, fmt::join(names, ", ")),
        "The map is a polynomial and unreliable outside its fitted points. Run points there, or "
        "request lives inside the range.");
  }
  return findings.result("every operating point of a life lies in the calibrated range");
}

Check sense_check(const std::vector<NamedLife>& lives) {
  Findings findings("sense");
  double widest = 0;
  for (const NamedLife& each : lives) {
    double relative = 0;
    for (const LifeAtLevel& at : each.life.levels) relative = std::max(relative, at.full_relative);
    widest = std::max(widest, relative);
    if (!(relative > half_the_volume)) continue;
    findings.add(relative > 1 ? Verdict::fail : Verdict::warn,
                 fmt::format("the volume of '{}' has an uncertainty of +- {:.3g} %", each.name,
                             100 * relative),
                 "This interval is too wide to be informative: do not use this life.");
  }
  return findings.result(
      fmt::format("every volume has an uncertainty of +- {:.3g} % or better", 100 * widest));
}

}  // namespace wearwell::clutch
