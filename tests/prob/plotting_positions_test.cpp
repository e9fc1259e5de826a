// Places on probability paper, against R's survival package (tests/golden/plotting_positions.R) and by hand.
#include "wearwell/prob/plotting_positions.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/golden.h"

#include "wearwell/math/constants.h"

namespace wearwell {
namespace {

std::vector<Response> lives(const std::vector<double>& entry) {
  const double t[] = {2, 3, 3, 5, 6, 6, 8, 11, 12, 15};
  const bool failed[] = {true, true, false, true, false, true, true, false, true, false};
  std::vector<Response> all;
  for (std::size_t i = 0; i < 10; ++i) {
    all.push_back({.seen = failed[i] ? Censoring::none : Censoring::right, .at = t[i]});
    if (!entry.empty()) all.back().entry = entry[i];
  }
  return all;
}

void expect_golden(const std::string& name, const std::vector<PlottingPosition>& positions) {
  std::size_t i = 0;
  for (const auto& row : read_golden("plotting_positions.csv")) {
    if (row[0] != name) continue;
    ASSERT_LT(i, positions.size());
    EXPECT_DOUBLE_EQ(positions[i].at, std::stod(row[1]));
    EXPECT_NEAR(positions[i].p, std::stod(row[2]), 1e-12) << name << " " << row[1];
    ++i;
  }
  EXPECT_EQ(i, positions.size());
}

TEST(PlottingPositions, OfRunoutsAndEntriesAreKaplanAndMeiers) {
  const std::vector<int> counts = {1, 2, 1, 1, 3, 1, 1, 4, 1, 2};
  expect_golden("runouts", plotting_positions(lives({}), counts));
  expect_golden("entries", plotting_positions(lives({0, 0, 1, 2, 0, 4, 5, 0, 7, 3}), counts));
}

TEST(PlottingPositions, OfWholeLivesAreHalfWayUpTheirSteps) {
  const std::vector<Response> all = {{.at = 3}, {.at = 1}, {.at = 2}, {.at = 9}};
  const auto positions = plotting_positions(all, std::vector<int>(4, 1));
  ASSERT_EQ(positions.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_DOUBLE_EQ(positions[i].p, (static_cast<double>(i) + 0.5) / 4);
  }
}

// R's iteration ends a little early: beside it, no mass moved from any interval to another is likelier.
TEST(PlottingPositions, OfIntervalsAreTurnbulls) {
  const double lower[] = {-infinity, -infinity, 2, 3, 4, 4, 6, 7, 9, 10, 5};
  const double upper[] = {3, 5, 5, 6, 4, 9, 8, infinity, 12, infinity, 7};
  std::vector<Response> all;
  for (std::size_t i = 0; i < 11; ++i) {
    all.push_back({.seen = lower[i] == upper[i]    ? Censoring::none
                           : upper[i] == infinity  ? Censoring::right
                           : lower[i] == -infinity ? Censoring::left
                                                   : Censoring::interval,
                   .at = lower[i] == -infinity ? upper[i] : lower[i],
                   .until = upper[i]});
  }
  const auto positions = plotting_positions(all, std::vector<int>(11, 1));
  ASSERT_GE(positions.size(), 4u);
  for (const auto& row : read_golden("plotting_positions.csv")) {
    if (row[0] != "intervals" || std::stod(row[2]) == 1) continue;
    double p = 0;
    for (const PlottingPosition& each : positions) {
      if (each.at <= std::stod(row[1])) p = each.p;
    }
    EXPECT_NEAR(p, std::stod(row[2]), 5e-3) << row[1];
  }
}

TEST(PlottingPositions, WithoutAFailureThereAreNone) {
  const std::vector<Response> all = {{.seen = Censoring::right, .at = 3}};
  EXPECT_TRUE(plotting_positions(all, std::vector<int>(1, 5)).empty());
}

}  // namespace
}  // namespace wearwell
