#pragma once

#include <string>
#include <vector>

#include "wearwell/plan/acceleration_question.h"
#include "wearwell/present/html.h"
#include "wearwell/present/table.h"

namespace wearwell::plan {

/// A plan and how well it does. Averages are over the distributions of the planning values.
struct AccelerationPlan {
  PlanKind kind = PlanKind::optimum;
  std::vector<TestLevel> levels;       ///< with whole numbers of specimens
  std::vector<std::size_t> specimens;  ///< at each level
  std::vector<double> failing;         ///< probability to fail by the stop time
  std::vector<double> enough;          ///< probability of the least number of failures
  double standard_error = 0;           ///< of the log of the goal: root of the mean variance
  double curvature_error = 0;          ///< of the coefficient of xi^2; infinite: not determined
};

/// Standard errors of all plans, and of the optimum for these values, where planning values differ
/// from what was assumed.
struct OffValues {
  std::string what;
  std::vector<double> standard_errors;  ///< as AccelerationResult::plans
  double optimum = 0;
};

/// The same test with other stop times, its plans chosen for them.
struct StopTime {
  double factor = 1;   ///< on the stop times of the test
  double until = 0;    ///< SI
  double optimum = 0;  ///< standard errors with as many specimens
  double compromise = 0;
  double specimens = 0;  ///< of the compromise plan, for its standard error at the given stop time
};

struct AccelerationResult {
  AccelerationTest test;
  AccelerationGoal goal;  ///< averaged
  CensoredInformation information;
  std::vector<AccelerationPlan> plans;
  std::vector<OffValues> off;
  std::vector<StopTime> stop_times;  ///< a quarter to four times the given one
  /// The largest gain_at of the optimum plan: 1 if no level is missing; 0 with stop times by level,
  /// where other levels have no stop time.
  double optimum_gain = 0;
  double heaviest_share = 0;  ///< of one point in the mean variance of the optimum plan
};
AccelerationResult acceleration_of(const AccelerationTest& test);

/// The factor of the 90 % interval of the goal: its ends are the estimate times and divided by it.
double interval_factor(double standard_error);
/// The factor on life by which the middle level would have to depart from the line of its
/// neighbours to be noticed with 80 % probability by a two-sided 5 % test; infinite if never.
double noticed_departure(const AccelerationPlan& plan);

std::string plan_name(PlanKind kind);
/// "95.6 degC".
std::string stress_text(const AccelerationTest& test, double xi);

present::Table acceleration_plans_table(const AccelerationResult& result);
present::Table levels_table(const AccelerationResult& result);
present::Table off_values_table(const AccelerationResult& result);
present::Table stop_times_table(const AccelerationResult& result);
present::Table planning_values_table(const AccelerationResult& result);
html::Figure life_stress_figure(const AccelerationResult& result);
html::Figure lower_level_figure(const AccelerationResult& result);

}  // namespace wearwell::plan
