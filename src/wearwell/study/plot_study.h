#pragma once

#include <vector>

#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/infer/fit.h"
#include "wearwell/study/plots.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell {

/// Computes all plots of the final posterior; takes some tens of milliseconds.
Plots plot_study(const PosteriorStudy& study, const Posterior& posterior, const Fit& fit);

/// A few points of equal weight that represent the tens of thousands of a quadrature in curves.
/// Their quantiles change by less than a plot shows.
WeightedDraws thinned(const WeightedDraws& draws, Eigen::Index count = 4000);

/// Fewer points for reported numbers: keeps every point with at least `share` of the weight and, of
/// the others in order, one per `share` of weight.
WeightedDraws gathered(const WeightedDraws& draws, double share);

/// The density of `parameter` after every stage, over one range: that of the 90 % intervals of the
/// later half of the stages.
std::vector<Curve> stage_densities(const Parameter& parameter, Eigen::Index index,
                                   const std::vector<WeightedDraws>& stages);

}  // namespace wearwell
