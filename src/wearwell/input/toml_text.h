#pragma once

#include <string>
#include <string_view>

namespace wearwell {

// What is looked at in the text of a study beside the parser.

/// Refuses a dotted key of very many parts: toml++ goes down a call for each, and the stack cannot
/// hold many thousands. Throws InputError; `name` is the file's.
void refuse_long_keys(const std::string& text, const std::string& name);

/// What is most often wrong with a line (counted from 1) that is no TOML, in words of a study: a
/// decimal comma, a unit or a word without quotes. Empty where it is something else.
std::string common_slip(std::string_view text, std::size_t line);

/// What toml++ found, in words of a study.
std::string in_our_words(std::string_view description);

}  // namespace wearwell
