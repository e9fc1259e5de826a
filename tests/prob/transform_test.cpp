#include "wearwell/prob/transform.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/between.h"

#include "wearwell/math/constants.h"

namespace wearwell {
namespace {

struct Support {
  double lower, upper, scale;
};
const std::vector<Support> supports = {
    {-infinity, infinity, 3}, {0, infinity, 5e-13}, {-2, infinity, 0.5},
    {-infinity, 4, 2},        {0, 15e-9, 1},        {-1, 3, 1},
};

Support any_support() {
  return supports[*rc::gen::inRange<std::size_t>(0, supports.size())];
}

double moderate() {
  return *between(1e-6, 10) * (*rc::gen::arbitrary<bool>() ? 1 : -1);
}

RC_GTEST_PROP(Transform, ThereAndBack, ()) {
  const Support s = any_support();
  const Transform transform(s.lower, s.upper, s.scale);
  const double z = moderate();
  const double x = transform.from_real(z).x;
  RC_ASSERT(s.lower < x && x < s.upper);
  RC_ASSERT(std::abs(transform.to_real(x) - z) < 1e-10);
}

RC_GTEST_PROP(Transform, SlopeAndJacobian, ()) {
  const Support s = any_support();
  const Transform transform(s.lower, s.upper, s.scale);
  const double z = moderate(), h = 1e-4;
  const Transform::Point at = transform.from_real(z), left = transform.from_real(z - h),
                         right = transform.from_real(z + h);
  const double size =
      std::max({std::abs(left.x), std::abs(right.x), std::abs(at.slope)});  // rounding of x
  RC_ASSERT(std::abs((right.x - left.x) / (2 * h) - at.slope) <
            1e-7 * std::abs(at.slope) + 1e-15 * size / h);
  RC_ASSERT(std::abs(at.log_jacobian - std::log(std::abs(at.slope))) < 1e-12);
  RC_ASSERT(std::abs((right.log_jacobian - left.log_jacobian) / (2 * h) - at.log_jacobian_slope) <
            1e-7);
}

TEST(Transform, FarOutIsTheEdgeAndNeverNan) {
  for (const Support& s : supports) {
    const Transform transform(s.lower, s.upper, s.scale);
    for (const double z : {-1e4, -700., 700., 1e4}) {
      const Transform::Point p = transform.from_real(z);
      EXPECT_GE(p.x, s.lower);
      EXPECT_LE(p.x, s.upper);
      EXPECT_FALSE(std::isnan(p.slope));
      EXPECT_TRUE(std::isfinite(p.log_jacobian));
      EXPECT_TRUE(std::isfinite(p.log_jacobian_slope));
    }
  }
}

// Near a bound at 0, x keeps all of its digits: x = scale e^z to one rounding, and (upper - lower)
// e^z (1 - e^z + ...).
TEST(Transform, KeepsPrecisionNearABound) {
  const Transform above(0, infinity, 2e-13), between(0, 15e-9, 1);
  for (const double z : {-600., -300., -50.}) {
    EXPECT_DOUBLE_EQ(above.from_real(z).x, 2e-13 * std::exp(z));
    EXPECT_DOUBLE_EQ(between.from_real(z).x, 15e-9 * std::exp(z));
    EXPECT_NEAR(above.to_real(above.from_real(z).x), z, 1e-12);
    EXPECT_NEAR(between.to_real(between.from_real(z).x), z, 1e-12);
  }
}

}  // namespace
}  // namespace wearwell
