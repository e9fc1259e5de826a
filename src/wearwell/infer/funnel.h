#pragma once

#include <optional>
#include <vector>

#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/mode.h"
#include "wearwell/infer/tail.h"

namespace wearwell {

struct Funnel {
  int scale;    ///< the parameter as it nears whose bound the density rises without end
  Mode middle;  ///< not of the density: of the mass
};

/// The middle of a posterior whose density has no mode though its mass is finite: as a scale nears the bound of its support
/// the others close in on what reproduces the data (fewer rows than parameters), and the density rises without end while
/// the mass falls. Where the marginal density of that scale (the others integrated out by Laplace's approximation) is
/// highest, the others at their conditional mode, with the curvature of a normal law that has the scale's marginal width
/// and the others' conditional one. Nothing where no parameter with a bound on one
/// side of its natural support has such a maximum. `near` is about where on the real line.
std::optional<Funnel> funnel_middle(const Posterior& posterior, const Eigen::VectorXd& near);

/// All tails, two a parameter, about the middle of a funnel (tail.cpp). Where every prior is proper, those of the others are
/// told with the scale held: free, it runs into the throat as soon as they leave the middle.
std::vector<Tail> tails(const Posterior& posterior, const Funnel& funnel);

/// Does the density of the parameters in their own units rise for as long as parameter i nears its lower bound, the others
/// at their conditional mode? Followed from `middle`, on the real line, over e^12.
bool rises_without_end(const Posterior& posterior, const Eigen::VectorXd& middle, int i);

}  // namespace wearwell
