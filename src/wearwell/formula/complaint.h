#pragma once

#include <cstddef>
#include <string>

namespace wearwell::formula {

/// A text of a study, and its position in the study.
struct Text {
  std::string where;  ///< "[formula] wear"
  std::string text;
};

/// Throws InputError: position, error, advice, and the text's line with a caret below byte `at`.
[[noreturn]] void complain(const Text& text, std::size_t at, const std::string& what,
                           const std::string& hint = {});

}  // namespace wearwell::formula
