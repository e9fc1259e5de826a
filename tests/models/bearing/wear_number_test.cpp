#include "wearwell/models/bearing/wear_number.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>
#include <sstream>
#include <string>

#include "support/between.h"
#include "wearwell/base/error.h"

namespace wearwell::bearing {
namespace {

using std::numbers::pi;

double relative(double value, double expected) {
  return std::abs(value - expected) / std::abs(expected);
}

rc::Gen<Contact> contacts() {
  return rc::gen::element(Contact::stationary, Contact::journal, Contact::bushing);
}

// Ligterink and de Gee (1996), the two worked examples: r = 0.02 m, clearance 2e-5 m, depth 1e-4 m;
// sigma = 20e-4, wear number 2e-4. Digits from tests/golden/bearing_examples.py; the paper reads
// 7e-4 and slightly below 19e-4 off its charts.
TEST(WearNumber, WorkedExamples) {
  EXPECT_LT(
      relative(wear_number(Contact::stationary, 2e-5 / 0.02, 1e-4 / 0.02), 7.185812700472977e-4),
      1e-14);
  EXPECT_LT(relative(depth_for(Contact::stationary, 20e-4, 2e-4), 18.67228112810098e-4), 1e-14);
}

// By hand: journal (2 x 0.005 + 0.005^2)/4; bushing (2 x 1.001 x 0.005 + 0.005^2)/4.
TEST(WearNumber, EvenWear) {
  EXPECT_DOUBLE_EQ(wear_number(Contact::journal, 0.001, 0.005), 2.50625e-3);
  EXPECT_DOUBLE_EQ(wear_number(Contact::bushing, 0.001, 0.005), 2.50875e-3);
}

// The lune's area A by tests/golden/circle_area.py gives the depth back. Above delta = 1 the
// inverse is ill-conditioned (a lune that is nearly the whole circle), so only below.
TEST(DepthFor, InvertsGoldenLunes) {
  std::ifstream golden(PROJECT_SOURCE_DIR "/tests/golden/circle_area.csv");
  std::string line;
  ASSERT_TRUE(std::getline(golden, line));
  int rows = 0;
  while (std::getline(golden, line)) {
    double v[3];
    std::istringstream cells(line);
    for (double& value : v) {
      std::string cell;
      ASSERT_TRUE(std::getline(cells, cell, ','));
      value = std::stod(cell);
    }
    if (v[1] > 1) continue;
    EXPECT_LT(relative(depth_for(Contact::stationary, v[0], v[2] / (4 * pi)), v[1]), 1e-14) << line;
    ++rows;
  }
  EXPECT_EQ(rows, 807);
}

RC_GTEST_PROP(WearNumber, DeeperIsMore, ()) {
  const Contact contact = *contacts();
  const double sigma = *between(1e-8, 0.5), delta = *between(1e-12, 0.9);
  const double deeper = delta * *between(1 + 1e-12, 1.1);
  RC_ASSERT(wear_number(contact, sigma, deeper) >= wear_number(contact, sigma, delta));
}

RC_GTEST_PROP(DepthFor, RoundTripFromDepth, ()) {
  const Contact contact = *contacts();
  const double sigma = *between(1e-8, 0.5), delta = *between(1e-12, 1.);
  const double back = depth_for(contact, sigma, wear_number(contact, sigma, delta));
  RC_ASSERT(relative(back, delta) < 1e-12);
}

RC_GTEST_PROP(DepthFor, RoundTripFromWearNumber, ()) {
  const Contact contact = *contacts();
  const double sigma = *between(1e-10, 10.), w = *between(1e-15, 0.249999);
  const double back = wear_number(contact, sigma, depth_for(contact, sigma, w));
  RC_ASSERT(relative(back, w) < 1e-12);
}

// For the same worn volume a scar must be deeper than even wear: it covers only part of the circle.
RC_GTEST_PROP(DepthFor, StationaryExceedsEvenWear, ()) {
  const double sigma = *between(1e-8, 0.5), w = *between(1e-14, 0.24);
  const double scar = depth_for(Contact::stationary, sigma, w);
  RC_ASSERT(scar > depth_for(Contact::bushing, sigma, w));
  RC_ASSERT(scar > depth_for(Contact::journal, sigma, w));
}

// delta << sigma: w = sqrt(2 (1 + sigma)/sigma) delta^(3/2) / (3 pi); sigma << delta << 1:
// w = delta/(2 pi) (physics/circle_area.md).
RC_GTEST_PROP(DepthFor, StationaryAsymptotes, ()) {
  const double sigma = *between(1e-6, 0.5);
  const double delta = sigma * *between(1e-9, 1e-4);
  const double shallow = std::sqrt(2 * (1 + sigma) / sigma) * std::pow(delta, 1.5) / (3 * pi);
  RC_ASSERT(relative(depth_for(Contact::stationary, sigma, shallow), delta) <
            delta / sigma + 1e-12);
  const double deep = *between(1e-4, 1e-2);
  const double tight = deep * 1e-8;
  RC_ASSERT(relative(depth_for(Contact::stationary, tight, deep / (2 * pi)), deep) <
            deep * deep + 1e-7);
}

RC_GTEST_PROP(WearNumber, DerivativesAreSlopes, ()) {
  const Contact contact = *contacts();
  const double sigma = *between(1e-6, 0.5), delta = *between(1e-8, 0.9);
  const WearNumber at = wear_number_and_derivatives(contact, sigma, delta);
  RC_ASSERT(at.value == wear_number(contact, sigma, delta));
  const double h = 1e-4;
  const auto by_delta = (wear_number(contact, sigma, delta * (1 + h)) -
                         wear_number(contact, sigma, delta * (1 - h))) /
                        (2 * h * delta);
  const auto by_sigma = (wear_number(contact, sigma * (1 + h), delta) -
                         wear_number(contact, sigma * (1 - h), delta)) /
                        (2 * h * sigma);
  RC_ASSERT(relative(at.d_delta, by_delta) < 1e-7);
  // What rounding leaves of the difference: ten units of the last digit of the value.
  RC_ASSERT(std::abs(at.d_sigma - by_sigma) <
            1e-7 * std::abs(at.d_sigma) + 2e-15 * at.value / (h * sigma));
}

TEST(DepthFor, EndsOfItsRange) {
  for (const Contact contact : {Contact::stationary, Contact::journal, Contact::bushing}) {
    EXPECT_EQ(wear_number(contact, 0.01, 0), 0);
    EXPECT_EQ(depth_for(contact, 0.01, 0), 0);
  }
  EXPECT_DOUBLE_EQ(depth_for(Contact::journal, 0.01, 0.75), 1);
  const double nearly_all = std::nextafter(0.25, 0);
  EXPECT_LT(depth_for(Contact::stationary, 0.01, nearly_all), 2);
  EXPECT_DOUBLE_EQ(
      wear_number(Contact::stationary, 0.01, depth_for(Contact::stationary, 0.01, nearly_all)),
      nearly_all);
}

TEST(WearNumber, RefusesImpossibleInputs) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Contact contact : {Contact::stationary, Contact::journal, Contact::bushing}) {
    EXPECT_THROW(wear_number(contact, 0, 0.1), InputError);
    EXPECT_THROW(wear_number(contact, -0.1, 0.1), InputError);
    EXPECT_THROW(wear_number(contact, nan, 0.1), InputError);
    EXPECT_THROW(wear_number(contact, 0.1, -0.1), InputError);
    EXPECT_THROW(wear_number(contact, 0.1, nan), InputError);
    EXPECT_THROW(depth_for(contact, -0.1, 0.1), InputError);
    EXPECT_THROW(depth_for(contact, 0.1, -0.1), InputError);
    EXPECT_THROW(depth_for(contact, 0.1, nan), InputError);
  }
  EXPECT_THROW(wear_number(Contact::stationary, 0.1, 2), InputError);
  EXPECT_THROW(wear_number_and_derivatives(Contact::stationary, 0.1, 2), InputError);
  EXPECT_THROW(wear_number(Contact::journal, 0.1, 1.01), InputError);
  EXPECT_NO_THROW(wear_number(Contact::bushing, 0.1, 3));
  EXPECT_THROW(depth_for(Contact::stationary, 0.1, 0.25), InputError);
  EXPECT_THROW(depth_for(Contact::journal, 0.1, 0.76), InputError);
}

}  // namespace
}  // namespace wearwell::bearing
