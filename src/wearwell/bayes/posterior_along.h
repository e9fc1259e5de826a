#pragma once

#include <array>
#include <functional>
#include <span>

#include "wearwell/bayes/posterior.h"

namespace wearwell {

/// A posterior along one coordinate of the real line, the others fixed: what these alone decide is worked out once.
/// `posterior` must live on.
class PosteriorAlong {
 public:
  PosteriorAlong(const Posterior& posterior, std::span<const double> z, std::size_t axis);

  /// Posterior::value where the coordinate is z.
  double value(double z);
  /// Natural parameters of the point whose value was asked for last.
  std::span<const double> natural() const { return {x_.data(), dimension_}; }

 private:
  const Posterior& posterior_;
  std::size_t axis_, dimension_;
  bool possible_ = true;  // the others lie in their support
  double before_ = 0;     // log density and log Jacobian of the parameters before the axis
  std::array<double, max_dimension> x_, behind_;
  std::function<double(double)> likelihood_;
};

}  // namespace wearwell
