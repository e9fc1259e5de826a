#pragma once

#include <string>
#include <string_view>

#include "wearwell/input/table.h"

namespace wearwell {

/// Whether a text is a unit of the dimension of `si`; of any where that is empty.
bool is_unit_of(const std::string& text, std::string_view si);

/// The unit that a column states in its heading or in a row of units, whatever its dimension; empty where it states none.
std::string stated_unit(const Column& column);

/// What stands in the last brackets of a heading.
std::string bracketed(const std::string& heading);

/// The name of a heading and its unit, as far as that is of the dimension of `si` (of any where it is empty);
/// words may stand behind brackets, and a unit behind a blank alone. "C" and "F" are degrees where `si` is "K".
struct NameAndUnit {
  std::string name, unit;
  bool letter = false;  ///< the unit is a letter that stands for degrees: a guess
};
NameAndUnit name_and_unit(const Column& column, std::string_view si);

/// The unit of a count with the million or thousand that the heading says: "1e6 cycles" of "Mio. cycles".
std::string with_multiple(const std::string& heading, const std::string& unit);

/// Whether a heading has the word, as a word; long ones also within others, as languages put words together. Accents
/// and capital letters do not matter.
bool is_called(const std::string& heading, std::string_view word);
/// Whether it is that word and nothing else.
bool is_exactly(const std::string& heading, std::string_view word);

/// In small letters without accents, one blank for whatever else there is, and one at either end.
std::string plain_words(std::string_view text);

}  // namespace wearwell
