// A joint on line against the fit of all of its inspections.
#include "wearwell/models/joint/joint_tracker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "models/tracked_preset.h"
#include "support/followed_unit.h"
#include "wearwell/base/error.h"

namespace wearwell::joint {
namespace {

using prognosis::Forecast;
using testing::HasSubstr;

constexpr double mm3 = 1e-9;

std::string study_with(const std::string& family, const std::string& more = "") {
  return R"toml(model = "archard-joint"
[data]
file = "data.csv"
[data.columns]
cycles = "cycles"
volume = { column = "volume", unit = "mm^3" }
[conditions]
work_per_cycle = "5.966 N m"
[likelihood]
family = ")toml" +
         family + R"toml("
[prior]
k = { distribution = "lognormal", median = "1e-3 mm^3/(N m)", log_sd = 1.5 }
sigma = { distribution = "half-normal", scale = "8 mm^3" }
)toml" + more +
         R"toml([predict]
limit = "100 mm^3"
)toml";
}

// An et al. (2011), both angles' means.
using Rows = std::vector<std::vector<std::string>>;
const Rows rows = {{"1", "4.44"},      {"100", "5.105"},   {"1000", "8.825"},
                   {"5000", "24.175"}, {"10000", "45.31"}, {"20585", "92.73"}};

Rows first(std::size_t count) {
  return {rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(count)};
}

std::vector<double> numbers(std::size_t row) {
  return {std::stod(rows[row][0]), std::stod(rows[row][1]) * mm3};
}

class OfJoint : public testing::TestWithParam<const char*> {
 protected:
  std::string study = study_with(GetParam());
};

TEST_P(OfJoint, InspectionsOneByOneAreTheFitOfAll) {
  const TrackedPreset known(study, {"cycles", "volume"}, first(2));
  FollowedUnit joint(*known.tracker, "joint");
  for (std::size_t i = 2; i < 5; ++i) {
    ASSERT_TRUE(joint.update(numbers(i)).counted) << i;
    const TrackedPreset all(study, {"cycles", "volume"}, first(i + 1));
    SCOPED_TRACE(i);
    const Forecast forecast = joint.unit->forecast();
    EXPECT_EQ(forecast.now, std::stod(rows[i][0]));
    EXPECT_GT(forecast.effective, 50);
    expect_life(forecast, all.life({}), 1, 0.01);
  }
}

TEST_P(OfJoint, LateReadingsAndSavedStatesChangeNothing) {
  const TrackedPreset known(study, {"cycles", "volume"}, first(2));
  FollowedUnit late(*known.tracker, "joint");
  for (const std::size_t i : {4, 2, 3}) {
    ASSERT_TRUE(late.update(numbers(i)).counted) << i;
    const std::string bytes = late.unit->save();
    late.unit = known.tracker->restore(bytes);
    EXPECT_EQ(late.unit->save(), bytes);
  }
  const TrackedPreset all(study, {"cycles", "volume"}, first(5));
  const Forecast forecast = late.unit->forecast();
  EXPECT_EQ(forecast.now, 10'000);
  expect_life(forecast, all.life({}), 1, 0.01);
}

TEST_P(OfJoint, SeveralReadingsOfOneInspectionAreTheFitOfAll) {
  Rows all_rows = first(4);
  all_rows.insert(all_rows.end(), {{"5000", "26.1"}, {"5000", "22.9"}});
  const TrackedPreset known(study, {"cycles", "volume"}, first(3)),
      all(study, {"cycles", "volume"}, all_rows);
  FollowedUnit joint(*known.tracker, "joint");
  for (const double volume : {22.9, 24.175, 26.1})
    ASSERT_TRUE(joint.update({5000, volume * mm3}).counted) << volume;
  EXPECT_EQ(joint.unit->forecast().now, 5000);
  expect_life(joint.unit->forecast(), all.life({}), 1, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Families, OfJoint, testing::Values("normal", "lognormal"));

TEST(JointTracker, FollowsVolumesBeforeAnyWorkToo) {
  const std::string study = study_with(
      "normal", "V0 = { distribution = \"normal\", mean = \"0 mm^3\", sd = \"10 mm^3\" }\n");
  const TrackedPreset known(study, {"cycles", "volume"}, first(3));
  FollowedUnit joint(*known.tracker, "joint");
  ASSERT_TRUE(joint.update(numbers(3)).counted);
  ASSERT_TRUE(joint.update(numbers(4)).counted);
  const TrackedPreset all(study, {"cycles", "volume"}, first(5));
  expect_life(joint.unit->forecast(), all.life({}), 1, 0.01);
  const double places[] = {10'000, 20'585};
  const auto path = joint.unit->ahead(places);
  EXPECT_EQ(path[0].at, 10'000);
  EXPECT_LT(path[0].level50, path[1].level50);
  EXPECT_THROW(joint.unit->ahead(std::vector<double>{9'000}), std::invalid_argument);
  const prognosis::UpdateResult sixth = joint.update(numbers(5));
  EXPECT_FALSE(sixth.contradicts);
  EXPECT_GT(sixth.p_value, 0.01);
}

TEST(JointTracker, RefusesOtherJointsAndWhatIsNoReading) {
  const TrackedPreset known(study_with("lognormal"), {"cycles", "volume"}, first(4));
  EXPECT_THAT(known.tracker->refusal("J7"), HasSubstr("one joint, called 'joint'"));
  EXPECT_EQ(known.tracker->refusal("joint"), "");
  FollowedUnit other(*known.tracker, "J7");
  EXPECT_THAT(other.update(numbers(4)).problem, HasSubstr("one joint"));
  EXPECT_TRUE(other.unit->forecast().remaining.points().empty());
  EXPECT_TRUE(std::isnan(other.unit->forecast().passed));
  const std::string bytes = other.unit->save();
  EXPECT_EQ(known.tracker->restore(bytes)->save(), bytes);
  FollowedUnit joint(*known.tracker, "joint");
  EXPECT_THAT(joint.update({8000, std::nan("")}).problem, HasSubstr("volume is missing"));
  EXPECT_THAT(joint.update({-1, 1e-9}).problem, HasSubstr("cycles must be 0 or more"));
  EXPECT_THAT(joint.update({8000, -1e-9}).problem, HasSubstr("must be positive"));
  EXPECT_EQ(joint.unit->readings(), 0u);
  // Tenfold of what all inspections say.
  EXPECT_TRUE(joint.update({8000, 400e-9}).contradicts);
}

}  // namespace
}  // namespace wearwell::joint
