#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/input/table.h"
#include "wearwell/input/toml_reader.h"

namespace wearwell::prognosis {

/// The roles of the columns of a study's data, and the headings of its table. A reading is
/// identified by its unit and its position on the axis of life.
struct DataRoles {
  struct Named {
    std::string name, column;  ///< in the study, in the table
    std::string unit = {};     ///< as in the study; may be empty
  };
  std::vector<Named> used;            ///< in the order of the study
  std::optional<std::string> unit;    ///< the unit of a reading: a machine, a bearing
  std::optional<std::string> axis;    ///< position on the axis of life: cycles, time
  std::vector<std::string> measured;  ///< the measured value
  std::vector<std::string> words;     ///< columns that may hold text
  std::string noun = "row";           ///< noun for a unit: "machine"
  bool one = false;                   ///< all readings are of one unit: a joint

  /// Two equal rows are one reading given twice; of single tests (S-N, lives) they may be two
  /// tests.
  bool same_is_same() const { return (unit || one) && axis; }
};

/// An entry of [data.columns] that exists: "heading" or { column, unit }.
DataRoles::Named named_column(const TomlReader& columns, const std::string& name);

/// From [data.columns] of a study that was read with this table. Throws InputError.
DataRoles data_roles(const TomlReader& root, const Table& table);

}  // namespace wearwell::prognosis
