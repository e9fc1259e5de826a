#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace wearwell {

/// How the bytes of a text are read.
enum class Encoding { utf8, utf16_le, utf16_be, cp1252 };

/// What a study says of how a table is written (docs/reference/tables.md); the rest is found out.
struct TableSettings {
  std::optional<char> decimal = {};    ///< '.' or ','
  std::optional<char> thousands = {};  ///< '.', ',', '\'', ' '; 0: there are none
  std::optional<char> delimiter = {};
  std::optional<Encoding> encoding = {};
  std::optional<std::size_t> header_row = {};  ///< line of a text, row of a sheet, from 1
  std::optional<bool> units_row = {};          ///< units stand in the row below the headings
  std::optional<bool> summary_rows = {};    ///< the last rows are means and sums: left out, or data
  std::optional<bool> hidden_rows = {};     ///< of a sheet: read, or left out
  std::optional<std::string> comment = {};  ///< lines that begin so are left out
  std::optional<std::string> sheet = {};    ///< of a workbook: its name, or its number from 1
  std::optional<std::string> range = {};    ///< of a sheet: "B3:F20"

  bool operator==(const TableSettings&) const = default;
};

}  // namespace wearwell
