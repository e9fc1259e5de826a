#pragma once

#include <string>
#include <string_view>

#include "wearwell/input/table.h"

namespace wearwell {

/// Whether a text is a unit of the dimension of `si`; any dimension if `si` is empty.
bool is_unit_of(const std::string& text, std::string_view si);

/// The unit that a column states in its heading or in a row of units, of any dimension; empty if
/// none.
std::string stated_unit(const Column& column);

/// The text in the last brackets of a heading.
std::string bracketed(const std::string& heading);

/// A heading split into name and unit. The unit must have the dimension of `si` (any if empty).
/// Words may follow the brackets, and a unit may follow a space without brackets. "C" and "F" are
/// degrees if `si` is "K".
struct NameAndUnit {
  std::string name, unit;
  bool letter = false;  ///< the unit is the letter C or F, read as degrees: a guess
};
NameAndUnit name_and_unit(const Column& column, std::string_view si);

/// The unit with the factor that its heading states; `word` of the heading names the quantity or the
/// unit: "1e6 cycles" for "Mio. cycles", "1e3 h" for "khours", "thousand hours" and "1000 hours".
std::string with_multiple(const std::string& heading, const std::string& unit,
                          std::string_view word);

/// Whether a heading contains the word; long words also match inside compounds, as in German.
/// Ignores accents and case.
bool is_called(const std::string& heading, std::string_view word);
/// Whether the heading is exactly this word.
bool is_exactly(const std::string& heading, std::string_view word);

/// Lower case without accents; every run of other characters becomes one space, with a space at
/// either end.
std::string plain_words(std::string_view text);

}  // namespace wearwell
