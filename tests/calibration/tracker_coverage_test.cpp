// Units on line, their remaining useful lives: 2,000 of them with 3, 5 and 10 readings each, each of a population of its own that
// was learned from 5 units. Truths are drawn from the priors, where the share is 90 % by the laws of probability if all is
// right, or held fixed, where nothing promises it. WEARWELL_REPLICATIONS says how many populations.
#include "calibration/tracker_coverage.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

namespace wearwell::formula_model {
namespace {

int populations() {
  const char* wanted = std::getenv("WEARWELL_REPLICATIONS");
  return wanted ? std::max(20, std::atoi(wanted)) : 2000;
}

void expect_coverage(const char* name, const std::vector<double>& fixed, double margin) {
  const int count = populations(), units = 1;
  const TrackedCoverage coverage =
      tracked_coverage(fixed, count, units, fixed.empty() ? 0 : 100000);
  EXPECT_EQ(coverage.failed, 0);
  for (std::size_t s = 0; s < coverage.of.size(); ++s) {
    const TrackedCoverage::Count& each = coverage.of[s];
    double chi_squared = 0;
    for (const int bin : each.bins) {
      const double expected = each.units / 20.0;
      chi_squared += (bin - expected) * (bin - expected) / expected;
    }
    const double error = std::sqrt(0.09 / each.units);
    std::printf(
        "%s, %2d readings, %d units: %.1f %% +- %.1f (truth shorter %.1f, longer %.1f; "
        "chi-squared of 20 bins %.0f)\n",
        name, TrackedCoverage::shown[s], each.units, 100 * each.share(), 100 * error,
        100.0 * each.shorter / each.units, 100.0 * each.longer / each.units, chi_squared);
    EXPECT_NEAR(each.share(), 0.9, margin + (count < 1000 ? 4 * error : 0));
  }
  std::fflush(stdout);
}

TEST(TrackerCoverage, OfTruthsFromThePriors) {
  expect_coverage("drawn", {}, 0.015);
}

// Readings of 0.3 um, rates that differ by 0.3.
TEST(TrackerCoverage, OfOneTruth) {
  expect_coverage("fixed", {1e-6 / 3600, 0.3, 0.3e-6}, 0.03);
}

}  // namespace
}  // namespace wearwell::formula_model
