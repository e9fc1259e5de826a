#pragma once

#include <map>
#include <set>
#include <string>

#include "wearwell/input/toml_reader.h"
#include "wearwell/models/formula_model/formula_model.h"
#include "wearwell/models/formula_model/varied_conditions.h"

namespace wearwell::formula_model {

/// The conditions of a prediction: values of columns and labels.
struct Conditions {
  std::map<std::string, double> numbers;  ///< SI
  std::map<std::string, int> labels;      ///< index of the level
  std::string words;                      ///< "force = 20 N"
  /// Values that were not given and vary between rows: taken from a unit's last row.
  std::set<std::string> of_last_row = {};
  /// Those that differ between units; null if there are none.
  std::shared_ptr<const VariedConditions> varied = {};

  /// Whether this column has a value or a distribution.
  bool has(const std::string& column) const;
};

/// Reads predict.given or a similar table. Throws InputError.
Conditions read_conditions(const TomlReader& table, const FormulaModel& model);

/// Refuses conditions that differ between units, at `key` of `table`: `where` is what needs numbers, "predict.limit".
void refuse_varied(const Conditions& conditions, const TomlReader& table, const std::string& key,
                   const std::string& where);

/// Adds the conditions of a unit's last row, unless `given` has them.
Conditions conditions_of_unit(const FormulaModel& model, std::size_t unit, const Conditions& given);

/// Adds columns that are the same in all rows, unless `given` has them.
Conditions common_conditions(const FormulaModel& model, const Conditions& given);

/// Throws if an expression needs a condition that is neither given nor the same in all rows.
[[noreturn]] void fail_without_condition(const FormulaModel& model, const TomlReader& table,
                                         const std::string& key, const std::string& column);
[[noreturn]] void fail_without_label(const TomlReader& table, const std::string& key,
                                     const formula::LabelSymbol& label);

}  // namespace wearwell::formula_model
