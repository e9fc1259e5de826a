#pragma once

#include <string>
#include <string_view>

namespace wearwell {

/// Text from a file as a terminal may show it: nothing in it moves the cursor, colours, renames the
/// window or turns the order of letters round. Control characters (C0, C1, DEL), line and paragraph
/// separators and marks of direction are written as "\x1b" or "\u202e", bytes that are no UTF-8 as
/// "\xff". Of one line: line feeds and tabs are controls too, unless they are among `kept`.
std::string printable(std::string_view text, std::string_view kept = "");

/// The same of many lines, which stay.
std::string printable_lines(std::string_view text);

/// JSON whose texts hold the same characters as "\u001b" and "\u202e": it reads back as it was.
std::string printable_json(std::string_view json);

/// Text with U+FFFD for every byte that is not UTF-8: names of files are bytes, JSON wants text.
std::string valid_utf8(std::string_view text);

/// At most `most` bytes of it, cut between characters and with "..." for the rest: what a message
/// quotes of a value.
std::string shortened(std::string_view text, std::size_t most = 60);

}  // namespace wearwell
