#include "wearwell/models/formula_model/noisy_steps.h"

#include <algorithm>
#include <cmath>

#include "wearwell/math/constants.h"
#include "wearwell/models/formula_model/unit_rule.h"

namespace wearwell::formula_model {

void NoisySteps::Slopes::restart(std::size_t steps) {
  for (auto* each : {&growth, &variance, &noise}) each->assign(steps, 0.0);
}

void NoisySteps::clear(bool scaled) {
  scaled_ = scaled;
  constant_ = 0;
  steps_.clear();
}

void NoisySteps::add(double growth, double variance, double noise, double reading) {
  const double all = variance + noise;
  steps_.push_back({growth, variance, noise, reading, 1 / all});
  constant_ -= 0.5 * (log_two_pi + std::log(all));
}

void NoisySteps::log_densities(const double* q, double* value) const {
  constexpr std::size_t n = together;
  // Variances relative to those at q = 1, multiplied before taking the logarithm.
  constexpr std::size_t factors_of_log = 4;
  double at[n] = {}, variance[n] = {}, squares[n] = {}, logs[n] = {}, product[n];
  std::fill_n(product, n, 1.0);
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const Step step = steps_[i];
    for (std::size_t k = 0; k < n; ++k) {
      const double expected = at[k] + q[k] * step.growth, off = step.reading - expected;
      const double before = variance[k] + (scaled_ ? q[k] : 1) * step.variance;
      const double all = before + step.noise, inverse = 1 / all, gain = before * inverse;
      squares[k] += off * off * inverse;
      product[k] *= all * step.per_all;
      at[k] = expected + gain * off;
      variance[k] = gain * step.noise;
    }
    if ((i + 1) % factors_of_log != 0 && i + 1 < steps_.size()) continue;
    log_all(product, product, n);
    for (std::size_t k = 0; k < n; ++k) logs[k] += product[k];
    std::fill_n(product, n, 1.0);
  }
  for (std::size_t k = 0; k < n; ++k) value[k] = constant_ - 0.5 * (logs[k] + squares[k]);
}

NoisySteps::Place NoisySteps::at(double q) const {
  double at = 0, variance = 0, at_slope = 0, variance_slope = 0;
  Place place{constant_, 0};
  for (const Step& step : steps_) {
    const double off = step.reading - at - q * step.growth, off_slope = -at_slope - step.growth;
    const double before = variance + (scaled_ ? q : 1) * step.variance;
    const double before_slope = variance_slope + (scaled_ ? step.variance : 0);
    const double inverse = 1 / (before + step.noise), gain = before * inverse;
    const double gain_slope = before_slope * step.noise * inverse * inverse;
    place.value -= 0.5 * (std::log((before + step.noise) * step.per_all) + off * off * inverse);
    place.slope -=
        0.5 * before_slope * inverse * (1 - off * off * inverse) + off * off_slope * inverse;
    at += q * step.growth + gain * off;
    at_slope += step.growth + gain_slope * off + gain * off_slope;
    variance = gain * step.noise;
    variance_slope = gain_slope * step.noise;
  }
  return place;
}

NoisySteps::Quadratic NoisySteps::quadratic() const {
  double reading = 0, growth = 0, variance = 0;  // of the path without growth, and of growth alone
  Quadratic sum{constant_};
  for (const Step& step : steps_) {
    const double before = variance + step.variance, inverse = 1 / (before + step.noise);
    const double off = step.reading - reading, away = growth + step.growth, gain = before * inverse;
    sum.constant -= 0.5 * (std::log((before + step.noise) * step.per_all) + off * off * inverse);
    sum.by_one += off * away * inverse;
    sum.by_square -= 0.5 * away * away * inverse;
    reading += gain * off;
    growth = away - gain * away;
    variance = gain * step.noise;
  }
  return sum;
}

void NoisySteps::add_slopes(const double* q, const double* weight, Slopes& slopes,
                            double* by_q) const {
  constexpr std::size_t n = together;
  struct Filtered {
    double off[n], before[n], inverse[n];
  };
  static thread_local std::vector<Filtered> all;
  all.resize(steps_.size());
  double at[n] = {}, variance[n] = {}, factor[n];
  for (std::size_t k = 0; k < n; ++k) factor[k] = scaled_ ? q[k] : 1;
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const Step step = steps_[i];
    Filtered& f = all[i];
    for (std::size_t k = 0; k < n; ++k) {
      const double expected = at[k] + q[k] * step.growth;
      f.off[k] = step.reading - expected;
      f.before[k] = variance[k] + factor[k] * step.variance;
      f.inverse[k] = 1 / (f.before[k] + step.noise);
      const double gain = f.before[k] * f.inverse[k];
      at[k] = expected + gain * f.off[k];
      variance[k] = gain * step.noise;
    }
  }
  double by_at[n] = {}, by_variance[n] = {};  // of the path after the step
  std::fill_n(by_q, n, 0.0);
  for (std::size_t i = steps_.size(); i-- > 0;) {
    const Step step = steps_[i];
    const Filtered& f = all[i];
    double growth[n], spread[n], noise[n];
    for (std::size_t k = 0; k < n; ++k) {
      const double inverse = f.inverse[k], before = f.before[k], off = f.off[k];
      const double by_gain = by_at[k] * off - by_variance[k] * before;
      const double by_off = by_at[k] * before * inverse - off * inverse;
      const double by_all =
          -0.5 * inverse + (0.5 * off * off - by_gain * before) * inverse * inverse;
      by_variance[k] = by_variance[k] * step.noise * inverse + by_gain * inverse + by_all;
      by_at[k] -= by_off;
      by_q[k] += by_at[k] * step.growth + (scaled_ ? by_variance[k] * step.variance : 0);
      growth[k] = weight[k] * q[k] * by_at[k];
      spread[k] = weight[k] * factor[k] * by_variance[k];
      noise[k] = weight[k] * by_all;
    }
    for (std::size_t k = 0; k < n; ++k) {
      slopes.growth[i] += growth[k];
      slopes.variance[i] += spread[k];
      slopes.noise[i] += noise[k];
    }
  }
}

}  // namespace wearwell::formula_model
