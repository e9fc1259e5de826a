#pragma once

#include <map>
#include <stop_token>
#include <string>
#include <vector>

#include "wearwell/fleet/engine.h"
#include "wearwell/in_service/rows_read.h"
#include "wearwell/in_service/unit_columns.h"
#include "wearwell/prognosis/fleet_outlook.h"

namespace wearwell::in_service {

/// Units under the same conditions.
struct ConditionSet {
  std::string life;                          ///< the name of a life of [predict]; may be empty
  std::map<std::string, std::string> given;  ///< TOML text by condition (with_conditions)
  std::vector<double> values;                ///< SI, of those that are numbers, in their order
  std::string description;                   ///< "temperature = 40 degC, supplier = A"
  std::string first;                         ///< a unit that has them
  std::size_t units = 0;
};

/// Units in service as read; `units.group` are places in `sets`.
struct UnitRows : RowsRead {
  std::vector<std::string> names;
  prognosis::UnitsInService units;
  std::vector<ConditionSet> sets;
};

/// More sets are refused: lives are computed for each.
inline constexpr std::size_t most_condition_sets = 1000;
struct ReadUnits {
  bool skip_bad = false;      ///< leave out rows without a unit or with an impossible value
  bool all_in_study = false;  ///< UnitsInService::in_study, of all
  std::stop_token stop = {};
};

/// Adds the rows of an engine's table, in a transaction that begins here. Throws InputError for rows
/// that cannot be used (without `skip_bad`) and too many sets of conditions; Cancelled.
void add_units(fleet::Engine& engine, const UnitColumns& columns, const ReadUnits& how,
               UnitRows& rows);

/// Throws InputError that names a unit with more than one row.
void refuse_repeated_units(const UnitRows& rows, const std::string& source);

}  // namespace wearwell::in_service
