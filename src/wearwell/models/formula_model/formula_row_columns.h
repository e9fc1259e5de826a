#pragma once

#include <vector>

#include "wearwell/models/formula_model/formula_model.h"

namespace wearwell::formula_model {

/// Columns and labels of some rows of the table, kept while a program binds them.
struct RowColumns {
  std::vector<std::vector<double>> numbers;
  std::vector<std::vector<int>> labels;
  formula::Rows rows;

  RowColumns(const FormulaModel& model, const std::vector<std::size_t>& which,
             const formula::Program& program) {
    rows.count = which.size();
    for (std::size_t c = 0; c < model.row_symbols.columns.size(); ++c) {
      numbers.emplace_back();
      if (!program.uses_column(c)) continue;
      const NumberColumn* column = model.data.number(model.row_symbols.columns[c].name);
      for (const std::size_t row : which) numbers.back().push_back(column->values[row]);
    }
    for (std::size_t c = 0; c < model.row_symbols.labels.size(); ++c) {
      labels.emplace_back();
      if (!program.uses_label(c)) continue;
      const LabelColumn* column = model.data.label(model.row_symbols.labels[c].name);
      for (const std::size_t row : which) labels.back().push_back(column->at[row]);
    }
    for (const auto& each : numbers) rows.columns.emplace_back(each);
    for (const auto& each : labels) rows.labels.emplace_back(each);
  }
};

}  // namespace wearwell::formula_model
