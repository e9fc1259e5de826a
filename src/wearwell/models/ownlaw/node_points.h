#pragma once

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <span>

namespace wearwell::ownlaw {

inline constexpr std::size_t points_of_node =
    4;  ///< of the law of a first passage, or of a path ahead

inline double normal_quantile(double p) {
  return -std::sqrt(2.0) * boost::math::erfc_inv(2 * p);
}

/// The fractions of multiples of an irrational number lie evenly.
inline double fraction(std::size_t i, double of) {
  const double x = (static_cast<double>(i) + 0.5) * of;
  return x - std::floor(x);
}

/// On the logarithms of neighbours in a table of normal scores -4, -3.6 .. 4, by the cubic through four of them.
inline double at_score(const double* values, double score) {
  const double x = std::clamp((score + 4) / 0.4, 0.0, 20.0);
  const auto i = static_cast<std::size_t>(std::clamp(std::floor(x), 1.0, 18.0));
  const double t = x - static_cast<double>(i);
  const double weight[] = {-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2,
                           -(t + 1) * t * (t - 2) / 2, (t + 1) * t * (t - 1) / 6};
  double sum = 0;
  for (std::size_t j = 0; j < 4; ++j) sum += weight[j] * std::log(values[i + j - 1]);
  return std::exp(sum);
}

inline constexpr int parts = 4;             ///< of a node's place on its line
inline constexpr double negligible = 1e-8;  ///< nodes with less are left out

/// What nodes of one line have, drawn out between them: a parabola through each and its neighbours, of the logarithm
/// of the weight and of the number. The sum of the weights is that of the trapezoidal rule with a step so much finer.
template <class Put>
void draw_out(std::span<const double> weight, std::span<const double> number, const Put& put) {
  const std::size_t n = weight.size();
  for (std::size_t k = 0; k < n; ++k) {
    if (!(weight[k] > negligible)) continue;
    const bool inner = k > 0 && k + 1 < n && weight[k - 1] > 0 && weight[k + 1] > 0 &&
                       std::isfinite(number[k - 1] + number[k] + number[k + 1]);
    if (!inner) {
      put(weight[k], number[k]);
      continue;
    }
    const double before = std::log(weight[k - 1] / weight[k]);
    const double behind = std::log(weight[k + 1] / weight[k]);
    const double below = number[k - 1] - number[k], above = number[k + 1] - number[k];
    for (int part = 0; part < parts; ++part) {
      const double t = (part + 0.5) / parts - 0.5;
      const double bend = 0.5 * t * t, slope = 0.5 * t;
      put(weight[k] / parts * std::exp(slope * (behind - before) + bend * (behind + before)),
          number[k] + slope * (above - below) + bend * (above + below));
    }
  }
}

}  // namespace wearwell::ownlaw
