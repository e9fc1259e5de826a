#pragma once

#include <optional>
#include <vector>

#include "wearwell/models/recurrence/growth_test.h"

namespace wearwell::recurrence {

/// Failure intensities of one unit at the end of a growth test [1/SI age].
struct ProjectedIntensity {
  double demonstrated = 0;  ///< before the delayed fixes
  double projected = 0;     ///< after them
  double potential = 0;     ///< after all modes that would be fixed were found: growth potential
  double new_modes = 0;     ///< h(T), with which new modes occur that would be fixed
};

/// Crow's estimates (1982, 2004; MIL-HDBK-189C, 6.2): the failures N_i of mode i with a delayed fix of effectiveness d_i,
/// and h(T) by the power law of the first occurrences of these modes with beta-bar = (m - 1)/sum ln(T/t_i):
/// lambda_A + sum (1 - d_i) N_i/T + mean(d) h(T). With fixes during the test the intensity of the other modes is that of
/// the power law of all failures at T by its beta-bar, less that of the modes with delayed fixes.
struct CrowProjection {
  double beta = 0;  ///< of the first occurrences, beta-bar
  ProjectedIntensity intensity;
};
/// Empty with fewer than two modes with delayed fixes, or if all occurred first at the end of the test.
std::optional<CrowProjection> crow_projection(const GrowthTest& test);

/// Points of the posterior, in one order.
struct ProjectionDraws {
  std::vector<ProjectedIntensity> intensity;
  std::vector<double> beta, modes;  ///< of the first occurrences: shape, expected number until T
  std::vector<double> found;        ///< share of the intensity of modes with delayed fixes that the
                                    ///< modes which were seen have
};

/// The posterior whose mean, given beta, is Crow's projection. Modes that would be fixed have constant rates, which are
/// the points of a stable Poisson process with the index beta, so that first occurrences follow the power law with
/// 0 < beta < 1, estimated from them with the priors 1/beta and 1/M of its shape and of the expected number M of modes
/// until T. Given beta, the rate of a mode with N_i failures has a gamma distribution with the shape N_i - beta and the
/// rate T, and the sum of the rates of all modes not yet seen one with the shape m beta. Modes that are not fixed have
/// the Jeffreys prior of a Poisson rate; failures of modes that were fixed during the test are a power law with the
/// priors 1/beta and 1/M. Deterministic.
ProjectionDraws projection_draws(const GrowthTest& test);

/// The probability of beta > 1 by the first occurrences alone: new modes become more frequent, which modes with constant
/// rates do not.
double probability_of_rising_discovery(const GrowthTest& test);

}  // namespace wearwell::recurrence
