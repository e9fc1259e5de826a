#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "wearwell/base/unit.h"

namespace wearwell {

/// The unit in which log densities of the data are reported (log-likelihood, AIC, BIC, elpd,
/// evidence): the unit of the response in the data. A density per unit is `scale` times the density
/// per SI unit; probabilities (of censored observations, of counts) have no unit.
struct DensityUnit {
  std::string text = "SI units";  ///< "km"; for several responses "um, N"; "1" if none has a unit
  std::vector<double> terms =
      {};            ///< added to each factor of the likelihood (LogDensity::pointwise)
  double total = 0;  ///< added to the logarithm of the whole likelihood

  /// The words after a log density in a sentence: "data in km"; empty without a unit.
  static std::string description(const std::string& text) {
    return text.empty() || text == "1" ? "" : "data in " + text;
  }
};

/// For this many observations, each with its own density and factor.
inline DensityUnit density_unit(const Unit& unit, std::size_t observations) {
  const double each = std::log(unit.scale);
  return {unit.text, std::vector<double>(observations, each),
          each * static_cast<double>(observations)};
}

}  // namespace wearwell
