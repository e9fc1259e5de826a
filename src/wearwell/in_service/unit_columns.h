#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wearwell/fleet/named_columns.h"
#include "wearwell/in_service/conditions.h"

namespace wearwell::in_service {

/// The columns of a table of units in service.
struct UnitColumns {
  std::string unit;
  fleet::UnitColumn age;
  std::string in_study;  ///< whether the study has the unit; empty: not in the table
  std::string life;      ///< which life of [predict] is meant; empty: not in the table
  struct Given {
    Condition condition;
    fleet::UnitColumn column;  ///< of a label the name alone
  };
  std::vector<Given> conditions;
  char text_decimal = 0;  ///< EngineColumn::text_decimal
};

/// From the options (--columns) and the table's own names: unit, age, in_study, life and the
/// conditions. `axis` is the unit of lives. Throws InputError.
UnitColumns read_unit_columns(const std::vector<std::string>& options,
                              const std::vector<fleet::EngineColumn>& known,
                              const std::vector<Condition>& conditions, const Unit& axis,
                              const std::string& source);

/// The column that names units.
std::string unit_name_column(const std::vector<std::string>& options);

}  // namespace wearwell::in_service
