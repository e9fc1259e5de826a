#pragma once

#include "wearwell/formula/kernels.h"

namespace wearwell::formula {

/// The same kernels for machines with AVX2; empty if the compiler does not support it.
Kernels kernels_avx2(Op op, unsigned uniform);

}  // namespace wearwell::formula
