#pragma once

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <span>

#include "wearwell/math/boost_policy.h"
#include "wearwell/models/formula_model/formula_first_passage.h"

namespace wearwell::formula_model {

inline constexpr std::size_t points_of_node =
    4;  ///< of the distribution of a first passage, or of a forecast

inline double normal_quantile(double p) {
  return -std::sqrt(2.0) * boost::math::erfc_inv(2 * p, Quiet());
}

/// The fractional parts of multiples of an irrational number are evenly distributed.
inline double fraction(std::size_t i, double of) {
  const double x = (static_cast<double>(i) + 0.5) * of;
  return x - std::floor(x);
}

/// On the logarithms of neighbours in a ScoreTable, by the cubic through four of them.
inline double at_score(const double* values, double score) {
  constexpr double last = ScoreTable::edges - 1;
  const double x =
      std::clamp((score - ScoreTable::first_score) / ScoreTable::score_step, 0.0, last);
  const auto i = static_cast<std::size_t>(std::clamp(std::floor(x), 1.0, last - 2));
  const double t = x - static_cast<double>(i);
  const double weight[] = {-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2,
                           -(t + 1) * t * (t - 2) / 2, (t + 1) * t * (t - 1) / 6};
  double sum = 0;
  for (std::size_t j = 0; j < 4; ++j) sum += weight[j] * std::log(values[i + j - 1]);
  return std::exp(sum);
}

inline constexpr std::size_t parts = 4;     ///< of a node's position on its line
inline constexpr double negligible = 1e-8;  ///< smaller nodes are left out

/// Refines the nodes of a line by interpolation: parabolas through each node and its neighbours, of
/// the logarithm of the weight and of the value. The sum of the weights is that of the trapezoidal
/// rule with the finer step.
class DrawnLines {
 public:
  static constexpr std::size_t most = 128;  ///< nodes
  /// Whole lines of this number of nodes. `weight` must outlive it.
  DrawnLines(std::span<const double> weight, std::size_t line);

  /// For one value per node: calls back with the node, a share of its weight and the value there.
  template <class Put>
  void put(std::span<const double> number, const Put& put) const {
    for (std::size_t k = 0; k < weight_.size(); ++k) {
      if (!(weight_[k] > negligible)) continue;
      if (!inner_[k] || !std::isfinite(number[k - 1] + number[k] + number[k + 1])) {
        put(k, weight_[k], number[k]);
        continue;
      }
      const double below = number[k - 1] - number[k], above = number[k + 1] - number[k];
      for (std::size_t part = 0; part < parts; ++part) {
        const double t = (static_cast<double>(part) + 0.5) / parts - 0.5;
        put(k, share_[k][part], number[k] + 0.5 * t * ((above - below) + t * (above + below)));
      }
    }
  }

 private:
  std::span<const double> weight_;
  bool inner_[most];
  double share_[most][parts];
};

}  // namespace wearwell::formula_model
