#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "wearwell/formula/program.h"

namespace wearwell::formula {

/// An expression under the lines `law` as a function of C99, `static double NAME(const double
/// *number, const int *label, const double *parameter, const double *effect)`: with columns and
/// labels in the order of the symbols, slots(symbols), and random effects by row. Throws InputError
/// like `compile`, and if the expression depends on previous rows.
std::string c_function(const std::vector<Line>& law, const Wanted& wanted, const Symbols& symbols,
                       const std::string& name);

/// The helper functions that such functions call.
std::string c_helpers(std::string_view functions);

/// A C99 constant that reads back to the same bits.
std::string c_number(double x);

}  // namespace wearwell::formula
