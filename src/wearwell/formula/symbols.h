#pragma once

#include <string>
#include <vector>

#include "wearwell/formula/dimension.h"

namespace wearwell::formula {

/// A number for each row, in SI (temperatures in kelvin).
struct ColumnSymbol {
  std::string name;
  Powers powers;
  /// A measured response, which expressions cannot use. A state of the same name
  /// ("d(depth)/d(distance)") replaces it in expressions.
  bool measured = false;
};

/// A text for each row, one of `levels`: `material == "PTFE"`, `k[material]`.
struct LabelSymbol {
  std::string name;
  std::vector<std::string> levels;  ///< rows hold indices into these
};

enum class Scope {
  one,        ///< one number: one entry of the parameter vector
  per_level,  ///< `k[material]`: consecutive entries, one for each level of `label`
  per_row,    ///< written `k`, but given by row, outside the parameter vector: a random effect
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

/// The names available in expressions. A program receives the values of columns, labels and
/// parameters in this order.
struct Symbols {
  std::vector<ColumnSymbol> columns;
  std::vector<LabelSymbol> labels;
  std::vector<ParameterSymbol> parameters;
  std::vector<ConstantSymbol> constants;
};

/// Throws InputError if a name is invalid (letters, digits and _, a letter first), is a keyword
/// (exp, where, and, pi ...), or is used twice.
void check(const Symbols& symbols);

/// The first index of each parameter in the parameter vector; the last entry is its size. A
/// parameter by row has no entries.
std::vector<std::size_t> slots(const Symbols& symbols);

}  // namespace wearwell::formula
