// The checks of a clutch study can fail.
#include <gmock/gmock.h>

#include <algorithm>
#include <functional>

#include "wearwell/models/clutch/clutch_study.h"

namespace wearwell::clutch {
namespace {

using testing::HasSubstr;

/// The example's campaign with another truth, few exponents, no replicates.
ClutchResult result_of(const std::function<void(Truth&)>& change) {
  ClutchStudy study = read_clutch_study(PROJECT_SOURCE_DIR "/examples/clutch/study.toml");
  Truth truth = *study.truth;
  change(truth);
  study.campaign = simulate(study.campaign.design, truth, 3).campaign;
  study.realized.clear();
  study.life_points.clear();
  study.exponents = {0.4, 1, 2};
  study.replicates = 0;
  return run_clutch_study(study);
}

const Check& wear_map_check(const ClutchResult& result) {
  return *std::find_if(result.checks.begin(), result.checks.end(),
                       [](const Check& check) { return check.name == "wear map"; });
}

// A wear rate that depends on nothing: the search finds a map of noise, with an R2p above 0 as
// always, and the check says so.
TEST(ClutchChecks, AWearRateThatDependsOnNothingFails) {
  const ClutchResult result = result_of([](Truth& truth) {
    truth.terms = {{0, 0, 0, 20 * mm3_per_MJ}};
    truth.worn_out = 1e-6;
  });
  EXPECT_GT(result.maps.front().fit.r2p, 0);
  EXPECT_LT(result.nested.r2, 0.1);
  const Check& check = wear_map_check(result);
  EXPECT_EQ(check.verdict, Verdict::fail);
  EXPECT_THAT(check.detail, HasSubstr("outside the search"));
  EXPECT_THAT(check.advice, HasSubstr("no dependence of the wear rate on the inputs"));
  EXPECT_FALSE(result.trusted);
}

TEST(ClutchChecks, TheExamplesTruthPasses) {
  const ClutchResult result = result_of([](Truth& truth) { truth.worn_out = 1e-6; });
  EXPECT_NE(wear_map_check(result).verdict, Verdict::fail);
  EXPECT_GT(result.nested.r2, 0.6);
  EXPECT_LT(result.nested.r2, result.maps.front().fit.r2p + 0.05);
}

WearModel model_between(double low, double high) {
  WearModel model;
  model.lowest = {low, 25, 120, 1};
  model.highest = {high, 75, 220, 3};
  return model;
}

// What `clutch life` says of an operating point, `fit` says too, and does not trust it far out.
TEST(ClutchChecks, ALifeOutsideTheRangeOfValidityIsNamed) {
  const WearModel model = model_between(1000 * rpm, 2000 * rpm);
  const auto check = [&](double speed) {
    return extrapolation_check(model, {{"hill", {speed * rpm, 50, 170, 2}, {}}});
  };
  EXPECT_EQ(check(1500).verdict, Verdict::pass);
  EXPECT_EQ(check(2200).verdict, Verdict::warn);
  EXPECT_THAT(check(2200).detail, HasSubstr("'hill' lies outside the calibrated range by 0.2 of"));
  EXPECT_THAT(check(2200).detail, HasSubstr("slip_speed 2200, calibrated from 1000 to 2000 rpm"));
  EXPECT_EQ(check(9000).verdict, Verdict::fail);
  EXPECT_EQ(check(300).verdict, Verdict::fail);
  EXPECT_EQ(extrapolation_check(model, {{"cold", {1500 * rpm, 50, 60, 2}, {}}}).verdict,
            Verdict::fail);
}

TEST(ClutchChecks, AnIntervalThatSaysNothingFails) {
  const auto check = [](double relative) {
    NamedLife life{"launch", {}, {}};
    LifeAtLevel level;
    level.level = 1;
    level.full_relative = relative;
    life.life.levels.push_back(level);
    return sense_check({life});
  };
  EXPECT_EQ(check(0.2).verdict, Verdict::pass);
  EXPECT_EQ(check(0.7).verdict, Verdict::warn);
  EXPECT_EQ(check(16404.74).verdict, Verdict::fail);
  EXPECT_THAT(check(16404.74).detail, HasSubstr("'launch' has an uncertainty of +- 1.64e+06 %"));
}

}  // namespace
}  // namespace wearwell::clutch
