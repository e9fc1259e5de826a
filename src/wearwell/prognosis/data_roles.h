#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/input/table.h"
#include "wearwell/input/toml_reader.h"

namespace wearwell::prognosis {

/// What the columns of a study's data are to it; headings of its table. A reading is known by whose it is and where
/// along its life it was taken.
struct DataRoles {
  struct Named {
    std::string name, column;  ///< in the study, in the table
    std::string unit = {};     ///< as the study says; may be empty
  };
  std::vector<Named> used;            ///< in the order of the study
  std::optional<std::string> unit;    ///< whose reading: a machine, a bearing
  std::optional<std::string> axis;    ///< where along its life: cycles, time
  std::vector<std::string> measured;  ///< what was read there
  std::vector<std::string> words;     ///< columns that may hold words
  std::string noun = "row";           ///< what a unit is: "machine"
  bool one = false;                   ///< all readings are of one thing: a joint

  /// Two equal rows are one reading given twice; of single tests (S-N, lives) they may be two tests.
  bool same_is_same() const { return (unit || one) && axis; }
};

/// An entry of [data.columns], which it has: "heading" or { column, unit }.
DataRoles::Named named_column(const TomlReader& columns, const std::string& name);

/// Of [data.columns] of a study that was read with this table. Throws InputError.
DataRoles data_roles(const TomlReader& root, const Table& table);

}  // namespace wearwell::prognosis
