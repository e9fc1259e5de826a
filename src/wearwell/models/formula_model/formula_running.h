#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/formula/program.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/models/formula_model/formula_conditions.h"

namespace wearwell::formula_model {

/// How a path that depends on earlier rows (cum, a state) continues under fixed conditions: from a
/// unit's last row, or from the start of a new unit. There are no future rows, so one long step
/// replaces all of them. A state needs no more; a running sum needs the contribution of a future
/// row. Either it is proportional to the step of the axis (a column of the data that is that step
/// in all rows), or rows are as evenly spaced as those of the data.
struct RunningPath {
  formula::Running running;
  std::size_t axis = 0;            ///< among the columns of the symbols
  std::vector<double> numbers;     ///< conditions by column, SI; NaN if irrelevant
  std::vector<int> labels;         ///< by label
  std::vector<std::size_t> steps;  ///< future columns that hold the distance from `begin`
  double row_length = 0;           ///< of a future row, along the axis; 0 if irrelevant
  double begin = 0;                ///< start or continuation point, SI
  /// The rows of the unit so far; null for a new one.
  std::unique_ptr<const formula::Data> history;

  /// Binds `count` future rows at these positions, each a path of its own.
  void bind(const formula::Program& program, std::size_t count, const double* place,
            formula::Data& data) const;
};

/// `program` was compiled with the symbols of rows, with running values; `unit` is the one that
/// continues, empty for a new one. Throws InputError at `key` of `table` if the continuation is
/// undetermined.
RunningPath continue_path(const FormulaModel& model, const TomlReader& table,
                          const std::string& key, const formula::Program& program,
                          const Conditions& conditions, std::optional<std::size_t> unit);

}  // namespace wearwell::formula_model
