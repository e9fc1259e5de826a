#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "wearwell/fatigue/life_test.h"
#include "wearwell/math/dual.h"
#include "wearwell/prob/standard_law.h"

namespace wearwell::fatigue {

/// The life of items whose fatigue limits differ, under one stress (Pascual and Meeker 1999, eqs. 2
/// to 5): log10 of the limit V has a law of location and scale; given V below log10 S_f, log10 life
/// has a law about (log10(S_f - 10^V) - log10_a)/b with scale sigma; at or above it, life has no
/// end.
template <class T>
struct LimitedLife {
  StandardLaw life, limit;
  T log10_reversed, log10_a, b, sigma;
  T location, scale;  ///< of the limit

  /// log of the joint density of u and what was seen, where 10^V/S_f = 1/(1 + exp(-u)): on the
  /// whole line of u it is smooth and falls off at both ends.
  template <class Seen>
  T log_integrand(double u, const Seen& seen) const {
    using std::log;
    const double per_decade = 1 / std::log(10.0);
    // log of the share and of what remains of it, without cancellation.
    const double log_share = -(u > 0 ? std::log1p(std::exp(-u)) : std::log1p(std::exp(u)) - u);
    const double log_rest = log_share - u;
    const T w = (log10_reversed + per_decade * log_share - location) / scale;
    const T center = (log10_reversed + per_decade * log_rest - log10_a) / b;
    return log_density(limit, w) - log(scale) + seen(center) +
           (log_rest - std::log(std::log(10.0)));
  }
};

/// Nodes and weights for the integral of exp(log_f) over the real line, `log_f` smooth and falling
/// at least like -|u| far out; `marks` are (where, how wide) of the features to expect. Adaptive
/// Gauss-Kronrod, to about 1e-12 of the integral. Written to `nodes` (u, weight), without those
/// that add nothing.
void place_nodes(const std::function<double(double u)>& log_f,
                 const std::vector<std::pair<double, double>>& marks,
                 std::vector<std::pair<double, double>>& nodes);

/// log of the density of log10 life at `at` (failure), or of the probability that life is beyond it
/// (runout), below it (left) or between `at` and `until` (interval).
template <class T>
T log_probability(const LimitedLife<T>& item, Outcome outcome, double at, double until) {
  using std::exp;
  using std::log;
  const auto seen_by = [=](const auto& life) {
    return [=](const auto& center) {
      const auto z = (at - center) / life.sigma;
      using Scalar = std::decay_t<decltype(z)>;
      switch (outcome) {
        case Outcome::runout:
          return Scalar(log_survival(life.life, z));
        case Outcome::left:
          return Scalar(log_cdf(life.life, z));
        case Outcome::interval: {
          const Scalar end = (until - center) / life.sigma;
          return Scalar(log_between(life.life, z, end));
        }
        case Outcome::failure:
          break;
      }
      return Scalar(log_density(life.life, z) - log(life.sigma));
    };
  };

  const LimitedLife<double> plain{
      item.life,      item.limit,         scalar(item.log10_reversed), scalar(item.log10_a),
      scalar(item.b), scalar(item.sigma), scalar(item.location),       scalar(item.scale)};
  const double decade = std::log(10.0);
  thread_local std::vector<std::pair<double, double>> marks, nodes;
  marks.assign(1, {0.0, 1.0});
  // Where the limit is the usual one, and where the life seen is.
  const double log_share = decade * (plain.location - plain.log10_reversed);
  if (log_share < -1e-12) {
    const double rest = -std::expm1(log_share);
    marks.emplace_back(log_share - std::log(rest), plain.scale * decade / rest);
  }
  for (const double y : {at, outcome == Outcome::interval ? until : at}) {
    const double log_rest = decade * (plain.b * y + plain.log10_a - plain.log10_reversed);
    if (log_rest < -1e-12) {
      const double share = -std::expm1(log_rest);
      marks.emplace_back(std::log(share) - log_rest,
                         plain.sigma * std::abs(plain.b) * decade / share);
    }
  }
  const auto seen = seen_by(plain);
  place_nodes([&](double u) { return plain.log_integrand(u, seen); }, marks, nodes);

  const auto seen_dual = seen_by(item);
  double highest = -std::numeric_limits<double>::infinity();
  T sum(0);
  for (const auto& [u, weight] : nodes) {
    const T g = item.log_integrand(u, seen_dual);
    if (scalar(g) > highest) {
      sum = sum * std::exp(highest - scalar(g));
      highest = scalar(g);
    }
    sum += weight * exp(g - highest);
  }
  T value = log(sum) + highest;
  if (outcome == Outcome::runout) {
    // Those whose limit the stress does not reach.
    const T safe = log_survival(item.limit, T((item.log10_reversed - item.location) / item.scale));
    const T& larger = value > safe ? value : safe;
    const T& smaller = value > safe ? safe : value;
    value = larger + log(1.0 + exp(smaller - larger));
  }
  return value;
}

}  // namespace wearwell::fatigue
