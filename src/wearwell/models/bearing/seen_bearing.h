#pragma once

#include <span>
#include <string>
#include <vector>

#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/models/bearing/wear_fit.h"
#include "wearwell/predict/prediction.h"

namespace wearwell::bearing {

/// The inspections of one of many bearings.
Inspections inspections_of(const Inspections& all, std::size_t bearing);

/// The row of a bearing's farthest inspection, the last of those; it has one.
std::size_t last_inspection(const Inspections& all, std::size_t bearing);

/// The wear rate of one inspected bearing, over the posterior: ln k with weights.
struct BearingRate {
  std::vector<double> log_k, weight;
};

/// For a posterior that already includes the bearing's inspections `own`. If bearings vary, at each
/// of its points x
///
///   p(z | own, x) = N(z; 0, 1) prod_i p(d_i | k exp(k_scatter z), sigma) / L_own(x),
///
/// summed over them at even places of ln k; else the posterior's k. Searches start at `k`.
BearingRate bearing_rate(const WearModel& model, const Inspections& own, double k,
                         const WeightedDraws& posterior);

/// How a bearing at `now` continues, after `revolutions` under `pressure`.
struct GoingOn {
  Duty now;                ///< its farthest inspection
  double pressure = 0;     ///< future, Pa
  double wear_number = 0;  ///< of the limit
  double begin = 0;        ///< its use so far, in the unit of reported lives
  double per_turn = 1;     ///< that unit per future revolution
};

/// When a bearing with this rate reaches the threshold. Wear follows the pressure summed over all
/// revolutions: k sum(p_a dn) is the wear number. Wear before now is assumed even.
double life_at(const GoingOn& bearing, double log_k);

/// The distribution of its whole life. `lives.cdf(bearing.begin)` is the probability that it has
/// passed its threshold.
LifeDistribution formula_life(const GoingOn& bearing, const BearingRate& rate);

}  // namespace wearwell::bearing
