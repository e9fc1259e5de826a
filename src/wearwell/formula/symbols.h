#pragma once

#include <string>
#include <vector>

#include "wearwell/formula/dimension.h"

namespace wearwell::formula {

/// A number for each row, in SI (a temperature in degrees Celsius is in kelvin by then).
struct ColumnSymbol {
  std::string name;
  Powers powers;
  /// What the study measures: an expression may not lean on it. A state of the same name
  /// ("d(depth)/d(distance)") takes its place in expressions.
  bool measured = false;
};

/// A text for each row, one of `levels`: `material == "PTFE"`, `k[material]`.
struct LabelSymbol {
  std::string name;
  std::vector<std::string> levels;  ///< row i holds an index into these
};

enum class Scope {
  one,        ///< one number: one slot of the vector of parameters
  per_level,  ///< `k[material]`: a slot for each level of `label`, one behind the other
  per_row,  ///< written `k`, but given by row, outside of the vector of parameters: a random effect
};

struct ParameterSymbol {
  std::string name;
  Powers powers;
  Scope scope = Scope::one;
  std::string label = {};  ///< of Scope::per_level
};

struct ConstantSymbol {
  std::string name;
  Powers powers;
  double value = 0;  ///< SI
};

/// What names in expressions may stand for. The order of columns, labels and parameters is the
/// order in which a program is given their values.
struct Symbols {
  std::vector<ColumnSymbol> columns;
  std::vector<LabelSymbol> labels;
  std::vector<ParameterSymbol> parameters;
  std::vector<ConstantSymbol> constants;
};

/// Throws InputError where a name is no name (letters, digits and _, a letter first), is one of the
/// language's own (exp, where, and, pi ...), or stands for two things.
void check(const Symbols& symbols);

/// Where each parameter's slots begin in the vector of parameters; the last entry is its size. A
/// parameter by row has none.
std::vector<std::size_t> slots(const Symbols& symbols);

}  // namespace wearwell::formula
