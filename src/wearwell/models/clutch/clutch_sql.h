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
  std::string name;  ///< as the database has it
  double scale = 1, offset = 0;
  bool is_real = false;   ///< of a unit: a number that may have a fraction, which no unit has
  std::string unit = {};  ///< of its values, as the table has them: "rpm"
};

/// Where the cycles lie.
struct SqlSource {
  std::string table;  ///< as a statement has it: quoted, or a view
  SqlColumn unit, cycle;
  std::array<SqlColumn, 4> inputs;  ///< as `inputs`; the temperature in degrees Celsius
  SqlColumn energy;
  /// When the cycle was, a day or a moment of it; or how many a day its unit makes. Empty: nothing tells.
  std::string time, per_day;
  bool is_date = false;             ///< days alone
  std::string prefix = "wearwell";  ///< of the tables that the statements make
  bool first = false;               ///< nothing was counted before: all rows are new
  /// ClickHouse has no transactions: new sums go to a temporary table until `keep`.
  bool staged = false;
  int portion = 0,
      portions = 1;  ///< of the units, by a hash: what is sorted as arrays is held in memory
};

/// Units of the fixed point, powers of two: of the sums of 64 bits and of those of 128.
struct FixedUnits {
  double energy = 1;    ///< J
  double volume = 1;    ///< m^3, of the replicates
  double fine = 1;      ///< m^3, of the volume itself
  double variance = 1;  ///< m^6
  std::array<double, 4> inputs{};
};
/// A summand is at least 2^38 units where the model is at home, so that rounding it is nothing beside
/// 1e-9 of it, and may be 2^24 times as large before 64 bits do not hold it.
FixedUnits fixed_units(const WearModel& model);

/// A fitted model as statements for the database that holds the cycles. Per unit and in the order of
/// its cycles
///
///   V = sum g(Ec) max(0, w) E,   S = sum (sigma E)^2,   V_b = sum g_b(Ec) max(0, w_b) E,
///
/// Ec the energy of the cycles before, b the replicates: as CycleSum does, in fixed point. A wear rate below 0 is
/// no wear, cycle by cycle and for each replicate by itself; so that V is not linear in the coefficients, and
/// sums of monomials would not do. settled: the same sums with g = 1, from which wear goes on at the unit's
/// own duty.
struct ClutchSql {
  std::string setup;    ///< the model's numbers as rows; tables, where they are missing
  std::string query;    ///< adds the sums of cycles that are new
  std::string combine;  ///< wear of each unit with both intervals, and what is left
  std::string totals;   ///< SELECT: the sums of each unit in SI, columns as `UnitSums` reads them
  std::string size;     ///< SELECT: units, and cycles of all
  /// SELECT: units whose rows up to the last cycle that was counted are not as many as were
  /// counted, and how many of both.
  std::string late;
  /// SELECT: unit, first and last moment (seconds since 1970), rows that have one, mean of `per_day`; what the table does not
  /// have is nothing. Empty where it has neither.
  std::string times;
  std::string keep;  ///< what is new stays; empty where a transaction does that
  /// SELECT: rows, rows without a value that can be, range of each input, largest energy, EnergyOutliers::count.
  std::string check;
  /// SELECT: of a row that has no value that can be: unit, cycle, the four inputs, energy.
  std::string invalid_row;
  /// SELECT: of the row with the most energy for its closing: unit, cycle, energy and its ratio to that of the closing.
  std::string outlier;
  /// For FixedSum. SELECT: unit, cycle and inputs in SI of all rows, in their order; the same by unit
  /// and cycle; of each unit the last cycle that was counted, and its energy so far, halves of
  /// 32 bits each; a temporary table that takes sums, and the statement that adds them to those kept.
  std::string stream, sorted, known, fresh, gather;
  /// Columns of the table of sums, as this run has them; SELECT: those of the table that is there, each with 1 where it
  /// is of the key. Of ClickHouse the table may be missing, which `exists` tells (elsewhere empty).
  std::vector<std::string> columns;
  std::string layout, exists;
  /// SELECT: another key of which sums are kept, where there are none of this: of another model (DuckDB), of the same
  /// table by other columns (servers).
  std::string others;
};
inline constexpr const char* fresh_table = "wearwell_fresh";
/// `id`: of the model, the SHA-1 of model.json. Without `replicates` there is only the interval by
/// scatter and plate. Throws InputError for names that the dialect cannot hold.
ClutchSql clutch_sql(const WearModel& model, const std::string& id, fleet::Dialect dialect,
                     const SqlSource& source, bool replicates);

}  // namespace wearwell::clutch
