#pragma once

#include "wearwell/formula/program.h"

namespace wearwell::formula {

/// One row, for a program that leans on parameters alone.
Data bind_no_columns(const Program& program, const Symbols& symbols);

}  // namespace wearwell::formula
