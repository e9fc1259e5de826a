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
  EXPECT_THAT(check.detail, HasSubstr("has not seen"));
  EXPECT_THAT(check.advice, HasSubstr("does not depend on the inputs"));
  EXPECT_FALSE(result.trusted);
}

TEST(ClutchChecks, TheExamplesTruthPasses) {
  const ClutchResult result = result_of([](Truth& truth) { truth.worn_out = 1e-6; });
  EXPECT_NE(wear_map_check(result).verdict, Verdict::fail);
  EXPECT_GT(result.nested.r2, 0.6);
  EXPECT_LT(result.nested.r2, result.maps.front().fit.r2p + 0.05);
}

}  // namespace
}  // namespace wearwell::clutch
