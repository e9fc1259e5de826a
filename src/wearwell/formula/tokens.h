#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "wearwell/formula/complaint.h"

namespace wearwell::formula {

/// A token of an expression.
struct Token {
  enum Kind : unsigned char { number, name, quotation, unit, sign, end };
  Kind kind = end;
  std::size_t at = 0;  ///< its first byte
  std::string text;    ///< for a text or unit: the content of the quotes or brackets
  double value = 0;    ///< of a number
};

inline constexpr std::size_t longest_expression = 20000;

/// The tokens of an expression, `end` last. Throws InputError if there are none, if the text is
/// longer than `longest_expression`, or for invalid characters.
std::vector<Token> tokens_of(const Text& text);

}  // namespace wearwell::formula
