#include "wearwell/models/bearing/depth_function.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "support/between.h"
#include "wearwell/models/bearing/wear_number.h"

namespace wearwell::bearing {
namespace {

constexpr Contact contacts[] = {Contact::stationary, Contact::journal, Contact::bushing};

// At 1 MPa and 1e5 revolutions; k moves the wear number.
Duty duty(Contact contact, double sigma) {
  return {contact, 0.01, sigma * 0.01, 1e6, 1e5};
}

RC_GTEST_PROP(DepthFunction, IsTheInverseGeometry, ()) {
  const Contact contact = contacts[*rc::gen::inRange(0, 3)];
  const double sigma = *between(1e-5, 0.1), k = *between(1e-17, 5e-13);
  const double off = *between(0.01, 100);  // inside the tables, near their ends, and outside
  const DepthFunction curve = depth_functions({duty(contact, sigma)}, k).front();
  for (const double rate : {k, k * off, k * off * 1e-3, k * off * 1e-6, k * off * 1e-18}) {
    const double w = rate * 1e11;
    if (std::log(rate) > curve.limit()) continue;
    const double expected = 0.01 * depth_for(contact, sigma, w);
    RC_ASSERT(std::abs(curve.depth(std::log(rate)) / expected - 1) < 1e-9);
  }
}

// By a central difference of the exact inverse.
RC_GTEST_PROP(DepthFunction, SlopeIsTheDerivative, ()) {
  const Contact contact = contacts[*rc::gen::inRange(0, 3)];
  const double sigma = *between(1e-5, 0.1), k = *between(1e-16, 1e-12);
  const DepthFunction curve = depth_functions({duty(contact, sigma)}, k).front();
  const double log_k = std::log(k), h = 1e-4;
  const double expected = 0.01 *
                          (depth_for(contact, sigma, k * 1e11 * std::exp(h)) -
                           depth_for(contact, sigma, k * 1e11 * std::exp(-h))) /
                          (2 * h);
  const Dual<2> depth = curve.depth(Dual<2>(log_k, 1));
  RC_ASSERT(depth.v[0] == 0);
  RC_ASSERT(std::abs(depth.v[1] / expected - 1) < 1e-6);
  RC_ASSERT(depth.a == curve.depth(log_k));
}

TEST(DepthFunction, EndsWhereTheGeometryDoes) {
  const DepthFunction stationary =
      depth_functions({duty(Contact::stationary, 0.001)}, 1e-13).front();
  EXPECT_NEAR(std::exp(stationary.limit()) * 1e11, 0.25, 1e-4);
  EXPECT_LT(stationary.depth(stationary.limit()), 2 * 0.01);
  const DepthFunction journal = depth_functions({duty(Contact::journal, 0.001)}, 1e-13).front();
  EXPECT_NEAR(std::exp(journal.limit()) * 1e11, 0.75, 1e-4);
  EXPECT_EQ(stationary.depth(-1000), 0) << "a wear number below any double";
}

// Towards the largest wear number the depth grows ever faster: no table follows it.
TEST(DepthFunction, IsTheInverseGeometryUpToItsLimit) {
  for (const Contact contact : {Contact::stationary, Contact::journal}) {
    const DepthFunction curve = depth_functions({duty(contact, 0.001)}, 1e-13).front();
    for (double x = curve.limit() - 2; x <= curve.limit(); x += 0.003) {
      const double expected = 0.01 * depth_for(contact, 0.001, std::exp(x) * 1e11);
      ASSERT_NEAR(curve.depth(x) / expected, 1, 1e-9) << "wear number " << std::exp(x) * 1e11;
    }
  }
}

TEST(DepthFunction, SharesACurveBetweenDutiesOfOneGeometry) {
  Duty a = duty(Contact::stationary, 0.001), b = a, c = duty(Contact::journal, 0.001);
  b.revolutions = 3e5;
  const auto curves = depth_functions({a, b, c}, 1e-15);
  EXPECT_EQ(curves[0].curve, curves[1].curve);
  EXPECT_NE(curves[0].curve, curves[2].curve);
  EXPECT_NEAR(curves[1].depth(std::log(1e-15)), 0.01 * depth_for(Contact::stationary, 0.001, 3e-4),
              1e-12);
}

}  // namespace
}  // namespace wearwell::bearing
