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

/// The wear rate of one bearing that was inspected, over all that the posterior leaves open: ln k with
/// weights.
struct BearingRate {
  std::vector<double> log_k, weight;
};

/// Of a posterior that has the bearing's inspections `own` already. Where bearings differ, at each of its
/// points x
///
///   p(z | own, x) = N(z; 0, 1) prod_i p(d_i | k exp(k_scatter z), sigma) / L_own(x),
///
/// summed over them at even places of ln k; else the posterior's k. `k` is where searches start.
BearingRate bearing_rate(const WearModel& model, const Inspections& own, double k,
                         const WeightedDraws& posterior);

/// How a bearing goes on that has come to `now`, where it has run `revolutions` under `pressure`.
struct GoingOn {
  Duty now;                ///< its farthest inspection
  double pressure = 0;     ///< of what comes, Pa
  double wear_number = 0;  ///< of the limit
  double begin = 0;        ///< what its life is by now, in the unit in which lives are told
  double per_turn = 1;     ///< that unit over one revolution to come
};

/// When a bearing of this rate reaches the limit. What wears is the pressure summed over all
/// revolutions: k sum(p_a dn) is the wear number. Before now it had worn evenly.
double life_at(const GoingOn& bearing, double log_k);

/// The law of its whole life. `lives.cdf(bearing.begin)` is the probability that its limit is behind it.
LifeDistribution formula_life(const GoingOn& bearing, const BearingRate& rate);

}  // namespace wearwell::bearing
