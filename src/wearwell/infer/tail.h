#pragma once

#include <vector>

#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/mode.h"

namespace wearwell {

/// The tail of a posterior in one direction of one parameter: its marginal density behaves like
/// |x|^-index for large |x|, or like (distance to the bound)^-index at a bound. It is measured by a
/// walk outward along the ridge (the other parameters at their conditional mode, integrated out by
/// Laplace's approximation). The only assumption about the model is that the likelihood has no pole
/// inside its natural support. At a bound inside that support the tail is that of the prior and is
/// not measured. If every prior is proper and the likelihood does not increase along the walk, the
/// tail is no heavier than the prior's; the same holds at a bound where the likelihood has a limit.
/// At a bound with an infinite prior integral the walk continues after the density has nearly
/// vanished, because a likelihood with a limit of e^-1000 of its maximum still makes the integral
/// infinite.
struct Tail {
  int parameter = 0;
  bool upward = true;  ///< towards larger values
  bool towards_bound = false;
  double index = 0;   ///< infinity for a tail that decreases faster than any power
  bool known = true;  ///< false: the ridge was lost before the index could be measured
  /// The highest density on the walk, and its position on the real line; empty without a walk.
  double highest = 0;
  Eigen::VectorXd highest_at = {};
  bool by_prior = false;  ///< no heavier than that of a proper prior

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
