#include "wearwell/study/sense.h"

#include <gmock/gmock.h>

namespace wearwell {
namespace {

using testing::HasSubstr;

Check reach(double times) {
  return extrapolation_check({{"the prediction at 1e9 cycles", "seen were 1e4", times, 1}});
}

TEST(Sense, WhatLiesFarBeyondTheDataIsNotTrusted) {
  EXPECT_EQ(reach(2).verdict, Verdict::pass);
  EXPECT_EQ(reach(10).verdict, Verdict::warn);
  EXPECT_EQ(reach(1e5).verdict, Verdict::fail);
  EXPECT_THAT(reach(1e5).detail, HasSubstr("1e+05 times as far as the data reach"));
}

PosteriorSummary interval(double low, double high) {
  PosteriorSummary result;
  result.quantities = {{"life", "bearing", "", "h", true, {low, 2, high, low, low, 2}, {}}};
  return result;
}

TEST(Sense, AnAbsurdIntervalIsNotTrusted) {
  EXPECT_EQ(sense_check(interval(1, 100)).verdict, Verdict::pass);
  EXPECT_EQ(sense_check(interval(1, 1e5)).verdict, Verdict::warn);
  EXPECT_EQ(sense_check(interval(1e-3, 1e12)).verdict, Verdict::fail);
  EXPECT_THAT(sense_check(interval(1e-3, 1e12)).detail, HasSubstr("spans 15.0 decades"));
}

}  // namespace
}  // namespace wearwell
