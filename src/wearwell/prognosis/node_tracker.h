#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::prognosis {

/// All that the readings and the life of one unit depend on, as weighted points: one row of values
/// per node.
struct NodeCloud {
  Points values;
  std::vector<double> log_weight;  ///< not normalized
};

/// The distribution of one reading, given a node; the unit's rows are independent.
struct NodeReading {
  std::function<double(const double* node)> log_density;
  std::function<double(const double* node)> cdf;
};

/// How a unit continues from its present position.
struct DegradationPath {
  double now = 0;  ///< along the axis, SI
  /// Where on the axis a node's path reaches the threshold: at most `now` if that is past, infinite
  /// if it never does.
  std::function<double(const double* node)> end;
  /// the quantity with the threshold, from `now` on
  std::function<double(const double* node, double at)> level;
};

/// What a model knows of its units, whose rows are independent; the tracker does the rest by nodes
/// (docs/explanation/tracking.md). Functions are called by many threads at once.
struct NodeModel {
  std::vector<ReadingColumn> columns;
  std::vector<std::string> labels;
  std::size_t axis = 0;  ///< of `columns`
  std::string limited, noun;
  Quantity limit;
  std::vector<std::string> seen;
  std::string fingerprint;  ///< of study and posterior: states of others are refused
  /// Why a unit of that name is invalid; empty if it is valid.
  std::function<std::string(const std::string& unit)> refusal;
  /// Why a reading is invalid; empty if it is valid.
  std::function<std::string(const Reading& reading)> problem;
  std::function<NodeReading(const Reading& reading)> reading;
  /// Nodes of a unit with these `readings` since the study, along the axis; their weights include
  /// the study's rows and these readings. Empty if no unit can show that. A unit that is not in the
  /// study gets the same nodes for any name.
  std::function<NodeCloud(const std::string& unit, std::span<const Reading> readings)> rebuild;
  /// `last`: its farthest reading since the study; null if there is none. Empty if neither a
  /// reading nor the study determines how the unit continues.
  std::function<std::optional<DegradationPath>(const std::string& unit, const Reading* last)>
      degradation_path;
};

/// The tracker for units of such a model.
std::unique_ptr<const Tracker> node_tracker(NodeModel model);

}  // namespace wearwell::prognosis
