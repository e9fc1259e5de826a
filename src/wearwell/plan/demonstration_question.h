#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wearwell/plan/demonstrate.h"
#include "wearwell/plan/demonstration.h"
#include "wearwell/plan/life_requirement.h"
#include "wearwell/plan/planning_value.h"

namespace wearwell::plan {

/// A question about a demonstration test, as read.
struct DemonstrationGoal {
  LifePoint goal;
  double confidence = 0.9;
  std::vector<std::size_t> failures;     ///< allowed
  std::string distribution = "weibull";  ///< its name
  std::optional<PlanningValue> spread;   ///< shape, or sigma; none: unknown
  Scatter scatter;
  std::optional<std::size_t> specimens;
  std::optional<double> time;    ///< in units of the life to show
  std::vector<LifePoint> truth;  ///< lives in SI
  std::optional<std::size_t> groups;

  bool weibull() const { return distribution == "weibull"; }
  const char* spread_name() const { return weibull() ? "shape" : "sigma"; }
  /// The scale of log life for a value of the shape or sigma.
  double scale(double value) const { return weibull() ? 1 / value : value; }
  /// With the shape known to be the value at a normal score.
  Scatter scatter_at(double z) const;
  /// A life in the unit of the goal, from units of the life to show.
  double shown(double relative) const { return from_si(goal.unit, relative * goal.life); }
};

/// Reads and checks a question. Throws InputError that names the option.
DemonstrationGoal read_demonstration(const DemonstrateQuestion& question);

}  // namespace wearwell::plan
