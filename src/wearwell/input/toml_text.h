#pragma once

#include <string>
#include <string_view>

namespace wearwell {

// Checks of a study's text in addition to the parser's.

/// Refuses a dotted key with very many parts, because toml++ recurses for each part and thousands
/// overflow the stack. Throws InputError; `name` is the name of the file.
void refuse_long_keys(const std::string& text, const std::string& name);

/// Describes the most common errors of a line (from 1) that is not TOML: a decimal comma, a unit or
/// a word without quotes. Empty for other errors.
std::string common_slip(std::string_view text, std::size_t line);

/// An error of toml++ in terms of a study.
std::string in_our_words(std::string_view description);

}  // namespace wearwell
