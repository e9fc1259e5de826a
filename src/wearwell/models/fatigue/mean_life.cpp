#include "wearwell/models/fatigue/mean_life.h"

#include <boost/math/special_functions/gamma.hpp>
#include <cmath>

namespace wearwell::fatigue {
namespace {

double above_normal(double z) {
  return 0.5 * std::erfc(z * M_SQRT1_2);
}

}  // namespace

double mean_life(LifeFamily family, double center, double sigma) {
  const double s = sigma * std::log(10.0);
  switch (family) {
    case LifeFamily::log10_normal:
      return std::pow(10, center) * std::exp(0.5 * s * s);
    case LifeFamily::weibull:
      return std::pow(10, center) * std::tgamma(1 + s);
    case LifeFamily::normal:
      break;
  }
  return center;
}

double share_of_mean_beyond(LifeFamily family, double center, double sigma, double life) {
  if (center == infinity) return 1;
  const double s = sigma * std::log(10.0);
  switch (family) {
    case LifeFamily::log10_normal:
      return above_normal((std::log10(life) - center) / sigma - s);
    case LifeFamily::weibull: {
      // (life/eta)^(1/s), which overflows only where nothing is left beyond.
      const double hazard = std::pow(10, (std::log10(life) - center) / s);
      return std::isfinite(hazard) ? boost::math::gamma_q(1 + s, hazard) : 0;
    }
    case LifeFamily::normal:
      break;
  }
  const double z = (life - center) / sigma;
  return above_normal(z) + sigma / center * 0.3989422804014327 * std::exp(-0.5 * z * z);
}

}  // namespace wearwell::fatigue
