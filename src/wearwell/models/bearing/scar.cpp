#include "wearwell/models/bearing/scar.h"

#include <fmt/format.h>

#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/physics/circle_area.h"

namespace wearwell::bearing {

Scar scar(double sigma, double delta) {
  const Lune l = lune(sigma, delta);
  return {.width = 2 * l.half_chord, .centre_angle = 2 * l.alpha};
}

double widest_depth(double sigma) {
  // The positive root of cos(alpha) = 0, delta^2 + 2 sigma delta - 2 sigma = 0.
  return 2 * sigma / (sigma + std::sqrt(sigma * (sigma + 2)));
}

ScarDepth depth_from_scar(double sigma, double width) {
  if (!(width > 0 && width < 2)) {
    throw InputError(fmt::format(
        "scar width/radius is {}; it must be above 0 and below 2, the journal's diameter", width));
  }
  // cos(alpha) and R cos(beta), and the sagittas 1 - cos(alpha) and R - R cos(beta), written so
  // that their difference has no subtraction.
  const double c = width / 2;
  const double radius = 1 + sigma;
  const double pin = std::sqrt((1 - c) * (1 + c));
  const double bushing = std::sqrt((radius - c) * (radius + c));
  const double difference = sigma * (2 + sigma) / (bushing + pin);  // bushing - pin
  ScarDepth result;
  result.delta = c * c * (sigma + difference) / ((1 + pin) * (radius + bushing));
  result.amplification = c * c * difference / (pin * bushing * result.delta);
  result.clearance_power = sigma * c * c / (bushing * (radius + bushing) * result.delta);
  return result;
}

}  // namespace wearwell::bearing
