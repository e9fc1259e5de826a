#include "wearwell/plan/demonstration.h"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>

#include "wearwell/math/root.h"

namespace wearwell::plan {
namespace {

// A risk this little above the limit is that of rounding: ln(1 - C)/ln R may be a whole number.
constexpr double risk_rounding = 1e-12;

bool reaches_confidence(double demonstrated, double confidence) {
  return 1 - demonstrated <= (1 - confidence) * (1 + risk_rounding);
}

// chi-square(probability; 2 degrees) / 2
double half_chi_square(std::size_t half_degrees, double probability) {
  return boost::math::gamma_p_inv(static_cast<double>(half_degrees), probability);
}

// (life / life of the limit)^shape, where `failing` fails by `life`, in exposure per unit of hazard
double hazard_at_one(double shape, double failing, double life) {
  return -std::log1p(-failing) / std::pow(life, shape);
}

}  // namespace

double failing_by(StandardDistribution distribution, double scale, double failing, double time) {
  return cdf(distribution, quantile(distribution, failing) + std::log(time) / scale);
}

double at_most_failing(std::size_t n, std::size_t allowed, double p) {
  if (allowed >= n || p <= 0) return 1;
  if (p >= 1) return 0;
  return boost::math::ibetac(static_cast<double>(allowed) + 1, static_cast<double>(n - allowed), p);
}

double pass_probability(const DemonstrationTest& test, const Scatter& scatter, double failing,
                        double life) {
  if (scatter.scales.empty()) return at_most_failing(test.specimens, test.allowed, failing);
  double sum = 0;
  for (const auto& [scale, weight] : scatter.scales)
    sum += weight *
           at_most_failing(test.specimens, test.allowed,
                           failing_by(scatter.distribution, scale, failing, test.time / life));
  return sum;
}

double demonstrated_confidence(const DemonstrationTest& test, const Scatter& scatter,
                               double failing) {
  return 1 - pass_probability(test, scatter, failing);
}

std::optional<std::size_t> least_specimens(std::size_t allowed, double time, const Scatter& scatter,
                                           double failing, double confidence) {
  constexpr std::size_t most = 10'000'000;
  const auto enough = [&](std::size_t n) {
    return reaches_confidence(demonstrated_confidence({n, allowed, time}, scatter, failing),
                              confidence);
  };
  std::size_t low = allowed, high = allowed + 1;
  while (!enough(high)) {
    if (high >= most) return std::nullopt;
    low = high;
    high = std::min(most, 2 * high);
  }
  while (high - low > 1) {
    const std::size_t middle = low + (high - low) / 2;
    (enough(middle) ? high : low) = middle;
  }
  return high;
}

std::optional<double> least_time(std::size_t specimens, std::size_t allowed, const Scatter& scatter,
                                 double failing, double confidence) {
  if (scatter.scales.empty() || specimens <= allowed) return std::nullopt;
  constexpr double widest = 27.6;  // log of 10^12
  const double log_time = solve_increasing(
      [&](double x) {
        return std::log1p(-confidence) -
               std::log(std::max(
                   pass_probability({specimens, allowed, std::exp(x)}, scatter, failing), 1e-300));
      },
      0, 0.5, {1e-12, 1e-12}, -widest, widest);
  if (std::abs(log_time) >= widest || std::isnan(log_time)) return std::nullopt;
  return std::exp(log_time);
}

double required_exposure(std::size_t allowed, double failing, double confidence) {
  return half_chi_square(allowed + 1, confidence) / -std::log1p(-failing);
}

double posterior_after_success(std::size_t specimens, double time, const Scatter& scatter,
                               double failing) {
  // Given the shape the hazard up to 1 is exponential with rate n time^shape; its integral over the
  // flat prior weights the shape.
  double reached = 0, all = 0;
  for (const auto& [scale, weight] : scatter.scales) {
    const double exposure = static_cast<double>(specimens) * std::pow(time, 1 / scale);
    all += weight / exposure;
    reached += weight / exposure * -std::expm1(exposure * std::log1p(-failing));
  }
  return reached / all;
}

SuddenDeathTest sudden_death_test(std::size_t groups, std::size_t size, double shape,
                                  double failing, double confidence) {
  SuddenDeathTest test;
  test.groups = groups;
  test.size = size;
  test.exposure = half_chi_square(groups, confidence) / -std::log1p(-failing);
  test.earliest = std::pow(test.exposure / static_cast<double>(groups * size), 1 / shape);
  test.first_failure_share = -std::expm1(std::log(0.5) / static_cast<double>(size));
  return test;
}

double pass_probability(const SuddenDeathTest& test, double shape, double failing, double life) {
  return boost::math::gamma_q(static_cast<double>(test.groups),
                              test.exposure * hazard_at_one(shape, failing, life));
}

double median_first_failure(std::size_t size, double shape, double failing, double life) {
  return std::pow(std::log(2) / static_cast<double>(size) / hazard_at_one(shape, failing, life),
                  1 / shape);
}

}  // namespace wearwell::plan
