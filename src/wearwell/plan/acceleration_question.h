#pragma once

#include <array>
#include <string>
#include <vector>

#include "wearwell/base/unit.h"
#include "wearwell/plan/accelerate.h"
#include "wearwell/plan/accelerated_test.h"
#include "wearwell/plan/planning_value.h"

namespace wearwell::plan {

/// How log life depends on the stress: a straight line in the transformed stress; for the Eyring
/// relation less log T, life = constant / T exp(E/(k_B T)) (Meeker and Escobar 1998, section 18.3).
enum class Relation { arrhenius, eyring, inverse_power, linear };

inline constexpr double electron_volt = 1.602176634e-19;  ///< J

inline bool is_of_temperature(Relation relation) {
  return relation == Relation::arrhenius || relation == Relation::eyring;
}

/// The stress that falls with life: -1/(k_B T) [1/eV], log of the stress, or the stress.
double transformed_stress(Relation relation, double stress);
double stress_of(Relation relation, double transformed);

/// A planning value with its name and the option that gave it.
struct NamedValue {
  std::string name, option;
  PlanningValue value;
  std::string unit = {};  ///< of its numbers, for tables
  double shown_by = 1;    ///< a number in `unit` is the value times this
};

/// A question about an accelerated test, as read. Stresses and times in SI.
struct AccelerationTest {
  AccelerateQuestion question;
  StandardDistribution distribution = StandardDistribution::smallest_extreme_value;
  Relation relation = Relation::arrhenius;
  Unit stress_unit, time_unit;
  double use = 0, highest = 0, until = 0;
  std::vector<double> stops = {};  ///< of the lower, middle and highest level; empty: `until`
  double failing = 0.1;            ///< of the goal
  double lowest_xi = 0;            ///< of the levels
  double low_xi = -1;              ///< lower level of plans with three levels; < 0: optimized
  double middle_share = 0.2;
  double life_share = 0.5;           ///< share that fails by the life at the highest stress
  std::array<NamedValue, 3> values;  ///< the spread, and two of the relation

  double xi(double stress) const;
  double stress(double xi) const;             ///< SI
  double stop(const TestLevel& level) const;  ///< SI
  /// The planning point where the three values are these.
  PlanningPoint point(const std::array<double, 3>& value) const;
  /// The goal with every planning value at its median, or averaged over their distributions.
  AccelerationGoal at_medians() const;
  AccelerationGoal averaged() const;
  AccelerationGoal with(const std::array<double, 3>& value) const;
  std::array<double, 3> medians() const;
  bool uncertain() const;
};

/// Reads and checks a question. Throws InputError that names the option.
AccelerationTest read_acceleration(const AccelerateQuestion& question);

}  // namespace wearwell::plan
