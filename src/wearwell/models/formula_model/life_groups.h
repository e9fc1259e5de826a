#pragma once

#include <memory>
#include <vector>

#include "wearwell/input/toml_reader.h"
#include "wearwell/models/formula_model/formula_conditions.h"
#include "wearwell/models/formula_model/formula_life.h"

namespace wearwell::formula_model {

/// Observations of a life under one condition.
struct LifeGroup {
  Conditions conditions;  ///< of the conditions that the likelihood depends on
  std::vector<Response> responses;
  std::vector<int> counts = {};
  std::shared_ptr<const LifeDistribution> life =
      {};  ///< the distribution there; null until it is requested

  double failures() const;
};

/// The observations of the first measured column by their conditions, in the order of their first
/// occurrence. Empty if there are more than `most` conditions.
std::vector<LifeGroup> life_groups(const FormulaModel& model, std::size_t most);

/// The distribution of the first measured column under conditions.
std::shared_ptr<const LifeDistribution> life_distribution(
    const TomlReader& root, const std::shared_ptr<const FormulaModel>& model,
    const Conditions& conditions);

}  // namespace wearwell::formula_model
