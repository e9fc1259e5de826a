#pragma once

#include <string>
#include <string_view>

namespace wearwell {

/// What a number in a spreadsheet means by its format.
enum class CellFormat { number, date, time, date_and_time, duration, percent };

/// Of the built-in formats of ECMA-376, part 1, 18.8.30, or of the code of another: "dd.mm.yyyy".
CellFormat built_in_format(int number);
CellFormat format_of_code(std::string_view code);

/// A number as the format shows it: "2024-03-01", "12:30:00", "2024-03-01 12:30:00", "37:05:00",
/// "5 %"; a number itself stays as it is. `from_1904`: days count from 1904 instead of 1900.
std::string formatted(const std::string& number, CellFormat format, bool from_1904);

/// Column and row of "AB12", from 1; 0 for what is missing.
struct CellName {
  std::size_t column = 0, row = 0;
};
/// Reads as much of the text as is a name; `rest` is what follows.
CellName read_cell_name(std::string_view text, std::string_view& rest);

/// "AB" of 28.
std::string column_letters(std::size_t column);

}  // namespace wearwell
