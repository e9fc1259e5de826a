#include "wearwell/models/recurrence/exact_bounds.h"

#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <limits>

#include "wearwell/math/root.h"

namespace wearwell::recurrence {
namespace {

constexpr Closeness close_logarithm{.absolute = 1e-12, .relative = 0};

// P(N <= n) with P(N = j) proportional to y^j/(j! (j-1)!), j = 1, 2, ...
double share_up_to(std::size_t n, double log_y) {
  constexpr double negligible = -50;
  const auto term = [&](std::size_t j) {
    const auto x = static_cast<double>(j);
    return x * log_y - std::lgamma(x + 1) - std::lgamma(x);
  };
  const auto peak = static_cast<std::size_t>(std::max(1.0, std::exp(0.5 * log_y)));
  const double most = term(peak);
  double below = 0, all = 0;
  for (std::size_t j = peak; j >= 1; --j) {
    const double each = term(j) - most;
    if (each < negligible) break;
    all += std::exp(each);
    if (j <= n) below += std::exp(each);
  }
  for (std::size_t j = peak + 1;; ++j) {
    const double each = term(j) - most;
    if (each < negligible) break;
    all += std::exp(each);
    if (j <= n) below += std::exp(each);
  }
  return below / all;
}

// y = end sum ln(end/age) units/MTBF at which P(N <= n) = p, on the logarithmic scale.
double log_rate(std::size_t n, double p) {
  const double guess = 2 * std::log(static_cast<double>(n));
  return solve_increasing([&](double log_y) { return p - share_up_to(n, log_y); }, guess, 1,
                          close_logarithm);
}

// P(Z U <= exp(log_c)) of independent gamma variables with the shapes n - 1 and n.
double product_below(double n, double log_c) {
  constexpr double tail = 1e-14, tolerance = 1e-11;
  constexpr unsigned depth = 10, points = 61;
  const double from = std::log(boost::math::gamma_p_inv(n - 1, tail)),
               to = std::log(boost::math::gamma_q_inv(n - 1, tail));
  const auto density = [&](double w) {
    return std::exp((n - 1) * w - std::exp(w) - std::lgamma(n - 1)) *
           boost::math::gamma_p(n, std::exp(log_c - w));
  };
  return boost::math::quadrature::gauss_kronrod<double, points>::integrate(density, from, to, depth,
                                                                           tolerance);
}

double log_product(double n, double p) {
  return solve_increasing([&](double log_c) { return product_below(n, log_c) - p; },
                          std::log(n * (n - 1)), 1, close_logarithm);
}

double half_chi_square(double half_degrees, double p) {
  return boost::math::gamma_p_inv(half_degrees, p);
}

}  // namespace

std::optional<double> PowerLawSample::unbiased_beta() const {
  if (random < 2 || !(logs > 0)) return {};
  return (static_cast<double>(random) - 1) / logs;
}

std::optional<PowerLawSample> power_law_sample(const std::vector<UnitHistory>& units) {
  PowerLawSample sample;
  sample.units = units.size();
  sample.end = units.front().end;
  for (const UnitHistory& unit : units) {
    if (unit.start > 0) return {};
    if (unit.end != sample.end) sample.end = std::numeric_limits<double>::quiet_NaN();
    sample.failures += unit.failures.size();
    // Ages of grouped failures are not known.
    const std::size_t random =
        unit.grouped ? 0 : unit.failures.size() - (unit.ends_at_failure ? 1 : 0);
    for (std::size_t i = 0; i < random; ++i) sample.logs += std::log(unit.end / unit.failures[i]);
    sample.random += random;
    sample.time_ended = sample.time_ended && !unit.ends_at_failure;
  }
  sample.failure_ended = units.size() == 1 && units.front().ends_at_failure;
  return sample;
}

std::optional<Interval> exact_beta(const PowerLawSample& sample, double outside) {
  if (sample.random == 0 || !(sample.logs > 0)) return {};
  const auto half_degrees = static_cast<double>(sample.random);
  return Interval{half_chi_square(half_degrees, outside) / sample.logs,
                  half_chi_square(half_degrees, 1 - outside) / sample.logs};
}

std::optional<Interval> exact_mtbf(const PowerLawSample& sample, double outside) {
  if (!std::isfinite(sample.end) || !(sample.logs > 0)) return {};
  const std::size_t n = sample.failures;
  const double scale = sample.end * sample.logs;
  if (sample.failure_ended) {
    if (n < 2) return {};
    const auto of = [&](double p) {
      return scale / std::exp(log_product(static_cast<double>(n), p));
    };
    return Interval{of(1 - outside), of(outside)};
  }
  if (!sample.time_ended) return {};
  const double all = scale * static_cast<double>(sample.units);
  const double upper = n < 2 ? std::numeric_limits<double>::infinity()
                             : all / std::exp(log_rate(n - 1, 1 - outside));
  return Interval{all / std::exp(log_rate(n, outside)), upper};
}

Interval exact_constant_mtbf(std::size_t failures, double time, bool failure_ended,
                             double outside) {
  const auto n = static_cast<double>(failures);
  Interval interval{time / half_chi_square(failure_ended ? n : n + 1, 1 - outside),
                    std::numeric_limits<double>::infinity()};
  if (failures > 0) interval.upper = time / half_chi_square(n, outside);
  return interval;
}

std::optional<Interval> exact_age_per_failure(const PowerLawSample& sample, double outside) {
  if (!std::isfinite(sample.end) || !(sample.time_ended || sample.failure_ended)) return {};
  return exact_constant_mtbf(sample.failures, static_cast<double>(sample.units) * sample.end,
                             !sample.time_ended, outside);
}

std::optional<Interval> exact_phase(const Process& process, const std::vector<UnitHistory>& units,
                                    std::size_t phase, double outside) {
  std::size_t failures = 0, observed = 0, at_failure = 0;
  double time = 0;
  for (const UnitHistory& unit : units) {
    const double own =
        process.time_in_phase(phase, unit.end) - process.time_in_phase(phase, unit.start);
    for (const double age : unit.failures) failures += process.phase_at(age) == phase ? 1 : 0;
    time += own;
    observed += own > 0 ? 1 : 0;
    at_failure += own > 0 && unit.ends_at_failure && process.phase_at(unit.end) == phase ? 1 : 0;
  }
  if (at_failure > 0 && at_failure < observed) return {};
  return exact_constant_mtbf(failures, time, at_failure > 0, outside);
}

}  // namespace wearwell::recurrence
