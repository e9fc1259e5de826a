#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/formula/program.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/models/formula_model/formula_conditions.h"

namespace wearwell::formula_model {

/// How a path that depends on rows before its own (cum, a state) goes on under fixed conditions: from
/// where a unit stands after its last row, or from the beginning of a new one. Rows ahead are not there,
/// so one long step stands for all of them: a state needs no more; a running sum needs to know what a
/// row ahead adds. Either it is in proportion to the step of the axis (a column of the data that is that
/// step in all rows), or rows lie as evenly as those of the data.
struct RunningPath {
  formula::Running running;
  std::size_t axis = 0;            ///< among the columns of the symbols
  std::vector<double> numbers;     ///< conditions by column, SI; NaN of those that do not matter
  std::vector<int> labels;         ///< by label
  std::vector<std::size_t> steps;  ///< columns that are, ahead, the way from `begin` to the place
  double row_length = 0;           ///< of a row ahead, along the axis; 0 where that does not matter
  double begin = 0;                ///< where it begins or goes on, SI
  /// The rows of the unit so far; null of a new one.
  std::unique_ptr<const formula::Data> history;

  /// Binds `count` rows ahead at these places, each a path of its own.
  void bind(const formula::Program& program, std::size_t count, const double* place,
            formula::Data& data) const;
};

/// `program` was compiled with the symbols of rows, to be continued; `unit` is the one that goes on, none
/// of a new one. Throws InputError at `key` of `table` where what lies ahead cannot be told.
RunningPath continue_path(const FormulaModel& model, const TomlReader& table,
                          const std::string& key, const formula::Program& program,
                          const Conditions& conditions, std::optional<std::size_t> unit);

}  // namespace wearwell::formula_model
