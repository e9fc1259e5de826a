#include "wearwell/models/bearing/scar.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numbers>

#include "support/between.h"
#include "wearwell/base/error.h"

namespace wearwell::bearing {
namespace {

using std::numbers::pi;

double relative(double value, double expected) {
  return std::abs(value - expected) / std::abs(expected);
}

// The paper's first example, sigma = 0.001, delta = 0.005: cos(alpha) = 0.001965/0.012 = 0.16375 by
// its printed formula.
TEST(Scar, WorkedExample) {
  const Scar s = scar(0.001, 0.005);
  EXPECT_NEAR(std::cos(s.centre_angle / 2), 0.16375, 1e-14);
  EXPECT_NEAR(s.width, 2 * std::sqrt(1 - 0.16375 * 0.16375), 1e-14);
}

// The width's last bit costs the depth as much as the amplification says.
RC_GTEST_PROP(Scar, DepthFromItsOwnWidth, ()) {
  const double sigma = *between(1e-8, 0.5);
  const double delta = widest_depth(sigma) * *between(1e-6, 0.5);
  const ScarDepth back = depth_from_scar(sigma, scar(sigma, delta).width);
  RC_ASSERT(relative(back.delta, delta) < 1e-15 * (10 + back.amplification));
}

RC_GTEST_PROP(Scar, IsWidestAtWidestDepth, ()) {
  const double sigma = *between(1e-8, 0.5);
  const double delta = widest_depth(sigma);
  RC_ASSERT(std::abs(scar(sigma, delta).centre_angle - pi) < 1e-12);
  RC_ASSERT(scar(sigma, delta * 0.99).width < 2);
  RC_ASSERT(scar(sigma, delta * 1.01).width < 2);
}

RC_GTEST_PROP(Scar, PowersAreSlopes, ()) {
  const double sigma = *between(1e-6, 0.5), width = *between(1e-3, 1.99);
  const double h = 1e-5;
  const auto log_slope = [&](auto f) {
    return (std::log(f(1 + h)) - std::log(f(1 - h))) / (2 * h);
  };
  const ScarDepth at = depth_from_scar(sigma, width);
  const double by_width =
      log_slope([&](double x) { return depth_from_scar(sigma, width * x).delta; });
  const double by_sigma =
      log_slope([&](double x) { return depth_from_scar(sigma * x, width).delta; });
  RC_ASSERT(relative(at.amplification, by_width) < 1e-4);
  RC_ASSERT(std::abs(at.clearance_power - by_sigma) < 1e-8);
}

// For small sigma delta = sigma (1/cos(alpha) - 1), so the amplification is
// (1 + cos(alpha))/cos(alpha)^2: 2 for a narrow scar, without bound for a wide one. This is the
// paper's warning that the width is a bad measure of the depth.
RC_GTEST_PROP(Scar, AmplificationAtSmallClearance, ()) {
  const double sigma = *between(1e-8, 1e-6), alpha = *between(1e-3, 1.5);
  const double expected = (1 + std::cos(alpha)) / (std::cos(alpha) * std::cos(alpha));
  RC_ASSERT(relative(depth_from_scar(sigma, 2 * std::sin(alpha)).amplification, expected) < 1e-3);
}

TEST(Scar, RefusesImpossibleWidth) {
  EXPECT_THROW(depth_from_scar(0.001, 0), InputError);
  EXPECT_THROW(depth_from_scar(0.001, -1), InputError);
  EXPECT_THROW(depth_from_scar(0.001, 2), InputError);
  EXPECT_THROW(depth_from_scar(0.001, std::nan("")), InputError);
}

}  // namespace
}  // namespace wearwell::bearing
