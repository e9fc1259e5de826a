#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace wearwell {

/// What a cell is, and which marks its digits have, as far as the cell alone can tell. Marks are
/// '.', ',', '\'' and ' ' (blanks that do not break, narrow ones and typographic apostrophes count
/// as these), 0 for none. "35.000" is 35 to three decimals or 35000: its point is `doubtful`.
struct NumberForm {
  enum class Kind { empty, number, text } kind = Kind::text;
  char decimal = 0, thousands = 0;
  char doubtful = 0;  ///< the one mark, where it may be either
};
NumberForm number_form(std::string_view cell);

/// The marks in the numbers of a column.
struct NumberMarks {
  char decimal = '.';    ///< '.' or ','
  char thousands = '*';  ///< the only one there may be, 0 for none; '*': any but the decimal mark
};

/// The cell as C has numbers, "1234.5" of "1.234,5"; nothing where it is no number with these
/// marks.
std::optional<std::string> plain_number(std::string_view cell, const NumberMarks& marks);

/// "decimal comma": how a mark is called.
std::string mark_name(char mark);

/// "'35.000' can mean 35 or, with a mark for thousands, 35000; ...": why a cell is refused.
std::string two_readings(std::string_view cell);

/// "'1,234' is not a number; it may mean 1234 or 1.234 ...", with what it may mean, if anything.
std::string not_a_number(std::string_view cell);

}  // namespace wearwell
