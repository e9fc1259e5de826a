#pragma once

#include <filesystem>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "wearwell/models/fatigue/design_curve.h"
#include "wearwell/models/fatigue/sn_result.h"
#include "wearwell/study/comparison.h"

namespace wearwell::fatigue {

/// An S-N study and its weight in the mixture.
struct WeightedModel {
  std::string name;  ///< the user's name of it: the folder
  double weight = 0;
  SnResult result;
};

/// A study of smaller weight is not considered for the most cautious.
inline constexpr double least_weight = 0.05;

/// The stresses, reliability and confidence of the requested lives.
struct DesignQuestion {
  std::vector<double> alternating;  ///< Pa, or the SI unit of the stress quantity; from high to low
  StressLine line;                  ///< the mean stress of each
  std::vector<DesignLevel> levels;
};

/// Lives [cycles] under one stress. Infinite if the share has no end of life with that confidence.
struct DesignPoint {
  Stress stress;
  double median = 0;                        ///< of the mixture: reliability and confidence of 1/2
  std::vector<double> averaged;             ///< by level: of the mixture
  std::vector<std::vector<double>> models;  ///< by model, by level: from its own posterior
  /// by level: the smallest among models of non-negligible weight
  std::vector<double> cautious;
};

/// The design curve of several models of the same tests. At reliability R and confidence C it is
/// the life that a share R of the items outlasts with probability C, averaged over the posterior of
/// each model and over the models by weight: the quantile 1 - C of the life's R-quantile over the
/// points of all posteriors, with each weight multiplied by its model's. Weights are those of
/// stacking (model_weights), which makes it a quantile of the mixture with the best predictions
/// (Yao, Vehtari, Simpson, Gelman 2018); they are not probabilities of a model being true.
/// Throws Cancelled.
std::vector<DesignPoint> averaged_design(const std::vector<WeightedModel>& models,
                                         const DesignQuestion& question,
                                         const std::stop_token& stop = {});

/// S-N results with their weights, the best prediction first; cautions are the comparison's. The
/// folders have names for the report. Throws InputError if they are not of the same tests (by
/// outcomes and stresses), or one has no leave-one-out prediction. One result has the weight 1.
struct ModelsToAverage {
  std::vector<WeightedModel> models;
  std::vector<std::string> cautions;
};
ModelsToAverage models_to_average(
    const std::vector<std::pair<std::string, std::filesystem::path>>& folders);

/// Stresses of the curves: 21 over the tested range, 9 if a model has a random limit.
std::vector<double> design_stresses(const std::vector<WeightedModel>& models);

/// The mean stress of the tests, if their range determines it: the same everywhere, or at one
/// stress ratio. Throws InputError if the tests have several.
StressLine design_line(const std::vector<WeightedModel>& models);

}  // namespace wearwell::fatigue
