#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "wearwell/plan/censored_information.h"

/// Accelerated life tests with one stress that predict a quantile of life at the use condition: log
/// life = location(xi) + scale * Z, location linear in the transformed stress xi, 0 at the use
/// condition and 1 at the highest, but for a known part. Tests stop at one time, or at one for each
/// level. Location, slope and scale are all estimated, by
/// maximum likelihood; variances are those of large samples (Nelson and Kielpinski 1976; Meeker and
/// Escobar 1998, ch. 20). Knows nothing of texts and units.
namespace wearwell::plan {

/// Possible planning values. (log stop time - location(xi)) / scale = at_use + rise * xi, but for
/// the known parts of AccelerationGoal.
struct PlanningPoint {
  double at_use = 0;
  double rise = 0;  ///< > 0: life falls with stress
  double scale = 1;
  double weight = 1;  ///< weights of all points sum to 1
};

/// What is predicted, and from which planning values.
struct AccelerationGoal {
  StandardDistribution distribution = StandardDistribution::smallest_extreme_value;
  double failing = 0.1;               ///< the goal is the log life by which this share fails at use
  std::vector<PlanningPoint> points;  ///< variances are averaged over them
  bool scale_known = false;           ///< the scale is not estimated
  /// Log stop times of the lower, the middle and the highest level, less that of the points. Plans
  /// with two levels have no middle one.
  std::array<double, 3> log_stops = {0, 0, 0};
  /// The part of the location that is known beside the line, with its sign changed; 0 at the use
  /// condition (the Eyring relation's log T). May be empty.
  std::function<double(double xi)> known_part = {};
};

/// Specimens at one stress.
struct TestLevel {
  double xi = 0;
  double share = 0;     ///< of all specimens
  double log_stop = 0;  ///< log of its stop time over that of the points
};

/// (log stop time - location) / scale of a level: how far its tests reach.
double standardized_stop(const AccelerationGoal& goal, const PlanningPoint& point,
                         const TestLevel& level);

/// Large-sample variance of the goal's estimate, times the number of specimens; infinite if the
/// levels do not determine it.
double goal_variance(const AccelerationGoal& goal, const CensoredInformation& information,
                     std::span<const TestLevel> levels);

/// The same at each point, without its weight.
std::vector<double> goal_variances(const AccelerationGoal& goal,
                                   const CensoredInformation& information,
                                   std::span<const TestLevel> levels);

/// Large-sample variance of the coefficient of xi^2, if the relation had one, times the number of
/// specimens; infinite with fewer than three levels.
double curvature_variance(const AccelerationGoal& goal, const CensoredInformation& information,
                          std::span<const TestLevel> levels);

/// By how much a little more weight at xi would reduce the variance, relative to weight everywhere:
/// at most 1 for all xi if and only if the levels are optimum (equivalence theorem; Whittle 1973).
/// The weight stops at the time of the points.
double gain_at(const AccelerationGoal& goal, const CensoredInformation& information,
               std::span<const TestLevel> levels, double xi);

/// The kinds of plans: levels and allocation.
enum class PlanKind {
  optimum,     ///< two levels; lower level and allocation optimized
  compromise,  ///< a middle level half way with a given share; lower level and allocation optimized
  four_two_one,  ///< allocation 4:2:1 from low to high, lower level optimized (Meeker and Hahn 1985)
  equal          ///< three levels of equal allocation, lower level optimized
};

/// The plan of a kind with the least variance, its lower level not below `lowest`. The levels
/// ascend; the last is 1.
std::vector<TestLevel> best_plan(PlanKind kind, const AccelerationGoal& goal,
                                 const CensoredInformation& information, double lowest,
                                 double middle_share);

/// The plan of a kind with this lower level and the best allocation.
std::vector<TestLevel> best_allocation(PlanKind kind, const AccelerationGoal& goal,
                                       const CensoredInformation& information, double low,
                                       double middle_share);

/// Whole numbers of specimens for shares, by largest remainders; their sum is n.
std::vector<std::size_t> whole_allocation(std::span<const TestLevel> levels, std::size_t n);

/// P(a specimen fails by the stop time of its level), averaged over the points.
double failing_at(const AccelerationGoal& goal, const TestLevel& level);

/// P(at least `least` of n specimens fail by then), averaged over the points.
double enough_failures(const AccelerationGoal& goal, const TestLevel& level, std::size_t n,
                       std::size_t least);

}  // namespace wearwell::plan
