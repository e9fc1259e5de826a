#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "wearwell/prob/standard_distribution.h"

/// Tests that demonstrate a life: n specimens run for a time each, and the test passes if at most a
/// few fail. Knows nothing of texts and units; times are in units of the life to show.
namespace wearwell::plan {

/// What is known of the scatter: log life is location + scale times a standard variable, with each
/// scale as probable as its weight. A Weibull shape is 1/scale. Without scales nothing is known of
/// the distribution (success run): a test counts as one of the life to show, and must last as long.
struct Scatter {
  StandardDistribution distribution = StandardDistribution::smallest_extreme_value;
  struct Possible {
    double scale, weight;
  };
  std::vector<Possible> scales = {};  ///< weights sum to 1
};

/// P(life <= time) where the share `failing` fails by 1.
double failing_by(StandardDistribution distribution, double scale, double failing, double time);

/// P(at most `allowed` of n fail), each with probability p.
double at_most_failing(std::size_t n, std::size_t allowed, double p);

/// A test plan.
struct DemonstrationTest {
  std::size_t specimens = 0;
  std::size_t allowed = 0;  ///< failures with which it passes
  double time = 1;          ///< of each test
};

/// P(the test passes) if the share `failing` fails by `life`, averaged over the scales.
double pass_probability(const DemonstrationTest& test, const Scatter& scatter, double failing,
                        double life = 1);

/// 1 - P(the test passes) at the limit, where just the share `failing` fails by 1: the confidence.
double demonstrated_confidence(const DemonstrationTest& test, const Scatter& scatter,
                               double failing);

/// The fewest specimens that reach the confidence in this time each; none up to ten million.
std::optional<std::size_t> least_specimens(std::size_t allowed, double time, const Scatter& scatter,
                                           double failing, double confidence);

/// The shortest time for so many specimens; needs scales and more specimens than allowed failures.
/// None if it is beyond 10^12 times the life.
std::optional<double> least_time(std::size_t specimens, std::size_t allowed, const Scatter& scatter,
                                 double failing, double confidence);

/// The exposure, sum of (t/life)^shape over all specimens, that demonstrates the life if no more
/// than `allowed` fail until it is reached: chi-square(confidence; 2 allowed + 2) / 2 / -log(1 -
/// failing) (Weibayes; Abernethy, The New Weibull Handbook, ch. 6; Nelson 1985).
double required_exposure(std::size_t allowed, double failing, double confidence);

/// P(at most `failing` fail by 1 | no specimen failed), for Weibull lives, a flat prior of -log
/// reliability at 1 independent of the shape, and the scales' weights as prior of the shape.
double posterior_after_success(std::size_t specimens, double time, const Scatter& scatter,
                               double failing);

/// Groups of equal size, each tested to its first failure (sudden death; Johnson 1964). The test
/// passes as soon as group size * sum of t^shape over groups reaches the exposure.
struct SuddenDeathTest {
  std::size_t groups = 1, size = 1;
  double exposure = 0;  ///< chi-square(confidence; 2 groups) / 2 / -log(1 - failing)
  double earliest = 0;  ///< time at which it passes if no group has failed
  double first_failure_share =
      0;  ///< share of single specimens that fail by a group's median failure
};
SuddenDeathTest sudden_death_test(std::size_t groups, std::size_t size, double shape,
                                  double failing, double confidence);

/// P(it passes) if the share `failing` fails by `life`: it does not depend on the size of groups.
double pass_probability(const SuddenDeathTest& test, double shape, double failing, double life);

/// The median time of a group's first failure, if the share `failing` fails by `life`.
double median_first_failure(std::size_t size, double shape, double failing, double life);

}  // namespace wearwell::plan
