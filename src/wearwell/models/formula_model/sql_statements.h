#pragma once

#include <string>
#include <utility>
#include <vector>

#include "wearwell/base/unit.h"
#include "wearwell/models/formula_model/formula_sql.h"
#include "wearwell/models/formula_model/sql_export.h"

namespace wearwell::formula_model {

/// A column of the table that a value depends on: a number with its unit, or a label with its
/// possible texts (empty: any).
struct SqlInput {
  std::string name, column;  ///< within statements ("formula_x0"); in the table
  Unit unit;
  bool is_label = false;
  std::vector<std::string> levels = {};
};

/// Assembles the statements of a formula.
struct SqlStatements {
  struct Draw {
    std::string unit;
    std::size_t number = 0;
    std::vector<double> numbers;
  };

  const FormulaSql& sql;
  const SqlExportChoice& choice;
  const std::vector<SqlInput>& inputs;
  std::string unit_column;  ///< empty if no unit has its own draws
  std::vector<std::pair<std::string, std::string>>
      numbers;  ///< columns of draws, and their meaning
  std::vector<Draw> draws;
  Unit answer;
  bool random_effects = false;

  std::string setup() const;
  std::string query() const;

 private:
  bool clickhouse() const { return choice.dialect == fleet::Dialect::clickhouse; }
  std::string rows() const;
  std::string draws_table() const;
  std::vector<std::string> kept() const;
  std::string row_columns() const;
  std::string steps(std::string from) const;
  std::string by_lateral() const;
  std::string by_arrays() const;
  std::string answer_of(const std::string& sorted, double p) const;
};

}  // namespace wearwell::formula_model
