#pragma once

#include <array>
#include <functional>
#include <span>

#include "wearwell/bayes/posterior.h"

namespace wearwell {

/// A posterior as a function of one unconstrained coordinate, with the others fixed and their part
/// precomputed. `posterior` must outlive it.
class PosteriorAlong {
 public:
  PosteriorAlong(const Posterior& posterior, std::span<const double> z, std::size_t axis);

  /// Posterior::value at coordinate z.
  double value(double z);
  /// Natural parameters of the last evaluated point.
  std::span<const double> natural() const { return {x_.data(), dimension_}; }

 private:
  const Posterior& posterior_;
  std::size_t axis_, dimension_;
  bool possible_ = true;  // the others are inside their support
  double before_ = 0;     // log density and log Jacobian of the parameters before the axis
  std::array<double, max_dimension> x_, behind_;
  std::function<double(double)> likelihood_;
};

}  // namespace wearwell
