#include "wearwell/models/ownlaw/unit_rule.h"

#include "wearwell/law/kernels.h"

namespace wearwell::ownlaw {

void exp_all(const double* x, double* y, std::size_t n) {
  static const law::Forward forward = law::kernels_of(law::Op::exp, 0).forward;
  forward(x, nullptr, nullptr, y, n, 0);
}

void log_all(const double* x, double* y, std::size_t n) {
  static const law::Forward forward = law::kernels_of(law::Op::log, 0).forward;
  forward(x, nullptr, nullptr, y, n, 0);
}

}  // namespace wearwell::ownlaw
