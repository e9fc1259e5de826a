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
      {};                                   ///< the distribution there; null until it is requested
  std::uint32_t modes = ~std::uint32_t{0};  ///< the failure modes that can end it, as bits

  double failures() const;
};

/// The observations of the first measured column by their conditions, in the order of their first
/// occurrence. Empty if there are more than `most` conditions. With failure modes first those of the parts, then
/// those of each mode, where failures by others are run-outs.
std::vector<LifeGroup> life_groups(const FormulaModel& model, std::size_t most);

/// The distribution of the first measured column under conditions. With failure modes the life of a part
/// that these modes (bits) can end. Throws InputError at `key` of `table` if a condition is missing.
std::shared_ptr<const LifeDistribution> life_distribution(
    const TomlReader& table, const std::string& key,
    const std::shared_ptr<const FormulaModel>& model, const Conditions& conditions,
    std::uint32_t modes = ~std::uint32_t{0});

/// With [use_rate] the life in calendar time.
std::shared_ptr<const LifeDistribution> life_in_calendar_time(
    const TomlReader& table, const std::string& key,
    const std::shared_ptr<const FormulaModel>& model, const Conditions& conditions);

/// The same of one subpopulation of a mixture alone.
std::shared_ptr<const LifeDistribution> life_of_subpopulation(
    const TomlReader& table, const std::string& key,
    const std::shared_ptr<const FormulaModel>& model, const Conditions& conditions, std::size_t k);

/// The columns that the formulas of a model depend on.
struct UsedColumns {
  std::vector<const NumberColumn*> numbers;
  std::vector<const LabelColumn*> labels;
};
UsedColumns used_columns(const FormulaModel& model);

/// The values of these columns in a row of the table, and as words, with so many digits.
Conditions conditions_of_row(const UsedColumns& used, std::size_t row, int digits = 6);

}  // namespace wearwell::formula_model
