#include "wearwell/models/fatigue/sn_guess.h"

#include <algorithm>
#include <cmath>

namespace wearwell::fatigue {

SnGuess guess(const SnLaw& law, const LifeTests& tests, double strength) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0;
  for (const LifeTest& test : tests) {
    const double x = std::log10(test.stress.alternating) +
                     log10_factor(law.correction, test.stress, strength, 0.5);
    const double y = std::log10(test.life), w = test.count;
    n += w;
    sx += w * x;
    sy += w * y;
    sxx += w * x * x;
    sxy += w * x * y;
    syy += w * y * y;
  }
  const double mx = sx / n, my = sy / n, vx = sxx / n - mx * mx, vy = syy / n - my * my;
  const double slope = vx > 0 ? (sxy / n - mx * my) / vx : 0;
  SnGuess result;
  // An implausible slope only means that the tests are few.
  if (slope < -2 && slope > -50) result.b = 1 / slope;
  result.log10_a = mx - result.b * my;
  const double rest = vy - 2 * (sxy / n - mx * my) / result.b + vx / (result.b * result.b);
  result.sigma = std::clamp(std::sqrt(std::max(rest, 0.0)), 0.05, 2.0);
  if (!law.logarithmic()) result.sigma *= std::log(10.0) * std::pow(10, my);
  return result;
}

}  // namespace wearwell::fatigue
