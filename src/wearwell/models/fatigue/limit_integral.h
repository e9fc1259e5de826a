#pragma once

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "wearwell/models/fatigue/random_limit.h"

namespace wearwell::fatigue {

inline const double decade = std::log(10.0);
inline const double log_decade = std::log(decade);

/// The likelihood of an observed life given its center: log of a density or probability, with its
/// slopes by the center and by sigma.
struct LifeTerm {
  double value = 0;
  double by_center = 0, by_sigma = 0;
};

class Observed {
 public:
  Observed(const LimitedLife<double>& item, Outcome outcome, double at, double until)
      : item_(item), outcome_(outcome), at_(at), until_(until), log_sigma_(std::log(item.sigma)) {}

  LifeTerm operator()(double center) const {
    const double z = (at_ - center) / item_.sigma;
    switch (outcome_) {
      case Outcome::runout:
        return by(z, log_survival_and_slope(item_.life, z));
      case Outcome::left:
        return by(z, log_cdf_and_slope(item_.life, z));
      case Outcome::interval: {
        const double end = (until_ - center) / item_.sigma;
        const LogBetween y = log_between_and_slopes(item_.life, z, end);
        return {y.value, -(y.slope_a + y.slope_b) / item_.sigma,
                -(y.slope_a * z + y.slope_b * end) / item_.sigma};
      }
      case Outcome::failure:
        break;
    }
    LifeTerm seen = by(z, log_density_and_slope(item_.life, z));
    seen.value -= log_sigma_;
    seen.by_sigma -= 1 / item_.sigma;
    return seen;
  }

 private:
  LifeTerm by(double z, const ValueAndSlope& y) const {
    return {y.value, -y.slope / item_.sigma, -y.slope * z / item_.sigma};
  }

  const LimitedLife<double>& item_;
  Outcome outcome_;
  double at_, until_, log_sigma_;
};

/// The joint density of u and the observation, where 10^V/S_f = 1/(1 + exp(-u)): on the whole line
/// of u it is smooth and vanishes at both ends. The integrals are of it and of its products with
/// the slopes.
constexpr std::size_t integrals = 6;
using Integrals = std::array<double, integrals>;
enum Which : std::size_t { mass, of_w, of_w_w, of_center, of_center_center, of_sigma };

struct Integrand {
  const LimitedLife<double>& item;
  Observed seen;
  double log_scale;

  /// The logarithm; `slopes` are the factors of each of Integrals.
  double operator()(double u, Integrals* slopes = nullptr) const {
    // log of the limit's share of the stress and of the remaining share, without cancellation.
    const double log_share = -(u > 0 ? std::log1p(std::exp(-u)) : std::log1p(std::exp(u)) - u);
    const double log_rest = log_share - u;
    const double w = (item.log10_reversed + log_share / decade - item.location) / item.scale;
    const double center = (item.log10_reversed + log_rest / decade - item.log10_a) / item.b;
    const ValueAndSlope limit = log_density_and_slope(item.limit, w);
    const LifeTerm life = seen(center);
    if (slopes) {
      *slopes = {
          1, limit.slope, limit.slope * w, life.by_center, life.by_center * center, life.by_sigma};
    }
    return limit.value - log_scale + life.value + log_rest - log_decade;
  }
};

/// Integrals over the whole line of u, times exp(-reference). `marks`: positions and widths of the
/// expected features of the integrand.
struct ScaledIntegrals {
  Integrals sums{};
  double reference = 0;
};
ScaledIntegrals integrals_of(const Integrand& log_f,
                             const std::vector<std::pair<double, double>>& marks);

}  // namespace wearwell::fatigue
