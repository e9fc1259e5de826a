#pragma once

#include <string>
#include <vector>

#include "wearwell/fleet/dialect.h"
#include "wearwell/formula/dimension.h"
#include "wearwell/models/formula_model/node_program.h"
#include "wearwell/prognosis/carried_state.h"

namespace wearwell::formula_model {

/// The request for a fitted formula model as SQL.
struct SqlExportChoice {
  fleet::Dialect dialect = fleet::Dialect::duckdb;
  std::string table = {};           ///< as fleet::table_identifier reads it
  std::string prefix = "wearwell";  ///< name of the table of draws
  std::vector<std::string> columns =
      {};  ///< "force=F:kN", if the table's names differ from the study's
  std::vector<std::string> keep = {};  ///< further columns of the table to include in the answer
  std::string value =
      /// an expression of the formula; empty: the location parameter of the first measured column
      {};
  std::string unit = {};    ///< of the answer; empty: that of the measured column, or the SI unit
  std::size_t draws = 400;  ///< a multiple of 20
};

/// For every row of a table the value of an expression, as quantiles over draws from the posterior,
/// without measurement scatter. With random effects a unit of the study has its own draws, given
/// its readings, and every other unit those of a new one.
struct SqlExport {
  std::string setup;  ///< draws as rows; may be run again
  /// SELECT: the kept columns, formula_known if units vary (1: a unit of the study), formula_q05, formula_q50,
  /// formula_q95; null (NaN in ClickHouse) if a row has no value.
  std::string query;
  std::string expression;  ///< the expression as parsed
  std::string unit;        ///< of the answer
  formula::Wanted wanted;
  std::vector<std::string> units;  ///< with their own draws: "" is a new one
  std::vector<Nodes> draws;        ///< of each; with equal weights
};

/// Quantiles at 5, 50 and 95 % over n draws, n a multiple of 20: the mean of the two neighbouring
/// order statistics. `sorted` ascending.
double quantile_of_draws(const std::vector<double>& sorted, double p);

/// Throws InputError for names, units, and expressions that are invalid or not available in SQL of
/// that engine.
SqlExport sql_export(const prognosis::CarriedState& state, const SqlExportChoice& choice);

}  // namespace wearwell::formula_model
