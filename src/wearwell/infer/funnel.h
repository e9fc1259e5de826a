#pragma once

#include <optional>
#include <vector>

#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/mode.h"
#include "wearwell/infer/tail.h"

namespace wearwell {

struct Funnel {
  int scale;    ///< the parameter at whose bound the density is unbounded
  Mode middle;  ///< the middle of the mass, not a mode of the density
};

/// The middle of a posterior with finite mass but without a mode (a funnel): as a scale approaches
/// its bound, the other parameters concentrate on values that reproduce the data (fewer rows than
/// parameters), and the density is unbounded while the mass decreases. The middle is the maximum of
/// the marginal density of that scale (the others integrated out by Laplace's approximation), with
/// the others at their conditional mode. Its curvature is that of a normal distribution with the
/// scale's marginal width and the others' conditional widths. Empty if no parameter with a
/// one-sided natural bound has such a maximum. `near` is an approximate position on the real line.
std::optional<Funnel> funnel_middle(const Posterior& posterior, const Eigen::VectorXd& near);

/// All tails, two per parameter, about the middle of a funnel (tail.cpp). If every prior is proper,
/// the tails of the others are measured with a fixed scale, because a free scale runs into the neck
/// as soon as they leave the middle.
std::vector<Tail> tails(const Posterior& posterior, const Funnel& funnel);

/// Whether the density in natural units increases as parameter i approaches its lower bound, with
/// the others at their conditional mode. Followed from `middle`, on the real line, over e^12.
bool rises_without_end(const Posterior& posterior, const Eigen::VectorXd& middle, int i);

}  // namespace wearwell
