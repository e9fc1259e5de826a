#pragma once

#include <string>
#include <string_view>

namespace wearwell {

/// The kind of a number in a spreadsheet, from its format.
enum class CellFormat { number, date, time, date_and_time, duration, percent };

/// The kind of a built-in format (ECMA-376, part 1, 18.8.30), or of a format code such as
/// "dd.mm.yyyy".
CellFormat built_in_format(int number);
CellFormat format_of_code(std::string_view code);

/// A number in its format: "2024-03-01", "12:30:00", "2024-03-01 12:30:00", "37:05:00", "5 %";
/// plain numbers are unchanged. `from_1904`: days count from 1904 instead of 1900.
std::string formatted(const std::string& number, CellFormat format, bool from_1904);

/// Column and row of "AB12", from 1; 0 for a missing part.
struct CellName {
  std::size_t column = 0, row = 0;
};
/// Reads the leading cell name of the text; `rest` is the remainder.
CellName read_cell_name(std::string_view text, std::string_view& rest);

/// "AB" for 28.
std::string column_letters(std::size_t column);

}  // namespace wearwell
