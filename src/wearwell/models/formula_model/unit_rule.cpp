#include "wearwell/models/formula_model/unit_rule.h"

#include "wearwell/formula/kernels.h"

namespace wearwell::formula_model {

void exp_all(const double* x, double* y, std::size_t n) {
  static const formula::Forward forward = formula::kernels_of(formula::Op::exp, 0).forward;
  forward(x, nullptr, nullptr, y, n, 0);
}

void log_all(const double* x, double* y, std::size_t n) {
  static const formula::Forward forward = formula::kernels_of(formula::Op::log, 0).forward;
  forward(x, nullptr, nullptr, y, n, 0);
}

}  // namespace wearwell::formula_model
