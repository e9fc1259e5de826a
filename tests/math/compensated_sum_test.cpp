#include "wearwell/math/compensated_sum.h"

#include <gtest/gtest.h>

#include <limits>

namespace wearwell {
namespace {

TEST(CompensatedSum, KeepsTheDigitsThatAPlainSumOfManyTermsLoses) {
  // Neither a tenth nor any of its sums is a number of a double.
  constexpr int count = 10'000'000;
  CompensatedSum sum;
  double plain = 0;
  for (int i = 0; i < count; ++i) {
    sum.add(0.1);
    plain += 0.1;
  }
  constexpr double tenth_in_excess = 5.551115123125783e-18;  // the double 0.1, less one tenth
  EXPECT_NEAR(sum.total(), 1e6 + count * tenth_in_excess, 2e-10);
  EXPECT_GT(std::abs(plain - 1e6), 1e-4);
}

TEST(CompensatedSum, TermsLargerThanTheSumLoseNothing) {
  CompensatedSum sum;
  for (const double each : {1.0, 1e100, 1.0, -1e100}) sum.add(each);
  EXPECT_EQ(sum.total(), 2);
}

TEST(CompensatedSum, AnInfiniteTermIsTheSum) {
  CompensatedSum sum;
  sum.add(1);
  sum.add(-std::numeric_limits<double>::infinity());
  sum.add(2);
  EXPECT_EQ(sum.total(), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(CompensatedSum().total(), 0);
}

}  // namespace
}  // namespace wearwell
