#pragma once

#include "wearwell/formula/kernels.h"

namespace wearwell::formula {

/// The same kernels for machines with AVX2; without kernels where the compiler has none for it.
Kernels kernels_avx2(Op op, unsigned uniform);

}  // namespace wearwell::formula
