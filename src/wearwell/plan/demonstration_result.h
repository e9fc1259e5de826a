#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wearwell/plan/demonstration_question.h"
#include "wearwell/present/html.h"
#include "wearwell/present/table.h"

namespace wearwell::plan {

/// What a question about a demonstration test asks for.
enum class Sought { specimens, time, confidence };

/// A plan with the number of failures that it allows. Times are in units of the life to show.
struct DemonstrationPlan {
  DemonstrationTest test;
  double confidence = 0;
  /// What passes with 90 %: the life by which the goal's share fails; without a distribution the
  /// share that fails by the life to show.
  double passing = 0;
  std::optional<double> low, high;  ///< the sought number with the shape at its 5 and 95 % quantile
  std::optional<double> exposure;   ///< required_exposure, for a Weibull shape that is a number
  std::optional<double> by_exposure;  ///< the sought number by it: specimens, time or confidence
  std::optional<double> posterior;    ///< posterior_after_success, for a prior of the shape
};

/// The time of each test for a number of specimens, for each number of allowed failures.
struct SampleAgainstTime {
  std::size_t specimens;
  std::vector<std::optional<double>> times;
};

struct Demonstration {
  DemonstrationGoal goal;
  Sought sought = Sought::specimens;
  std::vector<DemonstrationPlan> plans;         ///< one for each number of allowed failures
  std::vector<SampleAgainstTime> sample_sizes;  ///< with a shape
};

/// Throws InputError if no plan reaches the confidence.
Demonstration demonstration_of(const DemonstrationGoal& goal);

/// The true lives that are reported: those of the question, or some.
std::vector<LifePoint> true_lives(const DemonstrationGoal& goal);

/// "B10", for a share of 0.1.
std::string b_life_name(double failing);

present::Table plans_table(const Demonstration& result);
present::Table pass_table(const Demonstration& result);
present::Table sample_size_table(const Demonstration& result);
html::Figure sample_size_figure(const Demonstration& result);
html::Figure characteristic_figure(const Demonstration& result);

/// A sudden-death test, whole.
Answer sudden_death_answer(const DemonstrationGoal& goal);

/// "Weibull lives of shape 2".
std::string scatter_text(const DemonstrationGoal& goal);
/// "reliability 90 % at 1 000 000 cycles".
std::string goal_text(const DemonstrationGoal& goal);
nlohmann::ordered_json goal_json(const DemonstrationGoal& goal);

}  // namespace wearwell::plan
