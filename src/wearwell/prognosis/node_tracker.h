#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::prognosis {

/// All that the readings and the life of one unit depend on, as weighted points: a row of numbers a node.
struct NodeCloud {
  Points values;
  std::vector<double> log_weight;  ///< not normalized
};

/// The law of one reading, given a node; the unit's rows do not depend on each other.
struct NodeReading {
  std::function<double(const double* node)> log_density;
  std::function<double(const double* node)> cdf;
};

/// How a unit goes on from where it is.
struct DegradationPath {
  double now = 0;  ///< along the axis, SI
  /// Where along the axis a node's path reaches the limit: at most `now` where that is behind it, infinite where it
  /// never does.
  std::function<double(const double* node)> end;
  std::function<double(const double* node, double at)> level;  ///< what is limited, from `now` on
};

/// What a trade says of its units, of whose rows none depends on another: all else is done by nodes (docs/explanation/tracking.md).
/// Functions are called by many threads at once.
struct NodeModel {
  std::vector<ReadingColumn> columns;
  std::vector<std::string> labels;
  std::size_t axis = 0;  ///< of `columns`
  std::string limited, noun;
  Quantity limit;
  std::vector<std::string> seen;
  std::string fingerprint;  ///< of study and posterior: states of others are refused
  /// Why there can be no unit of that name; empty where there can be.
  std::function<std::string(const std::string& unit)> refusal;
  /// Why this is no reading; empty where it is one.
  std::function<std::string(const Reading& reading)> problem;
  std::function<NodeReading(const Reading& reading)> reading;
  /// Nodes of a unit that has shown `readings` since the study, along the axis: their weights have the study's rows and
  /// these readings in them. None where no unit can show that. Of a unit that the study has not seen whatever its name.
  std::function<NodeCloud(const std::string& unit, std::span<const Reading> readings)> lay;
  /// `last`: its farthest reading since the study; null where there is none. Nothing where no reading and no word of the
  /// study says how it goes on.
  std::function<std::optional<DegradationPath>(const std::string& unit, const Reading* last)>
      degradation_path;
};

/// What follows the units of such a trade.
std::unique_ptr<const Tracker> node_tracker(NodeModel model);

}  // namespace wearwell::prognosis
