// Places on probability paper, against R's survival package (tests/golden/plotting_positions.R) and by hand.
#include "wearwell/prob/plotting_positions.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/golden.h"

#include "wearwell/base/rng.h"
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

// Who is at risk at each failure, counted one by one.
TEST(PlottingPositions, OfManyLivesWithTiesAndEntriesAreThoseOfTheDefinition) {
  Rng rng(20261125, 0);
  std::vector<Response> all;
  std::vector<int> counts;
  for (int i = 0; i < 400; ++i) {
    const double life = std::ceil(30 * rng.uniform());
    all.push_back({.seen = rng.uniform() < 0.3 ? Censoring::right : Censoring::none, .at = life});
    if (rng.uniform() < 0.5) all.back().entry = std::floor(life * rng.uniform());
    counts.push_back(1 + i % 3);
  }
  double survival = 1;
  std::size_t found = 0;
  const auto positions = plotting_positions(all, counts);
  for (double at = 1; at <= 30; ++at) {
    double failed = 0, at_risk = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all[i].at >= at && all[i].entry < at) at_risk += counts[i];
      if (all[i].at == at && all[i].seen == Censoring::none) failed += counts[i];
    }
    if (failed == 0) continue;
    const double before = survival;
    survival *= 1 - failed / at_risk;
    ASSERT_LT(found, positions.size());
    EXPECT_EQ(positions[found].at, at);
    EXPECT_DOUBLE_EQ(positions[found].p, 1 - 0.5 * (before + survival));
    ++found;
  }
  EXPECT_EQ(found, positions.size());
}

// Turnbull's estimate is consistent with itself: each step is what all observations that can lie there bring to it.
TEST(PlottingPositions, OfManyIntervalsAreSelfConsistent) {
  Rng rng(20261125, 4);
  std::vector<Response> all;
  for (int i = 0; i < 3000; ++i) {
    const double life = 1000 * std::pow(-std::log(rng.uniform()), 0.5),
                 width = 100 + 300 * rng.uniform();
    const double looked = width * (std::floor(life / width - rng.uniform()) + rng.uniform());
    const double from = std::max(looked, 0.0), to = std::max(from + width, life);
    if (to > 1800)
      all.push_back({.seen = Censoring::right, .at = from});
    else if (from == 0)
      all.push_back({.seen = Censoring::left, .at = to});
    else
      all.push_back({.seen = Censoring::interval, .at = from, .until = to});
  }
  const auto positions = plotting_positions(all, std::vector<int>(all.size(), 1));
  const auto failed_by = [&](double at) {
    double p = 0;
    for (const PlottingPosition& each : positions) {
      if (each.at <= at) p = each.p;
    }
    return p;
  };
  ASSERT_GE(positions.size(), 20u);
  std::vector<double> brought(positions.size());
  for (const Response& y : all) {
    const double from = y.seen == Censoring::left ? -infinity : y.at;
    const double to = y.seen == Censoring::right  ? infinity
                      : y.seen == Censoring::left ? y.at
                                                  : y.until;
    const double mass = (to == infinity ? 1 : failed_by(to)) - failed_by(from);
    for (std::size_t k = 0; k < positions.size(); ++k) {
      if (positions[k].at > from && positions[k].at <= to) brought[k] += 1 / mass / 3000;
    }
  }
  for (std::size_t k = 0; k < positions.size(); ++k) {
    const double step = positions[k].p - (k == 0 ? 0 : positions[k - 1].p);
    EXPECT_NEAR(step * brought[k], step, 1e-4) << positions[k].at;
  }
}

TEST(PlottingPositions, WithoutAFailureThereAreNone) {
  const std::vector<Response> all = {{.seen = Censoring::right, .at = 3}};
  EXPECT_TRUE(plotting_positions(all, std::vector<int>(1, 5)).empty());
}

}  // namespace
}  // namespace wearwell
