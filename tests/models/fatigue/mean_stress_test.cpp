#include "wearwell/models/fatigue/mean_stress.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "support/between.h"

namespace wearwell::fatigue {
namespace {

constexpr MeanStress all[] = {MeanStress::none,      MeanStress::goodman, MeanStress::gerber,
                              MeanStress::soderberg, MeanStress::morrow,  MeanStress::swt,
                              MeanStress::walker};

double reversed(MeanStress correction, double alternating, double mean, double strength = 2000e6,
                double gamma = 0.6) {
  return alternating * std::pow(10, log10_factor(correction, {alternating, mean}, strength, gamma));
}

// By hand, with S_a = 300 MPa, S_m = 500 MPa, strength 2000 MPa, gamma = 0.6.
TEST(MeanStress, ByHand) {
  EXPECT_DOUBLE_EQ(reversed(MeanStress::none, 300e6, 500e6), 300e6);
  for (const auto each : {MeanStress::goodman, MeanStress::soderberg, MeanStress::morrow}) {
    EXPECT_NEAR(reversed(each, 300e6, 500e6), 400e6, 1);
  }
  EXPECT_NEAR(reversed(MeanStress::gerber, 300e6, 500e6), 320e6, 1);
  EXPECT_NEAR(reversed(MeanStress::swt, 300e6, 500e6), std::sqrt(800. * 300.) * 1e6, 1);
  EXPECT_NEAR(reversed(MeanStress::walker, 300e6, 500e6),
              std::pow(800, 0.4) * std::pow(300, 0.6) * 1e6, 1);
}

TEST(MeanStress, NoMeanStressIsNoCorrection) {
  for (const MeanStress each : all) EXPECT_DOUBLE_EQ(reversed(each, 300e6, 0), 300e6);
}

TEST(MeanStress, BeyondTheStrengthNothingIsBorne) {
  for (const auto each : {MeanStress::goodman, MeanStress::gerber, MeanStress::soderberg}) {
    EXPECT_EQ(reversed(each, 1e6, 2000e6), INFINITY);
    EXPECT_EQ(reversed(each, 1e6, 2100e6), INFINITY);
  }
  EXPECT_EQ(reversed(MeanStress::swt, 300e6, -300e6), 0);  // a cycle without tension does no harm
}

RC_GTEST_PROP(MeanStress, GrowsWithBothStresses, ()) {
  const double alternating = *between(1e6, 1000e6), mean = *between(1e6, 1500e6);
  const double more_alternating = alternating * *between(1, 2), more_mean = mean * *between(1, 1.3);
  for (const MeanStress each : all) {
    RC_ASSERT(reversed(each, more_alternating, mean) >=
              reversed(each, alternating, mean) * (1 - 1e-14));
    RC_ASSERT(reversed(each, alternating, more_mean) >=
              reversed(each, alternating, mean) * (1 - 1e-14));
    RC_ASSERT(reversed(each, alternating, -mean) <= alternating);
  }
}

TEST(MeanStress, Names) {
  for (const std::string& name : mean_stress_names()) {
    EXPECT_EQ(mean_stress_names()[static_cast<std::size_t>(*mean_stress_named(name))], name);
  }
  EXPECT_FALSE(mean_stress_named("Goodman").has_value());
}

// Walker's law solved for the alternating stress gives it back, however little of a cycle is in tension
// and however little the mean stress counts.
TEST(MeanStress, WalkerIsUndone) {
  for (const double gamma : {1e-6, 0.01, 0.5, 0.99, 1 - 1e-6}) {
    for (const double mean : {-1e9, -1e6, -1., 1., 1e6, 1e9}) {
      for (const double tension : {1e3, 1e6, 1e9}) {  // largest stress, of a compressive mean
        const double alternating = mean > 0 ? tension : tension - mean;
        const double log10_reversed =
            std::log10(alternating) +
            log10_factor(MeanStress::walker, Stress{alternating, mean}, 1.0, gamma);
        const double back = alternating_stress(MeanStress::walker, std::pow(10, log10_reversed),
                                               StressLine{mean, {}}, 1, gamma);
        // What is left of the largest stress beside a large mean is lost in rounding where it hardly counts.
        EXPECT_NEAR(back, alternating, 1e-7 * alternating)
            << gamma << ' ' << mean << ' ' << tension;
      }
    }
  }
}

}  // namespace
}  // namespace wearwell::fatigue
