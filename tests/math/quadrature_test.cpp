#include "wearwell/math/quadrature.h"

#include <gtest/gtest.h>

#include <cmath>

namespace wearwell {
namespace {

class GaussLegendreOrder : public testing::TestWithParam<int> {
 protected:
  const int n = GetParam();
  const GaussLegendre rule = gauss_legendre(n);
};

TEST_P(GaussLegendreOrder, IsExactToDegree) {
  ASSERT_EQ(rule.node.size(), static_cast<std::size_t>(n));
  ASSERT_EQ(rule.weight.size(), rule.node.size());
  for (int degree = 0; degree < 2 * n; ++degree) {
    double sum = 0;
    for (std::size_t i = 0; i < rule.node.size(); ++i)
      sum += rule.weight[i] * std::pow(rule.node[i], degree);
    EXPECT_NEAR(sum, degree % 2 == 0 ? 2. / (degree + 1) : 0, 4e-15) << "degree " << degree;
  }
}

// Of degree 2n the rule is wrong by 2^(2n+1) (n!)^4 / ((2n+1) ((2n)!)^2) (Abramowitz and Stegun
// 25.4.30, for a monic polynomial).
TEST_P(GaussLegendreOrder, IsNotExactBeyond) {
  if (n > 12) return;  // the error drowns in rounding
  double sum = 0;
  for (std::size_t i = 0; i < rule.node.size(); ++i)
    sum += rule.weight[i] * std::pow(rule.node[i], 2 * n);
  const double error = std::exp((2 * n + 1) * std::log(2.) + 4 * std::lgamma(n + 1) -
                                std::log(2 * n + 1) - 2 * std::lgamma(2 * n + 1));
  EXPECT_NEAR(2. / (2 * n + 1) - sum, error, 1e-14);
}

TEST_P(GaussLegendreOrder, EveryCellHoldsItsNode) {
  ASSERT_EQ(rule.cell_edge.size(), rule.node.size() + 1);
  EXPECT_EQ(rule.cell_edge.front(), -1);
  EXPECT_EQ(rule.cell_edge.back(), 1);
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    EXPECT_LT(rule.cell_edge[i], rule.node[i]);
    EXPECT_LT(rule.node[i], rule.cell_edge[i + 1]);
    EXPECT_NEAR(rule.cell_edge[i + 1] - rule.cell_edge[i], rule.weight[i], 4e-15);
  }
}

INSTANTIATE_TEST_SUITE_P(Nodes, GaussLegendreOrder, testing::Range(1, 31));

}  // namespace
}  // namespace wearwell
