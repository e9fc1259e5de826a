#pragma once

#include <string>
#include <vector>

#include "wearwell/models/clutch/clutch_sql.h"
#include "wearwell/models/clutch/sql_parameters.h"

namespace wearwell::clutch {

/// Expressions of a SELECT with their names, one line each.
class SqlColumns {
 public:
  void add(const std::string& expression, const std::string& name) {
    list_.push_back(expression + " as " + name);
  }
  void keep(const std::string& name) { list_.push_back(name); }
  std::string text() const;

 private:
  std::vector<std::string> list_;
};

inline constexpr const char* input_columns[] = {"slip_speed", "torque", "temperature",
                                                "closing_time"};

/// The counts of each unit.
inline constexpr const char* count_names[] = {"cycles",
                                              "refused",
                                              "repeated",
                                              "outside_slip_speed",
                                              "outside_torque",
                                              "outside_temperature",
                                              "outside_closing_time",
                                              "outside_any",
                                              "negative"};

/// Writes the statements of one model. A query is nested SELECTs, from the rows outward: every
/// level adds columns to those of the level within.
class SqlWriter {
 public:
  SqlWriter(const WearModel& model, const std::string& id, fleet::Dialect dialect,
            const SqlSource& source, bool replicates);

  std::string setup() const;
  std::string query() const;
  std::string combine() const;
  std::string totals() const;
  std::string size() const;
  std::string late() const;
  std::string times() const;
  std::string keep() const;
  std::string check() const;
  std::string invalid_row() const;
  std::string left_out() const;
  std::string left_out_rows() const;
  std::string left_out_units() const;
  std::string outlier() const;
  std::string stream() const;
  std::string known() const;
  std::string fresh() const;
  std::string gather() const;
  std::vector<std::string> sums_columns() const;
  std::string layout() const;
  std::string exists() const;
  std::string others() const;

 private:
  std::string k(std::size_t replicate, const std::string& name) const {
    return (source_.inlined ? "" : "k.") + parameters_.column(replicate, name);
  }
  bool clickhouse() const { return dialect_ == fleet::Dialect::clickhouse; }
  std::string count_if(const std::string& condition) const;
  /// Of accepted rows; for others these are null, which meets no condition.
  std::string counted(const std::string& condition) const {
    return clickhouse() ? "valid = 1 and (" + condition + ")" : condition;
  }
  /// PostgreSQL would inline expressions, and compute them as often as they are used.
  const char* fence() const { return dialect_ == fleet::Dialect::postgresql ? "\noffset 0" : ""; }
  std::vector<std::string> sum_names() const;
  std::string kept_names() const;
  std::string adding() const;
  std::string parameters() const;
  /// " cross join" with the parameters, and their columns; empty if they are literals.
  std::string with_parameters() const;
  const char* parameter_columns() const { return source_.inlined ? "" : " k.*,"; }
  /// Sums of all units by one SELECT.
  std::string sums() const;
  /// A column of numbers; null for a text that is not a number.
  std::string cell(const std::string& column) const;
  /// Conditions on cycle, inputs and energy, in this order.
  std::vector<std::string> conditions() const;
  std::string reasons() const;
  std::string in_si(const SqlColumn& column) const;
  std::string unit() const;
  std::string valid() const;
  std::string refused() const;
  std::string sigma() const;
  std::string si(bool fresh) const;
  std::string checked() const;
  std::string ordered() const;
  std::string ordered_by_arrays() const;
  std::string setup_of_clickhouse(const std::string& rows) const;
  /// All sums of the model: stored and new.
  std::string known_sums() const;
  std::string fresh_of_clickhouse(const std::string& rows) const;
  std::string powers() const;
  std::string rates() const;
  std::string worn() const;
  std::string run_in(std::size_t replicate, const std::string& energy) const;
  std::string unit_sums() const;
  std::string wear() const;
  std::string future(std::size_t replicate, const std::string& volume, const std::string& settled,
                     const std::string& cycles) const;

  const WearModel& model_;
  fleet::Dialect dialect_;
  const SqlSource& source_;
  std::string table_key_;  ///< prefix of the keys of sums of this table; empty for DuckDB
  std::string id_;         ///< the key of this run's sums, as a literal
  SqlParameters parameters_;
  FixedUnits units_;
  fleet::Types types_;
  std::size_t replicates_;
  std::string model_table_, sums_table_, fresh_table_;
};

}  // namespace wearwell::clutch
