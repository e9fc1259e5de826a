#include "wearwell/models/formula_model/node_points.h"

#include "wearwell/formula/kernels.h"

namespace wearwell::formula_model {

DrawnLines::DrawnLines(std::span<const double> weight, std::size_t line) : weight_(weight) {
  static const formula::Forward log = formula::kernels_of(formula::Op::log, 0).forward;
  static const formula::Forward exp = formula::kernels_of(formula::Op::exp, 0).forward;
  const std::size_t n = weight.size();
  if (line == 1) {
    for (std::size_t k = 0; k < n; ++k) inner_[k] = false;
    return;
  }
  double ratio[most], behind[most], exponent[2][most], factor[2][most];
  bool next[most];
  for (std::size_t k = 0; k < n; ++k) {
    next[k] = (k + 1) % line != 0 && weight[k] > 0 && weight[k + 1] > 0;
    ratio[k] = next[k] ? weight[k + 1] / weight[k] : 1;
  }
  log(ratio, nullptr, nullptr, behind, n, 0);
  for (std::size_t k = 0; k < n; ++k) {
    inner_[k] = next[k] && k % line != 0 && next[k - 1];
    // exp(t/2 (behind + before) + t^2/2 (behind - before)) at t = -3/8, -1/8, 1/8, 3/8.
    const double before = inner_[k] ? behind[k - 1] : 0;
    exponent[0][k] = (behind[k] + before) / 16;
    exponent[1][k] = (behind[k] - before) / 128;
  }
  for (std::size_t e = 0; e < 2; ++e) exp(exponent[e], nullptr, nullptr, factor[e], n, 0);
  for (std::size_t k = 0; k < n; ++k) {
    if (!inner_[k]) continue;
    const double one = factor[0][k], bend = factor[1][k];
    const double three = one * one * one, bend3 = bend * bend * bend, bend9 = bend3 * bend3 * bend3;
    const double part = weight[k] / parts;
    share_[k][0] = part * bend9 / three;
    share_[k][1] = part * bend / one;
    share_[k][2] = part * bend * one;
    share_[k][3] = part * bend9 * three;
  }
}

}  // namespace wearwell::formula_model
