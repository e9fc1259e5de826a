#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/input/table.h"
#include "wearwell/selection/result.h"

namespace wearwell {

/// The request for a selection, as on the command line.
struct SelectData {
  std::filesystem::path file;
  std::optional<std::string> sql;
  std::string response;
  std::vector<std::string> inputs;  ///< with `degree`: all their products; or
  std::optional<int> degree;
  std::vector<std::string> terms;   ///< columns and products of columns, as "ds*ds*Td"
  std::string weights;              ///< column; empty without weights
  std::vector<std::string> forced;  ///< names of terms
};

/// The table's rows and the candidate terms: fills data, response, inputs, design, weights and
/// settings.search.forced. Throws InputError that names the option, the column or the row.
SelectionResult read_selection(const SelectData& data);
/// The same for a table in memory: `file` and `sql` are ignored.
SelectionResult read_selection(const SelectData& data, const Table& table);

}  // namespace wearwell
