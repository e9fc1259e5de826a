#pragma once

#include "wearwell/law/program.h"

namespace wearwell::law {

/// One row, for a program that leans on parameters alone.
Data bind_no_columns(const Program& program, const Symbols& symbols);

}  // namespace wearwell::law
