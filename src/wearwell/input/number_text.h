#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace wearwell {

/// The kind of a cell and the marks in its digits, judged from the cell alone. Marks are '.', ',',
/// '\'' and ' ' (including no-break and narrow spaces and typographic apostrophes), 0 for none.
/// "35.000" is either 35 with three decimals or 35000, so its point is `doubtful`.
struct NumberForm {
  enum class Kind { empty, number, text } kind = Kind::text;
  char decimal = 0, thousands = 0;
  char doubtful = 0;  ///< the only mark, if it is ambiguous
};
NumberForm number_form(std::string_view cell);

/// The marks in the numbers of a column.
struct NumberMarks {
  char decimal = '.';    ///< '.' or ','
  char thousands = '*';  ///< the only separator allowed, 0 for none; '*': any except the decimal
                         ///< mark
};

/// The cell in C format, "1234.5" for "1.234,5"; empty if it is not a number with these marks.
std::optional<std::string> plain_number(std::string_view cell, const NumberMarks& marks);

/// The name of a mark, as in "decimal comma".
std::string mark_name(char mark);

/// Why a cell is refused: "'35.000' can mean 35 or, with a thousands separator, 35000; ...".
std::string two_readings(std::string_view cell);

/// "'1,234' is not a number; it may mean 1234 or 1.234 ...", with its possible readings, if any.
std::string not_a_number(std::string_view cell);

}  // namespace wearwell
