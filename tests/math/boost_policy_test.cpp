// Gamma functions where arguments are extreme. Values: Abramowitz and Stegun, table 6.1 and 6.3.18.
#include "wearwell/math/boost_policy.h"

#include <gtest/gtest.h>

#include <boost/math/special_functions/erf.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <limits>

namespace wearwell {
namespace {

TEST(BoostPolicy, DigammaIsFiniteForEveryPositiveDouble) {
  EXPECT_NEAR(digamma(1), -0.5772156649015329, 1e-15);
  EXPECT_NEAR(digamma(2), 0.4227843350984671, 1e-15);
  EXPECT_NEAR(digamma(1e-12) / -1e12, 1, 1e-11);
  EXPECT_NEAR(digamma(1e300) / std::log(1e300), 1, 1e-15);
  for (double x = std::numeric_limits<double>::denorm_min(); x < 1e308; x *= 7.3) {
    EXPECT_TRUE(std::isfinite(digamma(x))) << x;
    EXPECT_TRUE(std::isfinite(digamma<Quiet>(x))) << x;
  }
  EXPECT_NEAR(digamma(1e-310) * 1e-300, -1, 1e-15);
}

TEST(BoostPolicy, NoExceptions) {
  EXPECT_EQ(boost::math::lgamma(1e308, Quiet()), std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isinf(boost::math::erfc_inv(0.0, Quiet())));
  EXPECT_TRUE(std::isnan(boost::math::gamma_q(-1.0, 1.0, Quiet())));
}

}  // namespace
}  // namespace wearwell
