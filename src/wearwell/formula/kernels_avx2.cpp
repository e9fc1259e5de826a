#include "wearwell/formula/kernels_avx2.h"

#ifdef __AVX2__
#include "wearwell/formula/kernel_loops.h"
#endif

namespace wearwell::formula {

Kernels kernels_avx2([[maybe_unused]] Op op, [[maybe_unused]] unsigned uniform) {
#ifdef __AVX2__
  return local_kernels(op, uniform);
#else
  return {};
#endif
}

}  // namespace wearwell::formula
