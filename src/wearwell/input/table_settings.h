#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace wearwell {

/// The encoding of a text file.
enum class Encoding { utf8, utf16_le, utf16_be, cp1252 };

/// The layout of a table as stated by the study (docs/reference/tables.md); the rest is detected.
struct TableSettings {
  std::optional<char> decimal = {};    ///< '.' or ','
  std::optional<char> thousands = {};  ///< '.', ',', '\'', ' '; 0: none
  std::optional<char> delimiter = {};
  std::optional<Encoding> encoding = {};
  std::optional<std::size_t> header_row = {};  ///< line of a text, row of a sheet, from 1
  std::optional<bool> units_row = {};          ///< units stand in the row below the headings
  std::optional<bool> summary_rows = {};       ///< whether the last rows are means and sums, to be
                                               ///< omitted
  std::optional<bool> hidden_rows = {};        ///< whether hidden rows of a sheet are read
  std::optional<std::string> comment = {};     ///< lines with this prefix are omitted
  std::optional<std::string> sheet = {};       ///< of a workbook: its name, or its number from 1
  std::optional<std::string> range = {};       ///< of a sheet: "B3:F20"

  bool operator==(const TableSettings&) const = default;
};

}  // namespace wearwell
