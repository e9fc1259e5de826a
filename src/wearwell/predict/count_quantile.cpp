#include "wearwell/predict/count_quantile.h"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>

#include "wearwell/math/boost_policy.h"

namespace wearwell {
namespace {

// Numbers beyond this many standard deviations have no weight.
constexpr double reach_in_sd = 10;
// A longer range of numbers is not summed but searched.
constexpr double most_summed = 1e6;

// Trials and probability of the binomial distribution; no trials: Poisson.
struct CountForm {
  double trials = 0, probability = 0;
};
CountForm count_form(const CountAtPoint& at) {
  constexpr double poisson = 1e-9;
  const double probability = std::min(1.0, 1 - at.variance / at.mean);
  if (!(probability > poisson)) return {};
  return {at.mean / probability, probability};
}

double count_cdf(const CountAtPoint& at, double count) {
  if (count < 0) return 0;
  if (!(at.mean > 0)) return 1;
  const CountForm form = count_form(at);
  if (form.trials == 0) return boost::math::gamma_q(count + 1, at.mean, Quiet());
  if (count >= form.trials) return 1;
  return form.probability < 1
             ? boost::math::ibeta(form.trials - count, count + 1, 1 - form.probability, Quiet())
             : 0;
}

double log_count_density(const CountAtPoint& at, const CountForm& form, double count) {
  const auto log_gamma = [](double x) { return boost::math::lgamma(x, Quiet()); };
  if (form.trials == 0) return count * std::log(at.mean) - at.mean - log_gamma(count + 1);
  return log_gamma(form.trials + 1) - log_gamma(count + 1) - log_gamma(form.trials - count + 1) +
         count * std::log(form.probability) + (form.trials - count) * std::log1p(-form.probability);
}

struct CountRange {
  double low = 0, high = 0;
};
CountRange range_of(const CountAtPoint& at) {
  const double half = reach_in_sd * (std::sqrt(std::max(at.variance, 0.0)) + 1);
  const CountForm form = at.mean > 0 ? count_form(at) : CountForm();
  const double high = std::ceil(at.mean + half);
  return {std::max(0.0, std::floor(at.mean - half)),
          form.trials > 0 ? std::min(high, std::floor(form.trials + 1e-9)) : high};
}

// Adds the densities of one point, from its middle to both sides, with the sum of its weight.
void add_count(const CountAtPoint& at, double first, std::vector<double>& density,
               std::vector<double>& own) {
  const CountRange range = range_of(at);
  const auto index = [&](double count) { return static_cast<std::size_t>(count - first); };
  if (!(at.mean > 0) || at.variance <= 0) {
    density[index(std::clamp(std::round(at.mean), range.low, range.high))] += at.weight;
    return;
  }
  const CountForm form = count_form(at);
  const double odds = form.probability / (1 - form.probability);
  // p(k + 1)/p(k)
  const auto ratio = [&](double k) {
    return form.trials == 0 ? at.mean / (k + 1) : std::max(0.0, form.trials - k) / (k + 1) * odds;
  };
  const double middle = std::clamp(std::floor(at.mean), range.low, range.high);
  own.assign(static_cast<std::size_t>(range.high - range.low) + 1, 0);
  const auto of = [&](double count) -> double& {
    return own[static_cast<std::size_t>(count - range.low)];
  };
  of(middle) = std::exp(log_count_density(at, form, middle));
  for (double k = middle; k < range.high; ++k) of(k + 1) = of(k) * ratio(k);
  for (double k = middle; k > range.low; --k) of(k - 1) = of(k) / ratio(k - 1);
  double sum = 0;
  for (const double each : own) sum += each;
  for (std::size_t i = 0; i < own.size(); ++i)
    density[index(range.low) + i] += at.weight * own[i] / sum;
}

double searched_quantile(std::span<const CountAtPoint> points, double p, double high) {
  const auto cdf = [&](double count) {
    double sum = 0;
    for (const CountAtPoint& each : points) sum += each.weight * count_cdf(each, count);
    return sum;
  };
  double low = -1;
  while (high - low > 1) {
    const double middle = std::floor(0.5 * (low + high));
    (cdf(middle) < p ? low : high) = middle;
  }
  return high;
}

}  // namespace

std::vector<double> count_quantiles(std::span<const CountAtPoint> points,
                                    std::span<const double> probabilities) {
  double low = INFINITY, high = 0, mass = 0;
  for (const CountAtPoint& each : points) {
    if (!(each.weight > 0)) continue;
    if (!std::isfinite(each.mean)) return std::vector<double>(probabilities.size(), std::nan(""));
    const CountRange range = range_of(each);
    low = std::min(low, range.low);
    high = std::max(high, range.high);
    mass += each.weight;
  }
  if (!(mass > 0)) return std::vector<double>(probabilities.size(), std::nan(""));
  std::vector<double> found;
  if (high - low > most_summed) {
    for (const double p : probabilities) found.push_back(searched_quantile(points, p * mass, high));
    return found;
  }
  std::vector<double> density(static_cast<std::size_t>(high - low) + 1), own;
  for (const CountAtPoint& each : points)
    if (each.weight > 0) add_count(each, low, density, own);
  for (const double p : probabilities) {
    // A sum that only rounding keeps below p has reached it.
    constexpr double rounding = 1e-12;
    double sum = 0;
    std::size_t k = 0;
    while (k + 1 < density.size() && (sum += density[k]) < p * mass * (1 - rounding)) ++k;
    found.push_back(low + static_cast<double>(k));
  }
  return found;
}

}  // namespace wearwell
