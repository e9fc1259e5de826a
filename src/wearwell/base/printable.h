#pragma once

#include <string>
#include <string_view>

namespace wearwell {

/// Makes text from a file safe for a terminal: it cannot move the cursor, set colors, rename the
/// window or reverse the order of letters. Control characters (C0, C1, DEL), line and paragraph
/// separators and marks of direction are written as "\x1b" or "\u202e", invalid UTF-8 bytes as
/// "\xff". For one line: line feeds and tabs are control characters too, unless listed in `kept`.
std::string printable(std::string_view text, std::string_view kept = "");

/// The same for many lines; keeps line feeds.
std::string printable_lines(std::string_view text);

/// JSON with these characters in texts escaped as "\u001b" and "\u202e"; it reads back unchanged.
std::string printable_json(std::string_view json);

/// Replaces every invalid UTF-8 byte by U+FFFD, because file names are bytes but JSON needs text.
std::string valid_utf8(std::string_view text);

/// At most `most` bytes, cut between characters, with "..." for the rest; for quoting values in
/// messages.
std::string shortened(std::string_view text, std::size_t most = 60);

}  // namespace wearwell
