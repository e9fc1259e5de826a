#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell::plan {

/// What tests are to determine: one number for each point of the parameters, such as the life by
/// which 10 % of a population have failed.
struct Goal {
  std::string name;  ///< "B10 of softer spring"
  Unit unit;         ///< of reports
  /// Of natural parameters (SI, in the order of the study); SI. Not finite where it has no value.
  std::function<double(const double* x)> value;
  /// Its posterior 5, 50 and 95 % quantiles, SI, as the study reports them; empty where the study
  /// reports none.
  std::function<std::optional<std::vector<double>>(const WeightedDraws& draws)> reported = {};
  /// Of a B-life: the distribution of lives of new units that it is of, SI. Else empty.
  std::function<LifeDistribution(std::span<const double> x)> lives = {};
};

/// The goal that a text names, case ignored:
///  - "B10 at NAME" ("of" and "for" too): a life of the study's [predict], at any percentage;
///    NAME may be left out if there is one;
///  - a reported quantity, by its name, or "NAME of WHAT", or as `known_goals` lists it;
///  - a prediction, "volume at 20000 cycles";
///  - a parameter.
/// `study` must outlive the goal. Throws InputError that lists the known ones.
Goal goal_of(const PosteriorStudy& study, const std::string& text);

/// Names of all goals of a study.
std::vector<std::string> known_goals(const PosteriorStudy& study);

/// The values of a goal at nodes, on the scale on which its uncertainty is measured.
struct GoalValues {
  std::vector<double>
      value;  ///< ln of the value in its unit if `logarithmic`, else the value itself
  bool logarithmic = false;  ///< all values are positive (and not logarithms already)

  double in_unit(double on_scale) const;
};

/// In parallel; nodes x parameters. Throws InputError if the goal has no value at more than 0.1 %
/// of the weight; a smaller part counts with the mean.
GoalValues goal_values(const Goal& goal, const Points& nodes, std::span<const double> weights);

}  // namespace wearwell::plan
