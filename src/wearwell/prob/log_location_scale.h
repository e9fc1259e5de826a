#pragma once

#include <array>
#include <string_view>

namespace wearwell {

/// Log-location-scale families by one name: log y = log(scale) + sigma Z, where `standard` names the
/// distribution of Z (Meeker and Escobar 1998, sec. 4.3; their mu is log(scale)). Each is a family of the
/// list, whose `scale` is the same and whose `spread` is sigma, or 1/sigma if `inverse`.
struct LogLocationScale {
  std::string_view standard, family, scale, spread;
  bool inverse;

  static constexpr std::string_view name = "log-location-scale";
};

inline constexpr std::array<LogLocationScale, 4> log_location_scale_families = {
    {{"smallest extreme value", "weibull", "scale", "shape", true},
     {"normal", "lognormal", "median", "log_sd", false},
     {"logistic", "loglogistic", "scale", "shape", true},
     {"largest extreme value", "frechet", "scale", "shape", true}}};

}  // namespace wearwell
