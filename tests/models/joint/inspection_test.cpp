#include "wearwell/models/joint/inspection.h"

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numbers>

#include "support/between.h"
#include "wearwell/base/error.h"
#include "wearwell/physics/circle_area.h"

namespace wearwell::joint {
namespace {

using std::numbers::pi;
using testing::DoubleEq;
using testing::ElementsAre;

// By hand: 10 x 1 + 20 x 2 + 40 x 0.5 = 70, and 25 x 1 + 15 x 2 + 30 x 0.5 = 70; with other
// increments they differ.
TEST(WorkPerCycle, ByHand) {
  const std::vector<double> force{10, 20, 40};
  EXPECT_DOUBLE_EQ(work_per_cycle(force, {1, 2, 0.5}, WorkRule::rectangle), 70);
  EXPECT_DOUBLE_EQ(work_per_cycle(force, {1, 2, 0.5}, WorkRule::trapezoid), 70);
  EXPECT_DOUBLE_EQ(work_per_cycle(force, {1, 2, 3}, WorkRule::rectangle), 170);
  EXPECT_DOUBLE_EQ(work_per_cycle(force, {1, 2, 3}, WorkRule::trapezoid), 145);
}

// A profile that repeats its first row at the end is the same cycle when its first increment is 0.
TEST(WorkPerCycle, AProfileThatRepeatsItsFirstRow) {
  const std::vector<double> once{10, 20, 40}, again{10, 20, 40, 10};
  for (const WorkRule rule : {WorkRule::rectangle, WorkRule::trapezoid})
    EXPECT_DOUBLE_EQ(work_per_cycle(once, {1, 2, 3}, rule),
                     work_per_cycle(again, {0, 2, 3, 1}, rule));
}

// F = 3 + sin(t), s' = 0.01 (1 - sin(t)) over a cycle: the integral is 2 pi 0.01 (3 - 1/2). Both
// rules are exact for what is sampled at the end of each increment, up to the increments
// themselves.
TEST(WorkPerCycle, ClosedSineCycle) {
  const int n = 720;
  const double dt = 2 * pi / n;
  std::vector<double> force, slip;
  for (int i = 0; i < n; ++i) {
    const double t = i * dt, before = t - dt;
    force.push_back(3 + std::sin(t));
    slip.push_back(0.01 * (dt + std::cos(t) - std::cos(before)));
  }
  const double work = 2 * pi * 0.01 * 2.5;
  EXPECT_NEAR(work_per_cycle(force, slip, WorkRule::trapezoid), work, 1e-5 * work);
  EXPECT_NEAR(work_per_cycle(force, slip, WorkRule::rectangle), work, 1e-2 * work);
}

// The trapezoid does not care where the cycle starts.
TEST(WorkPerCycle, CycleMayStartAnywhere) {
  const std::vector<double> a{10, 20, 40}, da{1, 2, 3}, b{40, 10, 20}, db{3, 1, 2};
  EXPECT_DOUBLE_EQ(work_per_cycle(a, da, WorkRule::trapezoid),
                   work_per_cycle(b, db, WorkRule::trapezoid));
}

TEST(WorkPerCycle, MustBePositive) {
  EXPECT_THROW(work_per_cycle({1, -1}, {1, 1}, WorkRule::rectangle), InputError);
  EXPECT_THROW(work_per_cycle({-1, -1}, {1, 1}, WorkRule::trapezoid), InputError);
}

const PinGeometry geometry{9.525e-3, 9.625e-3, 10e-3};

TEST(WornVolume, AveragesOverTheRowsOfOneInspection) {
  const auto area = [](double distance) { return area_outside(9.525e-3, 9.625e-3, distance); };
  const WornVolume worn =
      worn_volume(geometry, {5, 1, 5, 1, 5}, {3e-4, 0, 0, 2e-4, 0}, {0, 0, -5e-4, 0, 1e-4});
  EXPECT_THAT(worn.cycles, ElementsAre(5, 1));
  EXPECT_THAT(worn.volume, ElementsAre(DoubleEq(10e-3 * (area(3e-4) + area(5e-4)) / 3),
                                       DoubleEq(10e-3 * area(2e-4) / 2)));
}

// Within its clearance a pin has worn nothing.
TEST(WornVolume, CentredPinHasNone) {
  EXPECT_THAT(worn_volume(geometry, {1, 2}, {0, 0.7e-4}, {0, 0.7e-4}).volume, ElementsAre(0, 0));
}

RC_GTEST_PROP(WornVolume, DoesNotDependOnDirection, ()) {
  const double distance = *between(1.05e-4, 5e-3), turn = *between(0.01, 6), tilt = *between(1, 6);
  const auto at = [&](double angle) {
    return worn_volume(geometry, {1}, {distance * std::cos(angle)}, {distance * std::sin(angle)})
        .volume[0];
  };
  RC_ASSERT(at(tilt) > 0);
  RC_ASSERT(std::abs(at(tilt + turn) / at(tilt) - 1) < 1e-10);
}

}  // namespace
}  // namespace wearwell::joint
