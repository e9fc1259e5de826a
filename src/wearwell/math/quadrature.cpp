#include "wearwell/math/quadrature.h"

#include <boost/math/special_functions/legendre.hpp>

namespace wearwell {

GaussLegendre gauss_legendre(int n) {
  GaussLegendre rule;
  // Boost returns only the non-negative zeros.
  const std::vector<double> zeros = boost::math::legendre_p_zeros<double>(n);
  for (auto zero = zeros.rbegin(); zero != zeros.rend(); ++zero) {
    if (*zero > 0) rule.node.push_back(-*zero);
  }
  rule.node.insert(rule.node.end(), zeros.begin(), zeros.end());
  rule.cell_edge.push_back(-1);
  for (const double x : rule.node) {
    const double slope = boost::math::legendre_p_prime(n, x);
    rule.weight.push_back(2 / ((1 - x * x) * slope * slope));
    rule.cell_edge.push_back(rule.cell_edge.back() + rule.weight.back());
  }
  rule.cell_edge.back() = 1;
  return rule;
}

}  // namespace wearwell
