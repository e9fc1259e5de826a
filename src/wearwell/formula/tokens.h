#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "wearwell/formula/complaint.h"

namespace wearwell::formula {

/// A word of an expression.
struct Token {
  enum Kind : unsigned char { number, name, quotation, unit, sign, end };
  Kind kind = end;
  std::size_t at = 0;  ///< its first byte
  std::string text;    ///< of a text or unit what stands between quotes or brackets
  double value = 0;    ///< of a number
};

inline constexpr std::size_t longest_expression = 20000;

/// The words of an expression, `end` last. Throws InputError where there are none, where the text
/// is longer than `longest_expression` or holds what belongs to no expression.
std::vector<Token> tokens_of(const Text& text);

}  // namespace wearwell::formula
