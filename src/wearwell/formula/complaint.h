#pragma once

#include <cstddef>
#include <string>

namespace wearwell::formula {

/// A text that was written in a study, and where it stands there.
struct Text {
  std::string where;  ///< "[formula] wear"
  std::string text;
};

/// Throws InputError: where, what is wrong, what to do about it, and the text's line with a caret
/// below byte `at`.
[[noreturn]] void complain(const Text& text, std::size_t at, const std::string& what,
                           const std::string& hint = {});

}  // namespace wearwell::formula
