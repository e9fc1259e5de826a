#pragma once

#include <string>
#include <vector>

#include "wearwell/models/fatigue/design_curve.h"
#include "wearwell/models/fatigue/sn_result.h"
#include "wearwell/study/comparison.h"

namespace wearwell::fatigue {

/// An S-N study and its weight in the mixture.
struct WeightedModel {
  std::string name;  ///< as its user calls it: the folder
  double weight = 0;
  SnResult result;
};

/// A study that has no more weight than this is no candidate for the most cautious.
inline constexpr double least_weight = 0.05;

/// Where and how surely lives are wanted.
struct DesignQuestion {
  std::vector<double>
      alternating;  ///< Pa, or the SI unit of what stands for the stress; from high to low
  StressLine line;  ///< the mean stress of each
  std::vector<DesignLevel> levels;
};

/// Lives [cycles] under one stress. Infinite where the share has no end of life with that confidence.
struct DesignPoint {
  Stress stress;
  double median = 0;                        ///< of the mixture: half of the items, even odds
  std::vector<double> averaged;             ///< by level: of the mixture
  std::vector<std::vector<double>> models;  ///< by model, by level: its own posterior's
  std::vector<double> cautious;             ///< by level: the least of the models that have weight
};

/// The curve to design with of several models of the same tests. At reliability R and confidence C it is the life
/// that a share R of the items outlasts with probability C, where the parameters are the posterior's of a model and
/// the model is each with its weight: the quantile 1 - C of the life's R-quantile over the points of all posteriors, the
/// weight of each multiplied by its model's. Weights are those of stacking (model_weights), which makes it a
/// quantile of the mixture that predicts best (Yao, Vehtari, Simpson, Gelman 2018); they are no probabilities
/// of a model being true.
std::vector<DesignPoint> averaged_design(const std::vector<WeightedModel>& models,
                                         const DesignQuestion& question);

/// S-N results with their weights, the best prediction first; cautions are the comparison's. Throws InputError where
/// they are not of the same tests (by what was seen and by their stresses), or one has no leave-one-out prediction.
struct ModelsToAverage {
  std::vector<WeightedModel> models;
  std::vector<std::string> cautions;
};
ModelsToAverage models_to_average(const std::vector<std::filesystem::path>& folders);

/// Stresses where curves are told: 21 over those tested, 9 where a model has a random limit.
std::vector<double> design_stresses(const std::vector<WeightedModel>& models);

/// The mean stress of the tests, where it follows from their span alone: the same everywhere, or at one stress ratio.
/// Throws InputError where the tests have more than that.
StressLine design_line(const std::vector<WeightedModel>& models);

}  // namespace wearwell::fatigue
