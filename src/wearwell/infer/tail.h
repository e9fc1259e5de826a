#pragma once

#include <vector>

#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/mode.h"

namespace wearwell {

/// How a posterior ends in one direction of one parameter: its marginal density falls like
/// |x|^-index far out, or like (distance to the bound)^-index towards a bound. Found by walking
/// outward along the ridge (the other parameters at their conditional mode) and integrating them
/// out by Laplace's approximation; nothing is assumed about the model but that a likelihood has no
/// pole inside its natural support. Towards a bound inside that support the tail is the prior's, and
/// nothing is measured. Where every prior is proper and the likelihood does not grow along the walk,
/// the tail is no heavier than the prior's; nor is it towards a bound where the likelihood tends to a limit. Towards a bound
/// at which a prior has no finite integral the walk goes on where the density has all but vanished: a likelihood that ends at e^-1000 of
/// its highest makes the integral as infinite as any other.
struct Tail {
  int parameter = 0;
  bool upward = true;  ///< towards larger values
  bool towards_bound = false;
  double index = 0;   ///< infinity for a tail that falls faster than any power
  bool known = true;  ///< false: the ridge was lost before the index could be measured
  /// The highest density met on the way, and where on the real line; empty when there was no way.
  double highest = 0;
  Eigen::VectorXd highest_at = {};
  bool by_prior = false;  ///< no heavier than that of a proper prior, however slowly that falls

  /// The posterior has a finite integral in this direction.
  bool integrable() const;
  /// The moment of this order (1: mean, 2: variance) exists in this direction.
  bool has_moment(int order) const;
};

/// All tails, two a parameter, in the order of the parameters: towards smaller values, then larger. `mode` is the posterior's.
std::vector<Tail> tails(const Posterior& posterior, const Mode& mode);

/// Whether the posterior has a finite integral in the direction of every tail.
bool all_integrable(const std::vector<Tail>& tails);

}  // namespace wearwell
