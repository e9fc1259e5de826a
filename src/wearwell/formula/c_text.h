#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "wearwell/formula/program.h"

namespace wearwell::formula {

/// An expression under the lines `law` as a function of C99, `static double NAME(const double *number, const int *label, const
/// double *parameter, const double *effect)`: of columns and labels in the order of the symbols, of slots(symbols), and of
/// what is given by row. Throws InputError as `compile` does, and where it depends on rows before its own.
std::string c_function(const std::vector<Line>& law, const Wanted& wanted, const Symbols& symbols,
                       const std::string& name);

/// What such functions call and C has not.
std::string c_helpers(std::string_view functions);

/// A constant of C99 that reads back to the same bits.
std::string c_number(double x);

}  // namespace wearwell::formula
