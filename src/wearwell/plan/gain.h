#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "wearwell/plan/goal.h"
#include "wearwell/plan/outcomes.h"

namespace wearwell::plan {

/// A posterior as weighted nodes with the values of a goal there, in ascending order of the goal.
struct GoalNodes {
  std::vector<double> goal;    ///< GoalValues::value, ascending
  std::vector<double> weight;  ///< sum to 1
  /// Loss of each decision at each node, nodes x decisions; empty without decisions.
  Eigen::MatrixXd loss = {};
  Eigen::Index best = 0;  ///< the decision of least mean loss under `weight`
};

/// What is known of the goal: its standard deviation, and the ends of its central 90 % interval, on
/// the scale of GoalValues.
struct GoalSpread {
  double mean = 0, sd = 0, low = 0, median = 0, high = 0;
  double width() const { return high - low; }
};

/// Of nodes with these weights (not negative; their scale does not matter). Quantiles are
/// interpolated between nodes, each of which counts half below its value, so that they change
/// smoothly with the weights.
GoalSpread goal_spread(std::span<const double> goal, std::span<const double> weight);

/// How many equal weights carry as much: (sum)^2 / sum of squares.
double effective_number(std::span<const double> weight);

/// The expected state of knowledge after tests (preposterior analysis; Raiffa and Schlaifer, Applied
/// Statistical Decision Theory, 1961; Chaloner and Verdinelli, Bayesian experimental design: a
/// review, Statistical Science 10, 1995, 273-304).
struct Gain {
  double variance = 0;        ///< expected posterior variance of the goal
  double variance_error = 0;  ///< standard error; 0 where it is by quadrature
  double width = 0;           ///< expected width of its 90 % interval, on the goal's scale; of a
                              ///< thousand thinned nodes it has an error of some per cent, the
                              ///< variance one of less than 0.1 %
  double width_error = 0;
  double information = 0;  ///< mutual information of outcomes and parameters, nats
  double information_error = 0;
  double use = 0;     ///< expected value of one specimen's test (time on test), unit of the table
  double runout = 0;  ///< expected share of run-outs
  double effective = 0;  ///< expected number of nodes that carry the posterior after the tests
  /// The expected value of sample information (Raiffa and Schlaifer 1961): mean loss of today's
  /// best decision less that of the best after the tests, at least 0.
  double saved = 0;
  double saved_error = 0;
};

/// One specimen, by quadrature over outcomes and nodes. `outcomes` have the nodes' order.
Gain gain_of_one(const GoalNodes& nodes, const Outcomes& outcomes);

/// Specimens of several kinds: `kinds[k]` tests with outcomes `*outcomes[k]`.
struct Batch {
  std::vector<const Outcomes*> outcomes;
  std::vector<int> specimens;
};

/// Nested Monte Carlo: nodes by systematic sampling of the posterior, outcomes under each, and the
/// posterior after them by reweighting. Random numbers depend on the sample and the position of a
/// specimen only, so that batches are compared with the same ones; the same bits for any number of
/// threads.
struct NestedSettings {
  int samples = 256;
  std::uint64_t seed = 1;
};
Gain gain_of_batch(const GoalNodes& nodes, const Batch& batch, const NestedSettings& settings);

/// A typical posterior after tests, as weights over `nodes`: of all simulated ones that whose
/// standard deviation is nearest to `sd` and whose median is nearest to the present one. (The
/// expected posterior itself is the present one.)
std::vector<double> typical_posterior(const GoalNodes& nodes, const Batch& batch,
                                      const NestedSettings& settings, double sd);

}  // namespace wearwell::plan
