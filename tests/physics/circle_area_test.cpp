#include "wearwell/physics/circle_area.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>

#include "support/between.h"
#include "wearwell/base/error.h"

namespace wearwell {
namespace {

using std::numbers::pi;

double relative(double value, double expected) {
  return std::abs(value - expected) / std::abs(expected);
}

// tests/golden/circle_area.py, 120 digits. The promise is 1e-13.
TEST(Lune, MatchesGolden) {
  std::ifstream golden(PROJECT_SOURCE_DIR "/tests/golden/circle_area.csv");
  std::string line;
  ASSERT_TRUE(std::getline(golden, line));
  int rows = 0;
  for (; std::getline(golden, line); ++rows) {
    std::istringstream cells(line);
    double v[8];
    for (double& value : v) {
      std::string cell;
      ASSERT_TRUE(std::getline(cells, cell, ','));
      value = std::stod(cell);
    }
    SCOPED_TRACE(line);
    const Lune l = lune(v[0], v[1]);
    EXPECT_LT(relative(l.area, v[2]), 1e-14);
    EXPECT_LT(relative(l.d_sigma, v[3]), 1e-14);
    EXPECT_LT(relative(l.d_delta, v[4]), 1e-14);
    EXPECT_LT(relative(l.alpha, v[5]), 1e-14);
    EXPECT_LT(relative(l.beta, v[6]), 1e-14);
    EXPECT_LT(relative(l.half_chord, v[7]), 1e-14);
    EXPECT_EQ(lune_area(v[0], v[1]), l.area);
    EXPECT_EQ(lune_chord(v[0], v[1]), l.d_delta);
  }
  EXPECT_EQ(rows, 866);
}

RC_GTEST_PROP(Lune, GrowsWithDepthAndShrinksWithClearance, ()) {
  const double sigma = *between(1e-8, 0.5);
  const double delta = *between(1e-12, 1.9);
  const double factor = *between(1 + 1e-9, 1.05);
  RC_ASSERT(lune_area(sigma, delta * factor) > lune_area(sigma, delta));
  RC_ASSERT(lune_area(sigma * factor, delta) <= lune_area(sigma, delta));
}

// The area between two depths is at least the smaller and at most the larger of the two chords
// times the difference: the mean value theorem, with no formula shared but the chord's.
RC_GTEST_PROP(Lune, AreaGrowsByChord, ()) {
  const double sigma = *between(1e-8, 0.5);
  const double delta = *between(1e-12, 1.);
  const double next = delta * *between(1.01, 1.5);
  const double slope = (lune_area(sigma, next) - lune_area(sigma, delta)) / (next - delta);
  // The chord grows until the corners reach the pin's widest place and shrinks from there.
  const double first = lune(sigma, delta).d_delta, last = lune(sigma, next).d_delta;
  const bool passes_widest = lune(sigma, delta).alpha < pi / 2 && lune(sigma, next).alpha > pi / 2;
  RC_ASSERT(slope > std::min(first, last) * (1 - 1e-10));
  RC_ASSERT(slope < (passes_widest ? 2 : std::max(first, last)) * (1 + 1e-10));
}

// The asymptotes that circle_area.md derives, each with its first neglected term as the allowance.
RC_GTEST_PROP(Lune, ShallowAsymptote, ()) {
  const double sigma = *between(1e-8, 0.5);
  const double delta = sigma * *between(1e-12, 1e-3);
  const double limit = 4. / 3 * std::sqrt(2 * (1 + sigma) / sigma) * delta * std::sqrt(delta);
  RC_ASSERT(relative(lune_area(sigma, delta), limit) < delta / sigma + 1e-13);
}

RC_GTEST_PROP(Lune, TightFitAsymptote, ()) {
  const double delta = *between(1e-6, 1.9);
  const double sigma = delta * *between(1e-12, 1e-4);
  const double limit = 2 * std::atan(delta / std::sqrt(4 - delta * delta)) +
                       delta / 2 * std::sqrt(4 - delta * delta);
  RC_ASSERT(relative(lune_area(sigma, delta), limit) < pi * sigma / delta + 1e-13);
  RC_ASSERT(relative(lune_area(0, delta), limit) < 1e-13);
}

RC_GTEST_PROP(Lune, SmallClearanceAndDepthAsymptote, ()) {
  const double sigma = *between(1e-9, 1e-4);
  const double ratio = *between(0.01, 100);  // below, the limit as written here cancels itself
  const double tangent = std::sqrt(ratio * (2 + ratio));
  const double limit = 2 * sigma * (tangent - std::atan(tangent));
  RC_ASSERT(relative(lune_area(sigma, ratio * sigma), limit) < sigma * (1 + ratio) + 1e-12);
}

TEST(Lune, NothingOutsideAndAllOutside) {
  EXPECT_EQ(lune_area(0.1, 0), 0);
  EXPECT_EQ(lune_area(0.1, -0.05), 0);
  EXPECT_EQ(lune(0.1, -0.05).d_delta, 0);
  EXPECT_EQ(lune_area(0.1, 2), pi);
  EXPECT_EQ(lune_area(0.1, 7), pi);
  EXPECT_LT(relative(lune_area(0.1, std::nextafter(2., 0.)), pi), 1e-15);
  EXPECT_LT(relative(lune_area(0.1, std::nextafter(1., 2.)), lune_area(0.1, 1)), 3e-15);
}

TEST(Lune, RefusesNegativeClearance) {
  EXPECT_THROW(lune(-1e-9, 0.1), InputError);
  EXPECT_THROW(lune_area(-1e-9, 0.1), InputError);
  EXPECT_THROW(lune_area(std::nan(""), 0.1), InputError);
  EXPECT_THROW(lune_area(0.1, std::nan("")), InputError);
}

// Two circles of which one contains the other's centre: brute force on a fine polar grid.
TEST(AreaOutside, AgreesWithCounting) {
  const double pin = 9.5, bushing = 9.7, distance = 3.1;
  constexpr int rings = 2000, spokes = 2000;
  double counted = 0;
  for (int i = 0; i < rings; ++i) {
    const double rho = pin * (i + 0.5) / rings;
    for (int j = 0; j < spokes; ++j) {
      const double angle = 2 * pi * (j + 0.5) / spokes;
      if (std::hypot(distance + rho * std::cos(angle), rho * std::sin(angle)) > bushing)
        counted += rho * (pin / rings) * (2 * pi / spokes);
    }
  }
  EXPECT_NEAR(area_outside(pin, bushing, distance), counted, 1e-4 * counted);
}

TEST(AreaOutside, ScalesAndKeepsItsLimits) {
  EXPECT_EQ(area_outside(9.5, 9.7, 0), 0);
  EXPECT_EQ(area_outside(9.5, 9.7, 0.1), 0);
  EXPECT_DOUBLE_EQ(area_outside(9.5, 9.7, 30), pi * 9.5 * 9.5);
  EXPECT_DOUBLE_EQ(area_outside(2, 3, 1.5), 4 * lune_area(0.5, 0.25));
}

TEST(AreaOutside, RefusesImpossibleCircles) {
  EXPECT_THROW(area_outside(0, 1, 0.1), InputError);
  EXPECT_THROW(area_outside(-1, 1, 0.1), InputError);
  EXPECT_THROW(area_outside(1, 1, 0.1), InputError);
  EXPECT_THROW(area_outside(2, 1, 0.1), InputError);
  EXPECT_THROW(area_outside(1, 2, -0.1), InputError);
  EXPECT_THROW(area_outside(1, 2, std::nan("")), InputError);
  EXPECT_THROW(area_outside(std::nan(""), 2, 1), InputError);
}

}  // namespace
}  // namespace wearwell
