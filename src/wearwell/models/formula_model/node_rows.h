#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <memory>
#include <span>
#include <vector>

#include "wearwell/models/formula_model/node_program.h"
#include "wearwell/models/formula_model/unit_readings.h"

namespace wearwell::formula_model {

/// The state of a unit's paths after its farthest row, node by node, for one measured column.
struct NodePath {
  bool begun = false, measured = false;  ///< a row exists; one with a reading of this column
  double place = 0;                      ///< of the last row, SI
  double reading = 0;                    ///< the last one
  /// the running values of the path (NodeProgram::running)
  std::vector<std::vector<double>> carried;
  /// Of a process: the parameters `mean` and spread at the last reading, and the path there: its
  /// mean, and if readings have an error its variance (else both empty).
  std::vector<double> mean, spread, at, variance;
};

/// The predictive tail probabilities of a reading over the nodes.
class Predicted {
 public:
  void add(double weight, double up_to, double from) {
    below_ += weight * up_to;
    above_ += weight * from;
  }
  /// The two-sided predictive p-value; for a censored reading the probability of the event.
  double p_value() const;
  prognosis::PredictiveTails tails() const { return {below_, above_}; }
  bool any() const { return below_ > 0 || above_ > 0; }

 private:
  double below_ = 0, above_ = 0;  // P(reading or less), P(reading or more)
};

/// A reading in its predictive distribution.
struct ReadingPrediction {
  double p_value = 1;  ///< the smallest one over measured columns, times their number
  std::vector<prognosis::PredictiveTails> tails = {};  ///< of each uncensored measured value
};

/// The likelihood of readings at many nodes at once. Immutable.
class NodeRows {
 public:
  /// `limited`: an expression in addition to measured columns; it may depend on earlier rows, too.
  /// Its path is the last of `paths`.
  /// `open`: the place of a reading on the axis is given per node; not for paths that run.
  NodeRows(std::shared_ptr<const FormulaModel> model, const std::vector<formula::Wanted>& limited,
           bool open = false);

  const FormulaModel& model() const { return *model_; }
  /// Whether a reading's likelihood depends on earlier ones: then rows must be in order along the
  /// axis.
  bool follows() const { return follows_; }
  /// Whether a path is a sum over rows or a state, so that rows have one axis for all nodes.
  bool runs() const { return runs_; }
  std::vector<NodePath> paths() const { return std::vector<NodePath>(programs_.size()); }
  /// Whether these are paths of this many nodes of this formula: validates bytes from outside.
  bool fit(const std::vector<NodePath>& paths, std::size_t nodes) const;

  /// Some nodes with their weights, ascending, over which a prediction is summed.
  struct Sample {
    std::vector<std::size_t> node;
    std::vector<double> weight;
  };

  /// Fills `log_likelihood` (may be empty), node by node, for a reading whose paths are at `before`, and updates
  /// `after` (may be null). With a sample, fills `prediction`. `places`: of each node, if open.
  void look(const Nodes& nodes, const UnitReading& reading, const std::vector<NodePath>& before,
            std::vector<NodePath>* after, std::span<double> log_likelihood, const Sample* sample,
            ReadingPrediction* prediction, const double* places = nullptr) const;
  /// The same prediction alone: rows that do not follow each other are computed at the nodes of the
  /// sample only.
  ReadingPrediction predict(const Nodes& nodes, const UnitReading& reading,
                            const std::vector<NodePath>& before, const Sample& sample) const;

 private:
  struct Scratch {
    std::vector<NodeProgram::Scratch> programs;
  };
  struct Block;
  void plain_block(const Block& block, const Measured& measured, const Response& y, int count,
                   const ResponseColumn& column, double* to) const;
  void process_block(const Block& block, const Measured& measured, double y, const NodePath& before,
                     NodePath* after, double* to) const;

  std::shared_ptr<const FormulaModel> model_;
  std::vector<NodeProgram> programs_;  // by measured column, then the quantity with the threshold
  bool follows_ = false, runs_ = false;
  mutable tbb::enumerable_thread_specific<std::unique_ptr<Scratch>> scratch_;
};

}  // namespace wearwell::formula_model
