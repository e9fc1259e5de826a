#pragma once

#include <string>
#include <string_view>

namespace wearwell {

/// A message made safe for a terminal or a log: valid UTF-8 on one line (an indented excerpt may
/// follow: a line, a caret below it, and similar lines), control characters as \x1b, no error
/// classes of the JSON library, and long parts (a quoted value, a word, the whole message) cut,
/// with their length.
std::string shown(std::string_view message);

}  // namespace wearwell
