#pragma once

#include <vector>

#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/infer/fit.h"
#include "wearwell/study/plots.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell {

/// Everything that a report draws of the final posterior; some tens of milliseconds.
Plots plot_study(const PosteriorStudy& study, const Posterior& posterior, const Fit& fit);

/// A few points of one weight that stand for the tens of thousands of a quadrature, for curves:
/// their quantiles move by less than a plot shows.
WeightedDraws thinned(const WeightedDraws& draws, Eigen::Index count = 4000);

/// Fewer points for numbers that are told: those that hold `share` of the weight or more as they are, and of the others, in
/// their order, one for every so much of it.
WeightedDraws gathered(const WeightedDraws& draws, double share);

/// The density of `parameter` after every stage, over one range: that of the 90 % intervals of the
/// later half of the stages.
std::vector<Curve> stage_densities(const Parameter& parameter, Eigen::Index index,
                                   const std::vector<WeightedDraws>& stages);

}  // namespace wearwell
