#include "wearwell/models/fatigue/random_limit.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "wearwell/math/constants.h"
#include "wearwell/models/fatigue/limit_integral.h"
#include "wearwell/models/fatigue/limit_lattice.h"

namespace wearwell::fatigue {
namespace {

/// Failed by then with a limit below the stress, or, for runouts, failed later.
LimitedLifeSlopes integral(const LimitedLife<double>& item, Outcome outcome, double at,
                           double until) {
  thread_local std::vector<std::pair<double, double>> marks;
  marks.assign(1, {0.0, 1.0});
  // The usual limit, and the observed life.
  const double log_share = decade * (item.location - item.log10_reversed);
  if (log_share < -1e-12) {
    const double rest = -std::expm1(log_share);
    marks.emplace_back(log_share - std::log(rest), item.scale * decade / rest);
  }
  const auto mark_life = [&](double y) {
    const double log_rest = decade * (item.b * y + item.log10_a - item.log10_reversed);
    if (!(log_rest < -1e-12)) return;
    const double share = -std::expm1(log_rest);
    marks.emplace_back(std::log(share) - log_rest, item.sigma * std::abs(item.b) * decade / share);
  };
  mark_life(at);
  if (outcome == Outcome::interval) mark_life(until);
  const Integrand log_f{item, {item, outcome, at, until}, std::log(item.scale)};
  const auto [sums, reference] = integrals_of(log_f, marks);

  LimitedLifeSlopes y;
  y.value = std::log(sums[mass]) + reference;
  if (!(sums[mass] > 0)) {
    y.value = -infinity;  // an empty integral has no reference either
    return y;
  }
  const auto mean = [&s = sums](Which which) { return s[which] / s[mass]; };
  y.by_log10_reversed = mean(of_w) / item.scale + mean(of_center) / item.b;
  y.by_log10_a = -mean(of_center) / item.b;
  y.by_b = -mean(of_center_center) / item.b;
  y.by_sigma = mean(of_sigma);
  y.by_location = -mean(of_w) / item.scale;
  y.by_scale = -(mean(of_w_w) + 1) / item.scale;
  return y;
}

void scale_slopes(LimitedLifeSlopes& y, double factor) {
  for (double* slope :
       {&y.by_log10_reversed, &y.by_log10_a, &y.by_b, &y.by_sigma, &y.by_location, &y.by_scale}) {
    *slope *= factor;
  }
}

}  // namespace

LimitedLifeSlopes log_probability_and_slopes(const LimitedLife<double>& item, Outcome outcome,
                                             double at, double until) {
  if (const auto quick = on_lattice(item, outcome, at)) return *quick;
  return adaptive_probability_and_slopes(item, outcome, at, until);
}

LimitedLifeSlopes adaptive_probability_and_slopes(const LimitedLife<double>& item, Outcome outcome,
                                                  double at, double until) {
  if (outcome != Outcome::runout) return integral(item, outcome, at, until);

  // All except those that have failed. This cancels only if nearly all have.
  LimitedLifeSlopes y = integral(item, Outcome::left, at, until);
  const double broken = std::exp(y.value);
  if (broken < 0.9) {
    y.value = std::log1p(-broken);
    scale_slopes(y, -broken / (1 - broken));
    return y;
  }
  y = integral(item, outcome, at, until);

  // Those whose limit is above the stress outlast it as well.
  const double w = (item.log10_reversed - item.location) / item.scale;
  const ValueAndSlope safe = log_survival_and_slope(item.limit, w);
  const double larger = std::max(y.value, safe.value), smaller = std::min(y.value, safe.value);
  if (larger == -infinity) return y;
  const double all = larger + std::log1p(std::exp(smaller - larger));
  scale_slopes(y, std::exp(y.value - all));
  const double spared = std::exp(safe.value - all);
  y.by_log10_reversed += spared * safe.slope / item.scale;
  y.by_location -= spared * safe.slope / item.scale;
  y.by_scale -= spared * safe.slope * w / item.scale;
  y.value = all;
  return y;
}

}  // namespace wearwell::fatigue
