#pragma once

#include <string>
#include <string_view>

namespace wearwell {

/// A message as a terminal or a log may show it: valid UTF-8 on one line
/// (behind it an excerpt may stand: a line, a caret below it, and lines like them, all indented), control characters as
/// \x1b, without the classes of errors of the JSON library, and what is longer than a person reads
/// (a value in quotes, a word, the whole) cut, with its length in its place.
std::string shown(std::string_view message);

}  // namespace wearwell
