#include "wearwell/math/root.h"

#include <gtest/gtest.h>

namespace wearwell {
namespace {

TEST(SolveIncreasing, FindsRootsNearAndFar) {
  for (const double root : {-1e12, -3.0, 0.0, 1e-9, 2.5, 7e8}) {
    const auto f = [&](double x) { return std::atan(x - root); };
    EXPECT_NEAR(solve_increasing(f, 1, 0.1, {.absolute = 1e-10, .relative = 1e-13}), root,
                1e-9 + 1e-12 * std::abs(root));
  }
}

TEST(SolveIncreasing, ASteepStepIsFound) {
  const auto f = [](double x) { return x < 1.0 / 3 ? -1.0 : 1.0; };
  EXPECT_NEAR(solve_increasing(f, 100, 1, {.relative = 1e-12}), 1.0 / 3, 1e-12);
}

TEST(SolveIncreasing, EndsAtTheEnds) {
  const auto f = [](double x) { return x; };
  EXPECT_EQ(solve_increasing(f, 5, 1, {1e-9}, 2, 8), 2);
  EXPECT_EQ(solve_increasing(f, -5, 1, {1e-9}, -8, -2), -2);
  EXPECT_EQ(solve_increasing(f, 50, 1, {1e-9}, 2, 8), 2);
  EXPECT_EQ(solve_increasing(f, 5, 1, {1e-9}, 0, 8), 0);
}

TEST(SolveIncreasing, WhatIsNoNumberHasNoRoot) {
  EXPECT_TRUE(std::isnan(solve_increasing([](double) { return std::nan(""); }, 0, 1, {1e-9})));
  EXPECT_TRUE(std::isnan(
      solve_increasing([](double x) { return x < 3 ? -1 : std::nan(""); }, 0, 1, {1e-9})));
}

// Never more than it promises, wherever the root lies.
TEST(SolveIncreasing, CallsAreBounded) {
  for (const double root : {1e-300, 1e300, -1e300}) {
    int calls = 0;
    const auto f = [&](double x) {
      ++calls;
      return x < root ? -1.0 : 1.0;
    };
    solve_increasing(f, 0, 1e-300, {.relative = 1e-12});
    EXPECT_LT(calls, 2400) << root;
  }
}

}  // namespace
}  // namespace wearwell
