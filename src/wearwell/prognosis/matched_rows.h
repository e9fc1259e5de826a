#pragma once

#include <string>
#include <vector>

#include "wearwell/input/table.h"
#include "wearwell/prognosis/data_roles.h"

namespace wearwell::prognosis {

/// New rows in the columns, the units and the way of writing of a study's table.
struct MatchedRows {
  Table table;                     ///< columns as those of the study's table, in its order
  std::vector<bool> given;         ///< which of them the new rows bring
  std::vector<std::string> notes;  ///< what else to know: columns left out, converted
};

/// Columns are found by their heading, or by their name with another unit, which is converted. `like` takes the form
/// that holds both: a column of numbers becomes one of words where new names are words. `needed`: headings that new
/// rows must have. Throws InputError: a column that is missing or there twice, a unit that is missing or of another
/// dimension, a cell that is no number.
MatchedRows matched_rows(const Table& fresh, const DataRoles& roles,
                         const std::vector<std::string>& needed, Table& like);

}  // namespace wearwell::prognosis
