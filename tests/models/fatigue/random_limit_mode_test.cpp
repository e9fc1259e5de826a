// Maximum likelihood of random fatigue limits on published tests, by other means than ours.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "support/golden.h"
#include "wearwell/math/minimizer.h"
#include "wearwell/models/fatigue/sn_likelihood.h"

namespace wearwell::fatigue {
namespace {

constexpr double decade = 2.302585092994046;

LifeTests laminate_panel() {
  LifeTests tests;
  for (const auto& row : read_golden("laminate_panel.csv"))
    tests.push_back({{1e6 * std::stod(row[0]), 0},
                     row[2] == "failure" ? Outcome::failure : Outcome::runout,
                     1e3 * std::stod(row[1]),
                     0,
                     1});
  return tests;
}

// In the paper's words: ln of kilocycles = beta0 + beta1 ln(S/MPa - limit) + sigma e, ln(limit/MPa) = mu + scale z.
using Paper = std::array<double, 5>;

Paper in_papers_words(const Eigen::VectorXd& x) {
  return {decade * ((6 - x[0]) / x[1] - 3), 1 / x[1], decade * x[2], decade * (x[3] - 6),
          decade * x[4]};
}

// Climbs from a rough start; the curve is told by its life at 100 MPa above the limit, which is about straight below the
// parameter b, and widths by their logarithms.
Minimum climb(const LogDensity& likelihood) {
  const auto natural = [](std::span<const double> u) {
    return std::array{8 - u[1] * u[0], u[1], std::exp(u[2]), u[3], std::exp(u[4])};
  };
  const Objective objective = [&](std::span<const double> scaled, std::span<double> gradient) {
    const std::array u = {scaled[0], 0.1 * scaled[1], scaled[2], 0.1 * scaled[3], scaled[4]};
    const auto x = natural(u);
    std::array<double, 5> g{};
    const double value = likelihood.value_and_gradient(x, g);
    if (!gradient.empty()) {
      gradient[0] = u[1] * g[0];
      gradient[1] = 0.1 * (u[0] * g[0] - g[1]);
      gradient[2] = -x[2] * g[2];
      gradient[3] = -0.1 * g[3];
      gradient[4] = -x[4] * g[4];
    }
    return -value;
  };
  Minimum found = minimize(
      objective, Eigen::Vector<double, 5>(6, -2, std::log(0.2), 83.3, std::log(0.02)), 2000);
  const Eigen::VectorXd& s = found.position;
  const auto x = natural(std::array{s[0], 0.1 * s[1], s[2], 0.1 * s[3], s[4]});
  found.position = Eigen::Map<const Eigen::VectorXd>(x.data(), 5);
  return found;
}

// tests/golden/random_limit_mode.R: the laminate panel of Pascual and Meeker (1999), normal and smallest extreme value laws of
// life and limit. Their own normal-normal fit, 30.27, -5.100 and a log likelihood of -86.22 where densities are those of the
// logarithm of life, was quoted from memory before R's was computed; the paper itself was not at hand.
TEST(RandomLimitMode, OfTheLaminatePanelAsInR) {
  const LifeTests tests = laminate_panel();
  ASSERT_EQ(tests.size(), 125u);
  double failures = 0, logarithms = 0;
  for (const LifeTest& test : tests) {
    if (test.outcome != Outcome::failure) continue;
    ++failures;
    logarithms += std::log(test.life / 1e3);
  }
  EXPECT_EQ(failures, 115);
  int compared = 0;
  for (const auto& row : read_golden("random_limit_mode.csv")) {
    SnLaw law;
    law.correction = MeanStress::none;
    law.family = row[0] == "normal" ? LifeFamily::log10_normal : LifeFamily::weibull;
    law.limit = row[1] == "normal" ? StandardDistribution::normal
                                   : StandardDistribution::smallest_extreme_value;
    const Minimum mode = climb(*sn_likelihood(law, tests, tests.size()));
    const Paper found = in_papers_words(mode.position);
    for (std::size_t i = 0; i < found.size(); ++i) {
      const double value = std::stod(row[2 + i]);
      EXPECT_NEAR(found[i], value, 3e-5 * std::abs(value)) << row[0] << " " << row[1] << " " << i;
    }
    // A density per cycle is a thousandth of one per kilocycle.
    const double log_likelihood = -mode.value + failures * std::log(1e3);
    EXPECT_NEAR(log_likelihood, std::stod(row[7]), 1e-6) << row[0] << " " << row[1];
    if (compared++ > 0) continue;
    EXPECT_NEAR(found[0], 30.27, 0.005);
    EXPECT_NEAR(found[1], -5.100, 0.0005);
    EXPECT_NEAR(log_likelihood + logarithms, -86.22, 0.005);
  }
  EXPECT_EQ(compared, 4);
}

}  // namespace
}  // namespace wearwell::fatigue
