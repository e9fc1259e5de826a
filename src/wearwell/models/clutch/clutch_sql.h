#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "wearwell/fleet/dialect.h"
#include "wearwell/models/clutch/wear_model.h"

namespace wearwell::clutch {

/// A column of a database's table in SI: offset + scale * value.
struct SqlColumn {
  std::string name;  ///< name in the database
  double scale = 1, offset = 0;
  bool is_real = false;         ///< of a unit: a number that may have a fraction, which is invalid
  std::string unit = {};        ///< unit of its values in the table: "rpm"
  bool unit_by_option = false;  ///< the unit is stated by --columns alone, not by its heading
};

/// The table of cycles.
struct SqlSource {
  std::string table;  ///< as a statement has it: quoted, or a view
  SqlColumn unit, cycle;
  std::array<SqlColumn, 4> inputs;  ///< as `inputs`; the temperature in degrees Celsius
  SqlColumn energy;
  /// The time of a cycle, a date or a timestamp; or the cycles per day of its unit. Empty: unknown.
  std::string time, per_day;
  bool is_date = false;             ///< dates without time
  std::string prefix = "wearwell";  ///< of the tables that the statements create
  bool first = false;               ///< nothing was counted before: all rows are new
  /// The parameters are literals of the query, not rows of a table.
  bool inlined = false;
  /// No table is created: `totals` contains the whole query. Implies `first` and `inlined`.
  bool read_only = false;
  /// Rows that cannot be summed are left out, in place of an error.
  bool skip_invalid = false;
  /// If all columns are text (a CSV file with invalid cells, in DuckDB): the decimal mark of its
  /// numbers. 0: the columns have types.
  char text_decimal = 0;
  /// ClickHouse has no transactions: new sums go to a temporary table until `keep`.
  bool staged = false;
  int portion = 0,
      portions = 1;  ///< shards of the units, by a hash: bounds the memory for sorted arrays
};

/// Units of the fixed point, powers of two: of the 64-bit sums and of the 128-bit sums.
struct FixedUnits {
  double energy = 1;    ///< J
  double volume = 1;    ///< m^3, of the replicates
  double fine = 1;      ///< m^3, of the volume itself
  double variance = 1;  ///< m^6
  std::array<double, 4> inputs{};
};
/// Within the calibrated range a summand is at least 2^38 units, so that its rounding is negligible
/// beside 1e-9 of it, and it may be 2^24 times as large before it overflows 64 bits.
FixedUnits fixed_units(const WearModel& model);

/// A fitted model as statements for the database of the cycles. Per unit and in the order of its
/// cycles
///
///   V = sum g(Ec) max(0, w) E,   S = sum (sigma E)^2,   V_b = sum g_b(Ec) max(0, w_b) E,
///
/// where Ec is the energy of the previous cycles, and b the replicates: as CycleSum does, in fixed
/// point. A wear rate below 0 counts as no wear, cycle by cycle and for each replicate separately;
/// so V is not linear in the coefficients, and sums of monomials are not sufficient. settled: the
/// same sums with g = 1, from which wear continues at the unit's own duty.
struct ClutchSql {
  std::string setup;    ///< the model's parameters as rows; tables, if they are missing
  std::string query;    ///< adds the sums of new cycles
  std::string combine;  ///< wear of each unit with both intervals, and its remaining life
  std::string totals;   ///< SELECT: the sums of each unit in SI, columns as `UnitSums` reads them
  std::string size;     ///< SELECT: units, and cycles of all
  /// SELECT: units whose number of rows up to the last counted cycle differs from the counted
  /// number, with both numbers.
  std::string late;
  /// SELECT: unit, first and last time (seconds since 1970), rows with a time, mean of `per_day`;
  /// null for what the table does not have. Empty if it has neither.
  std::string times;
  std::string keep;  ///< commits new sums; empty where a transaction does
  /// SELECT: rows, rows with invalid values, range of each input, largest energy,
  /// EnergyOutliers::count.
  std::string check;
  /// SELECT: a row with invalid values: unit, cycle, the four inputs, energy.
  std::string invalid_row;
  /// SELECTs of rows that cannot be summed, by the first reason (LeftOut::Reason): reason, rows,
  /// units; the first rows with unit, reason, cycle, the four inputs, energy; unit and its rows.
  std::string left_out, left_out_rows, left_out_units;
  /// SELECT: the row with the highest energy relative to its closing: unit, cycle, energy and the
  /// ratio.
  std::string outlier;
  /// For FixedSum. SELECT: unit, cycle and inputs in SI of all rows, in their order; the same by
  /// unit and cycle; for each unit the last counted cycle, and its energy so far, in halves of 32
  /// bits each; a temporary table for new sums, and the statement that adds them to the stored
  /// ones.
  std::string stream, sorted, known, fresh, gather;
  /// Columns of the table of sums in this run; SELECT: those of the existing table, each with 1 if
  /// it is part of the key. In ClickHouse the table may be missing, which `exists` tells (elsewhere
  /// empty).
  std::vector<std::string> columns;
  std::string layout, exists;
  /// SELECT: another key with stored sums, if there are none of this key: of another model
  /// (DuckDB), of the same table by other columns (servers).
  std::string others;
};
inline constexpr const char* fresh_table = "wearwell_fresh";
/// `id`: of the model, the SHA-1 of model.json. Without `replicates` there is only the interval by
/// scatter and plate. Throws InputError for names that the dialect does not support.
ClutchSql clutch_sql(const WearModel& model, const std::string& id, fleet::Dialect dialect,
                     const SqlSource& source, bool replicates);

}  // namespace wearwell::clutch
