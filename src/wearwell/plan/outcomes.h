#pragma once

#include <Eigen/Dense>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/plan/test_rows.h"

namespace wearwell::plan {

/// A test that is planned.
struct PlannedTest {
  std::size_t row = 0;              ///< its conditions: row of the table of conditions
  std::optional<double> stop = {};  ///< unit of the measured column: a run-out if it lasts so long
};

/// The possible outcomes of one test under each of several points of the parameters ("nodes").
/// A continuous outcome is represented by the nodes of composite Gauss-Legendre quadrature, on a
/// logarithmic scale where values are positive, so sums over outcomes are integrals. Counts are
/// whole numbers.
struct Outcomes {
  std::vector<double> value;       ///< ascending, unit of the table; of a run-out its stop
  std::vector<double> cell_begin;  ///< one cell of values for each; continuous outcomes only
  std::vector<double> cell_end;
  bool runout = false;   ///< the last outcome is a run-out
  bool counted = false;  ///< whole numbers; a cell is a block of them, its value the middle one
  /// log probability of each outcome (density times quadrature weight), nodes x outcomes; sums to 1
  /// over the outcomes of a node.
  Eigen::MatrixXf log_probability;
  /// Mean over nodes of the deviation of a node's probabilities from 1 before they are scaled to 1:
  /// the error of the quadrature.
  double defect = 0;

  std::size_t size() const { return value.size(); }
  double runout_probability(Eigen::Index node) const {
    return runout ? std::exp(static_cast<double>(log_probability(node, log_probability.cols() - 1)))
                  : 0;
  }
  /// The outcome with cdf `u` under a node, 0 < u < 1: in its cell, evenly on the scale of the
  /// quadrature. `positive` as in TestStudy.
  TestOutcome drawn(Eigen::Index node, double u, bool positive) const;
  /// The index of the outcome with cdf `u`.
  std::size_t drawn_index(Eigen::Index node, double u) const;
};

/// The outcomes of each test. `weights` of the nodes sum to 1. A test under which the model has no
/// value, with more than 0.1 % of the weight, throws InputError that names its row; so does a test
/// without a stop that may never end. Deterministic for any number of threads.
std::vector<Outcomes> possible_outcomes(const TestStudy& study, const Table& conditions,
                                        std::span<const PlannedTest> tests, const Points& nodes,
                                        std::span<const double> weights);

/// A few of the nodes, with weights that sum to 1: enough to find where outcomes lie.
struct Scouts {
  Points nodes;
  std::vector<double> weights;
};
Scouts scouts_of(const Points& nodes, std::span<const double> weights);

/// Makes the probabilities of each node sum to 1, and `defect` their mean deviation before. Nodes
/// at which no value has a density count as impossible; their probabilities are then even.
void scale_to_one(Outcomes& outcomes, std::span<const double> weights);

/// "candidates.csv, row 3 (line 4)"
std::string row_of(const Table& conditions, std::size_t row);

/// Throws InputError if the model has no value at nodes of more than 0.1 % of the weight.
void refuse_impossible(const Table& conditions, std::size_t row, double weight);

}  // namespace wearwell::plan
