#pragma once

#include <string>
#include <vector>

#include "wearwell/input/table.h"
#include "wearwell/prognosis/data_roles.h"

namespace wearwell::prognosis {

/// New rows in the columns, the units and the format of a study's table.
struct MatchedRows {
  Table table;                     ///< columns as those of the study's table, in its order
  std::vector<bool> given;         ///< which of them the new rows have
  std::vector<std::string> notes;  ///< notes: columns left out or converted
};

/// Columns are found by their heading, or by their name with another unit, which is converted.
/// `like` takes the form that holds both: a numeric column becomes text if new labels are text.
/// `needed`: headings that new rows must have. Throws InputError: a column that is missing or
/// occurs twice, a unit that is missing or of another dimension, a cell that is not a number.
MatchedRows matched_rows(const Table& fresh, const DataRoles& roles,
                         const std::vector<std::string>& needed, Table& like);

}  // namespace wearwell::prognosis
