#pragma once

#include <vector>

#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/mode.h"

namespace wearwell {

/// How a posterior ends in one direction of one parameter: its marginal density falls like
/// |x|^-index far out, or like (distance to the bound)^-index towards a bound. Found by walking
/// outward along the ridge (the other parameters at their conditional mode) and integrating them
/// out by Laplace's approximation; nothing is assumed about the model.
struct Tail {
  int parameter = 0;
  bool upward = true;  ///< towards larger values
  bool towards_bound = false;
  double index = 0;  ///< infinity for a tail that falls faster than any power

  /// The posterior has a finite integral in this direction.
  bool integrable() const;
  /// The moment of this order (1: mean, 2: variance) exists in this direction.
  bool has_moment(int order) const;
};

/// All tails: two a parameter. `mode` is the posterior's.
std::vector<Tail> tails(const Posterior& posterior, const Mode& mode);

}  // namespace wearwell
