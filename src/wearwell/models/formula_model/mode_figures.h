#pragma once

#include <memory>
#include <string>
#include <vector>

#include "wearwell/models/formula_model/formula_life.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell::formula_model {

/// A step of the cumulative incidence of one mode.
struct IncidenceStep {
  double at, share;
};

/// The Aalen-Johansen estimate of the share failed by each mode (Aalen and Johansen 1978): for exact lives,
/// run-outs and delayed entries. Empty if a mode is unknown or a life is known to an interval only.
std::vector<std::vector<IncidenceStep>> incidence_steps(const FailureModes& modes,
                                                        const Observed& lives);

/// Adds the figure of the share failed by each mode against life, under these conditions.
void show_incidence(std::shared_ptr<const FormulaModel> model,
                    std::shared_ptr<const LifeDistribution> part, const std::string& conditions,
                    PosteriorStudy& study);

}  // namespace wearwell::formula_model
