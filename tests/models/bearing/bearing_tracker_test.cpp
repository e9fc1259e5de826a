// Bearings on line against fits that have all of their inspections.
#include "wearwell/models/bearing/bearing_tracker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "models/tracked_preset.h"
#include "support/followed_unit.h"
#include "wearwell/base/error.h"

namespace wearwell::bearing {
namespace {

using prognosis::Forecast;
using testing::HasSubstr;

constexpr double um = 1e-6, hour = 3600;

const std::vector<std::string> headings = {"bearing", "clearance", "revolutions", "depth"};
using Rows = std::vector<std::vector<std::string>>;

// Of examples/bearing, five of its eight.
const Rows rows = {{"A", "25", "50000", "16.7"},  {"A", "25", "100000", "31.9"},
                   {"B", "35", "50000", "12.0"},  {"B", "35", "100000", "24.0"},
                   {"B", "35", "200000", "41.4"}, {"C", "25", "60000", "22.5"},
                   {"C", "25", "120000", "38.1"}, {"D", "30", "50000", "14.2"},
                   {"D", "30", "150000", "40.9"}, {"E", "30", "100000", "20.3"}};

std::string study_with(const std::string& likelihood, const std::string& prior,
                       const std::string& speed = "") {
  return R"toml(model = "bearing-wear"
[data]
file = "data.csv"
[data.columns]
bearing = "bearing"
clearance = { column = "clearance", unit = "um" }
revolutions = "revolutions"
depth = { column = "depth", unit = "um" }
[conditions]
contact = "stationary"
radius = "10 mm"
pressure = "1 MPa"
[likelihood]
)toml" + likelihood +
         R"toml(
[prior]
k = { distribution = "lognormal", median = "1e-6 mm^3/(N m)", log_sd = 2.5 }
)toml" + prior +
         R"toml(
[predict]
clearance = "30 um"
pressure = "1.5 MPa"
limit = "80 um"
)toml" + speed;
}

const std::string scatter = "k_scatter = { distribution = \"half-normal\", scale = 1 }\n";
const std::string sigma = "sigma = { distribution = \"half-normal\", scale = \"5 um\" }\n";

std::vector<double> numbers(double clearance, double revolutions, double depth) {
  return {clearance * um, revolutions, depth * um};
}

class OfBearing : public testing::TestWithParam<int> {
 protected:
  std::string study() const {
    switch (GetParam()) {
      case 0:
        return study_with("depth_error = \"2 um\"", scatter);
      case 1:
        return study_with("family = \"normal\"", sigma + scatter);
      case 2:
        return study_with("family = \"lognormal\"\ndepth_error = \"2 um\"", scatter);
      default:
        return study_with("family = \"normal\"", sigma);  // all alike
    }
  }
};

TEST_P(OfBearing, ASeenBearingGoesOnAsTheFitSays) {
  const TrackedPreset known(study(), headings, rows);
  for (const std::string name : {"A", "B", "E"}) {
    SCOPED_TRACE(name);
    const prognosis::UnitLife life = known.life({.unit = name});
    const Forecast forecast = known.tracker->begin(name)->forecast();
    EXPECT_EQ(forecast.now, *life.from);
    EXPECT_NEAR(forecast.passed, *life.passed, 1e-3);
    const bool sigma_unknown = GetParam() == 1 || GetParam() == 2;
    expect_life(forecast, life, 1, sigma_unknown ? 0.01 : 0.006);
  }
}

