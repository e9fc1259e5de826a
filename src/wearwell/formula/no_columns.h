#pragma once

#include "wearwell/formula/program.h"

namespace wearwell::formula {

/// One row without columns, for a program that depends only on parameters.
Data bind_no_columns(const Program& program, const Symbols& symbols);

}  // namespace wearwell::formula
