#include "wearwell/base/rng.h"

#include <gtest/gtest.h>

#include <cmath>

namespace wearwell {
namespace {

// Known answer of the Random123 distribution for counter 0 and key 0: 6627e8d5 e169c58d bc57ac4c
// 9b00dbd8.
TEST(Rng, IsPhilox4x32WithTenRounds) {
  Rng rng(0, 0);
  EXPECT_EQ(rng.bits(), 0xe169c58d6627e8d5ULL);
  EXPECT_EQ(rng.bits(), 0x9b00dbd8bc57ac4cULL);
}

TEST(Rng, StreamsDiffer) {
  Rng a(1, 0), b(1, 1), c(2, 0), again(1, 0);
  const auto first = a.bits();
  EXPECT_NE(first, b.bits());
  EXPECT_NE(first, c.bits());
  EXPECT_EQ(first, again.bits());
}

TEST(Rng, MomentsOfUniformAndNormal) {
  Rng rng(20260101, 7);
  constexpr int n = 1'000'000;
  double u1 = 0, z1 = 0, z2 = 0, z4 = 0;
  for (int i = 0; i < n; ++i) {
    const double u = rng.uniform();
    ASSERT_GT(u, 0);
    ASSERT_LT(u, 1);
    u1 += u;
    const double z = rng.normal();
    z1 += z;
    z2 += z * z;
    z4 += z * z * z * z;
  }
  // Five standard errors of each mean: sd of u is sqrt(1/12), of z 1, of z^2 sqrt(2), of z^4
  // sqrt(96).
  const double se = 5 / std::sqrt(n);
  EXPECT_NEAR(u1 / n, 0.5, se * std::sqrt(1. / 12));
  EXPECT_NEAR(z1 / n, 0, se);
  EXPECT_NEAR(z2 / n, 1, se * std::sqrt(2));
  EXPECT_NEAR(z4 / n, 3, se * std::sqrt(96));
}

}  // namespace
}  // namespace wearwell
