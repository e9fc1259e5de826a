#include "wearwell/math/dual.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace wearwell {
namespace {

constexpr int most = 6;

// sum of i sin(x_i) + x_0 x_1 ... over all `most` entries, so that entries beyond the variables are
// seen to be 0.
struct Sample {
  template <class T>
  T operator()(const T* x) const {
    using std::exp;
    using std::sin;
    T sum(0);
    for (int i = 0; i < most; ++i) sum += (i + 1.0) * sin(x[i]) + x[i] * x[(i + 1) % most];
    return sum * exp(x[0]);
  }
};

TEST(ValueAndGradient, IsAnalyticForEveryNumberOfVariables) {
  for (std::size_t n = 1; n <= most; ++n) {
    SCOPED_TRACE(n);
    std::array<double, most> x{};
    for (std::size_t i = 0; i < n; ++i) x[i] = 0.3 - 0.7 * static_cast<double>(i);
    std::vector<double> gradient(n, 1e300);
    const double value = value_and_gradient<most>(Sample(), std::span(x.data(), n), gradient);
    const double inner = Sample()(x.data()) / std::exp(x[0]);
    EXPECT_NEAR(value, inner * std::exp(x[0]), 1e-14);
    for (std::size_t i = 0; i < n; ++i) {
      const double sum_slope = (static_cast<double>(i) + 1) * std::cos(x[i]) + x[(i + 1) % most] +
                               x[(i + most - 1) % most];
      EXPECT_NEAR(gradient[i], (sum_slope + (i == 0 ? inner : 0)) * std::exp(x[0]), 1e-13);
    }
  }
}

TEST(ValueAndGradient, NeedsAVariable) {
  EXPECT_THROW(value_and_gradient<most>(Sample(), {}, {}), std::logic_error);
}

}  // namespace
}  // namespace wearwell
