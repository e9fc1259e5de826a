#include "wearwell/in_service/horizons.h"

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/input/option_value.h"
#include "wearwell/prognosis/quantity_like.h"

namespace wearwell::in_service {

std::vector<double> usual_horizons(const prognosis::PopulationLives& lives, const Unit& axis) {
  const double median = lives.lives.empty() ? 0 : lives.quantile(0.5);
  if (!std::isfinite(median) || !(median > 0))
    throw InputError("--horizon: is needed, since half of the units never fail");
  std::vector<double> horizons;
  for (const double share : {0.1, 0.25, 0.5}) {
    const double x = share * median / axis.scale, digit = std::pow(10, std::floor(std::log10(x)));
    horizons.push_back(std::round(x / digit) * digit * axis.scale);
  }
  return horizons;
}

std::vector<double> read_horizons(const std::vector<std::string>& texts, const Unit& axis) {
  std::vector<double> horizons;
  for (const std::string& each : texts)
    horizons.push_back(prognosis::quantity_like("--horizon", each, axis, Allowed::positive));
  std::sort(horizons.begin(), horizons.end());
  horizons.erase(std::unique(horizons.begin(), horizons.end()), horizons.end());
  return horizons;
}

}  // namespace wearwell::in_service
