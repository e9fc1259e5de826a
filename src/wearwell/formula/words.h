#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace wearwell::formula {

inline constexpr std::size_t longest_name = 64;

/// What is done with numbers. Those that are called as functions have an entry in `functions()`.
enum class Op : unsigned char {
  constant,
  column,
  label_is,   ///< 1 where the row's label is a given one
  parameter,  ///< one slot
  by_row,     ///< a parameter given by row
  pick,       ///< the slot of the row's label
  step,       ///< of the axis, since the row before
  state_now,  ///< within a rate: the state
  axis_now,   ///< within a rate: the axis
  add,
  subtract,
  multiply,
  divide,
  negate,
  power,
  whole_power,  ///< by a constant whole number
  power_log,    ///< a^b where log(a) = c is known
  exp,
  log,
  log10,
  sqrt,
  abs,
  min,
  max,
  erf,
  tanh,
  sin,
  cos,
  atan,
  log1p,
  expm1,
  growth,  ///< expm1(a)/a, 1 at 0
  less,
  less_equal,
  equal,
  unequal,
  both,
  either,
  opposite,
  where,
  cum,
  state,   ///< by its rate
  expand,  ///< numbers by label to the rows that have it
  recurrence,  ///< a state with a linear rate: a its growth from row to row, b its beginning, c its gain
};

/// What a function asks of its arguments and gives.
enum class Rule : unsigned char {
  pure,      ///< pure numbers in and out
  angle,     ///< an angle in, a pure number out
  to_angle,  ///< a pure number in, an angle out
  same,      ///< the dimension of its arguments, which is one
  root,
  power,
  where,
  cum,
};

struct Function {
  const char* name;
  Op op;
  int arguments;
  Rule rule;
};

const std::vector<Function>& functions();
const Function* find_function(std::string_view name);

/// Functions, `and`, `or`, `not`, `pi`: no name of a study's own.
bool is_word_of_language(std::string_view name);

/// Throws InputError where a name is no name or a word of the language; `what` is "column", "line".
void check_name(const std::string& name, const std::string& what);

}  // namespace wearwell::formula
