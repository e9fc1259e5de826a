#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/infer/maximum_likelihood.h"
#include "wearwell/models/formula_model/life_groups.h"
#include "wearwell/prob/rank_regression.h"
#include "wearwell/prob/survival_estimate.h"
#include "wearwell/study/classical_table.h"
#include "wearwell/study/life_levels.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell::formula_model {

/// A life whose quantities are estimated: of a part, or of one failure mode alone.
struct ClassicalLife {
  std::string of, at;
  std::shared_ptr<const LifeDistribution> life;
  const Measured* measured = nullptr;  ///< whose family has the paper of survival
};

/// What predict.classical asks for.
struct AskedOfClassics {
  std::shared_ptr<const FormulaModel> model;
  std::shared_ptr<const LogDensity> likelihood;  ///< of all rows
  std::vector<ClassicalLife> lives;
  std::vector<double> percents;  ///< B-lives
  ClassicalLevel level;
  bool mean = false;               ///< the mean life, too
  std::vector<Quantity> survival;  ///< lives to survive
  std::vector<LifeGroup> groups;   ///< the observations by condition, with the life there
  std::vector<std::string> notes;  ///< what does not apply, as sentences
};

/// Observations under one condition.
struct ClassicalGroup {
  std::string words;  ///< the condition; empty if there is one only
  SurvivalEstimate survival;
  double longest = 0;  ///< observed life, SI
  struct Line {
    MedianRanks ranks = MedianRanks::exact;
    RankRegression fit;
    std::vector<double> family_parameters, b_lives;  ///< SI
  };
  std::vector<Line> lines;
  std::shared_ptr<const LifeDistribution> life;
};

struct ClassicalEstimates {
  std::string problem;       ///< why there is no maximum likelihood estimate; empty if there is one
  Eigen::VectorXd position;  ///< natural parameters, SI
  double log_likelihood = 0;  ///< data in SI
  std::vector<ClassicalEstimate> parameters, quantities;
  std::vector<ClassicalGroup> groups;
  std::vector<std::string> notes;
};

/// The estimates of frequentist software: maximum likelihood without the priors, with normal (Fisher)
/// and likelihood-ratio bounds; the median rank regression and the nonparametric estimate of each
/// condition. Searches start from the draws of the fit.
ClassicalEstimates classical_estimates(const AskedOfClassics& asked, const Fit& fit);

}  // namespace wearwell::formula_model
