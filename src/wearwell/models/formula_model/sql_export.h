#pragma once

#include <string>
#include <vector>

#include "wearwell/fleet/dialect.h"
#include "wearwell/formula/dimension.h"
#include "wearwell/models/formula_model/node_program.h"
#include "wearwell/prognosis/carried_state.h"

namespace wearwell::formula_model {

/// What is asked for of a fitted law as SQL.
struct SqlExportChoice {
  fleet::Dialect dialect = fleet::Dialect::duckdb;
  std::string table = {};           ///< as fleet::table_identifier reads it
  std::string prefix = "wearwell";  ///< of the table that the set-up makes
  std::vector<std::string> columns =
      {};  ///< "force=F:kN", where the table calls them otherwise than the study's
  std::vector<std::string> keep = {};  ///< further columns of the table, for the answer
  std::string value =
      {};  ///< an expression of the law; empty: the place of the first measured column
  std::string unit = {};    ///< of the answer; empty: that of the measured column, or the SI's
  std::size_t draws = 400;  ///< a multiple of 20
};

/// For every row of a table the value of an expression of the law, as quantiles over draws from the posterior; without the scatter
/// of readings. Where units differ, a unit that the study has seen has draws of its own, given its readings, and every other
/// those of a new one.
struct SqlExport {
  std::string setup;  ///< draws as rows; may be run again
  /// SELECT: the columns that are kept, formula_known where units differ (1: a unit of the study), formula_q05, formula_q50, formula_q95; nothing (NaN in
  /// ClickHouse) where a row has no value.
  std::string query;
  std::string expression;  ///< as it was understood
  std::string unit;        ///< of the answer
  formula::Wanted wanted;
  std::vector<std::string> units;  ///< with draws of their own: "" is a new one
  std::vector<Nodes> draws;        ///< of each; all of one weight
};

/// Quantiles at 5, 50 and 95 % over n draws, n a multiple of 20: the mean of the two order statistics about it. `sorted` ascending.
double quantile_of_draws(const std::vector<double>& sorted, double p);

/// Throws InputError: names, units, an expression that is wrong or no SQL of that engine.
SqlExport sql_export(const prognosis::CarriedState& state, const SqlExportChoice& choice);

}  // namespace wearwell::formula_model