TEST_P(OfBearing, ReadingsOneByOneAreTheFitOfAll) {
  const TrackedPreset known(study(), headings, rows);
  FollowedUnit bearing(*known.tracker, "Z");
  const Forecast fresh = bearing.unit->forecast();
  expect_life(fresh, known.life({}), 1, 0.01);
  Rows all = rows;
  const std::vector<std::pair<double, double>> shown = {
      {40'000, 15.1}, {80'000, 27.3}, {120'000, 36.0}};
  for (const auto& [revolutions, depth] : shown) {
    ASSERT_TRUE(bearing.update(numbers(28, revolutions, depth)).counted);
    all.push_back({"Z", "28", std::to_string(revolutions), std::to_string(depth)});
    const bool expensive = GetParam() == 1 || GetParam() == 2;
    if (expensive && all.size() < rows.size() + shown.size()) continue;
    const TrackedPreset fitted(study(), headings, all);
    SCOPED_TRACE(revolutions);
    const Forecast forecast = bearing.unit->forecast();
    const prognosis::UnitLife life = fitted.life({.unit = "Z"});
    EXPECT_NEAR(forecast.now, *life.from, 1e-9 * *life.from);
    expect_life(forecast, life, 1, 0.012);
  }
  const std::string bytes = bearing.unit->save();
  EXPECT_EQ(known.tracker->restore(bytes)->save(), bytes);
  EXPECT_LT(bytes.size(), 80'000u);
}

INSTANTIATE_TEST_SUITE_P(Laws, OfBearing, testing::Values(0, 1, 2, 3));

TEST(BearingTracker, ALateReadingOfASeenBearing) {
  const std::string study = study_with("depth_error = \"2 um\"", scatter);
  const TrackedPreset known(study, headings, rows);
  FollowedUnit bearing(*known.tracker, "B");
  ASSERT_TRUE(bearing.update(numbers(35, 300'000, 60.5)).counted);
  ASSERT_TRUE(bearing.update(numbers(35, 250'000, 50.2)).counted);
  Rows all = rows;
  all.push_back({"B", "35", "250000", "50.2"});
  all.push_back({"B", "35", "300000", "60.5"});
  const TrackedPreset fitted(study, headings, all);
  const Forecast forecast = bearing.unit->forecast();
  EXPECT_EQ(forecast.now, 300'000);
  expect_life(forecast, fitted.life({.unit = "B"}), 1, 0.008);
  // Where the median path is at the limit the median life ends.
  const double end[] = {forecast.now + forecast.remaining.quantile(0.5)};
  EXPECT_NEAR(bearing.unit->ahead(end).front().level50, 80 * um, 0.05 * um);
}

TEST(BearingTracker, LivesInHoursWhereTheSpeedIsKnown) {
  const std::string study =
      study_with("depth_error = \"2 um\"", scatter, "speed = \"60 rpm\"\nlife_of = \"B\"\n");
  const TrackedPreset known(study, headings, rows);
  const prognosis::UnitLife asked = known.life({.unit = "B"}), said = known.life({});
  EXPECT_EQ(asked.unit, "h");
  EXPECT_NEAR(*asked.from, 200'000 / 3600.0, 1e-9);
  EXPECT_EQ(asked.of, "bearing B at 1.5 MPa");
  EXPECT_EQ(asked.life, said.life);
  const prognosis::UnitLife later = known.life({.unit = "bearing B", .survived = "70 h"});
  EXPECT_LT(later.quantile(0.5), asked.quantile(0.5));
  // Readings are in revolutions, lives on line so too.
  expect_life(known.tracker->begin("B")->forecast(), asked, hour, 0.006);
}

TEST(BearingTracker, RefusesWhatIsNoReading) {
  const std::string study = study_with("depth_error = \"2 um\"", scatter);
  const TrackedPreset known(study, headings, rows);
  FollowedUnit bearing(*known.tracker, "Z");
  EXPECT_THAT(bearing.update({std::nan(""), 1e5, 1e-5}).problem, HasSubstr("clearance is missing"));
  EXPECT_THAT(bearing.update(numbers(30, -5, 20)).problem,
              HasSubstr("revolutions must be positive"));
  EXPECT_THAT(bearing.update(numbers(30, 5e4, 3e4)).problem, HasSubstr("diameter"));
  EXPECT_THROW(bearing.update({1, 2}), InputError);
  ASSERT_TRUE(bearing.update(numbers(30, 5e4, 20)).counted);
  EXPECT_TRUE(bearing.update(numbers(30, 1e5, 400)).contradicts);
  EXPECT_THROW(known.tracker->restore("nonsense"), InputError);
  std::string bytes = bearing.unit->save();
  bytes[bytes.size() / 2] ^= 1;
  EXPECT_THROW(known.tracker->restore(bytes), InputError);
  const std::string message = [&]() -> std::string {
    try {
      known.life({.unit = "Q"});
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }();
  EXPECT_THAT(message, HasSubstr("'Q' is unknown"));
}

}  // namespace
}  // namespace wearwell::bearing
