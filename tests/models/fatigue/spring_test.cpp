#include "wearwell/models/fatigue/spring.h"

#include <gtest/gtest.h>

namespace wearwell::fatigue {
namespace {

// Shigley's Mechanical Engineering Design, 10th ed., example 10-1: music wire of 0.037 in, outer
// diameter 7/16 in (mean 0.4005 in), G = 11.85 Mpsi, 12.5 total turns, squared ends: 10.5 active.
TEST(HelicalSpring, ShigleyExample) {
  constexpr double inch = 0.0254, psi = 6894.757293168361, pound = 4.4482216152605;
  const HelicalSpring spring{0.037 * inch, 0.4005 * inch, 10.5, 11.85e6 * psi};
  EXPECT_NEAR(spring_rate(spring) / (pound / inch), 4.13, 0.02);
  // 6.46 lbf stress the wire with the Bergsträsser factor 1.123 to 148 kpsi (rounded: S_sy is 0.45
  // of 301.3 kpsi = 135.6); Wahl's factor differs from that by less than 1 %.
  const double deflection = 6.46 * pound / spring_rate(spring);
  const double expected =
      1.123 * 8 * 6.46 * 0.4005 / (3.14159265358979 * 0.037 * 0.037 * 0.037) * psi;
  EXPECT_NEAR(shear_stress(spring, deflection) / expected, 1, 0.01);
}

// Wahl's factor by hand: C = 5 gives 19/16 + 0.123; a nearly straight bar needs no correction.
TEST(HelicalSpring, WahlFactor) {
  EXPECT_DOUBLE_EQ(wahl_factor(5), 19. / 16 + 0.123);
  EXPECT_NEAR(wahl_factor(1e9), 1, 1e-8);
}

TEST(HelicalSpring, StressIsProportionalToDeflection) {
  const HelicalSpring spring{0.004, 0.03, 6, 79.3e9};
  EXPECT_DOUBLE_EQ(shear_stress(spring, 0.02), 2 * shear_stress(spring, 0.01));
}

}  // namespace
}  // namespace wearwell::fatigue
