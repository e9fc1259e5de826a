#include "wearwell/formula/kernels.h"

#include "wearwell/formula/kernel_loops.h"
#include "wearwell/formula/kernels_avx2.h"

namespace wearwell::formula {
namespace {

bool has_avx2() {
#if defined(__x86_64__)
  static const bool has = __builtin_cpu_supports("avx2");
  return has;
#else
  return false;
#endif
}

}  // namespace

Kernels kernels_of(Op op, unsigned uniform) {
  if (has_avx2()) {
    if (const Kernels wide = kernels_avx2(op, uniform); wide.forward != nullptr) return wide;
  }
  return local_kernels(op, uniform);
}

double value_of(Op op, double a, double b, double c, double extra) {
  double y = 0;
  local_kernels(op, 7).forward(&a, &b, &c, &y, 1, extra);
  return y;
}

}  // namespace wearwell::formula
