#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace wearwell::formula {

inline constexpr std::size_t longest_name = 64;

/// The operations. Those called as functions have an entry in `functions()`.
enum class Op : unsigned char {
  constant,
  column,
  label_is,   ///< 1 if the row has the given level
  parameter,  ///< one slot
  by_row,     ///< a parameter given by row
  pick,       ///< the entry of the row's level
  step,       ///< increment of the axis since the previous row
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
  erfc,
  probit,  ///< the standard normal quantile
  gamma,
  lgamma,
  digamma,
  tanh,
  sin,
  cos,
  atan,
  log1p,
  expm1,
  growth,  ///< expm1(a)/a, 1 at 0
  // Of distributions in standard form (distribution_functions.h): x or p, and the parameter.
  gamma_cdf,
  gamma_survival,
  gamma_quantile,
  inverse_gaussian_cdf,
  inverse_gaussian_survival,
  inverse_gaussian_quantile,
  generalized_gamma_cdf,
  generalized_gamma_pdf,
  generalized_gamma_quantile,
  student_t_cdf,
  student_t_quantile,
  less,
  less_equal,
  equal,
  unequal,
  both,
  either,
  opposite,
  where,
  cum,
  state,       ///< by its rate
  expand,      ///< expands numbers by label to rows
  recurrence,  ///< a state with a linear rate: a its growth from row to row, b its beginning, c its
               ///< gain
};

/// The types of a function's arguments and result.
enum class Rule : unsigned char {
  pure,      ///< pure numbers in and out
  angle,     ///< an angle in, a pure number out
  to_angle,  ///< a pure number in, an angle out
  same,      ///< arguments of one dimension, result of the same
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
/// The function of an operation that is a function of a distribution in standard form; else null.
const Function* find_distribution_function(Op op);

/// Reserved names: `and`, `or`, `not`, `pi`, and functions except those of distributions and a few
/// with names that parameters have, like `gamma`.
bool is_word_of_language(std::string_view name);

/// Throws InputError if a name is invalid or a keyword; `what` is "column", "line".
void check_name(const std::string& name, const std::string& what);

}  // namespace wearwell::formula
