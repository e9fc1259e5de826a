#include "wearwell/models/fatigue/random_limit.h"

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>

#include "wearwell/base/rng.h"
#include "wearwell/models/fatigue/limit_lattice.h"

namespace wearwell::fatigue {
namespace {

// tests/golden/random_limit.py: the law as printed, integrated over the limit with 25 digits.
TEST(RandomLimit, TenDigitsOfTheIntegral) {
  const std::map<std::string, StandardDistribution> laws = {
      {"normal", StandardDistribution::normal},
      {"sev", StandardDistribution::smallest_extreme_value}};
  const std::map<std::string, Outcome> outcomes = {{"failure", Outcome::failure},
                                                   {"runout", Outcome::runout},
                                                   {"left", Outcome::left},
                                                   {"interval", Outcome::interval}};
  std::ifstream file(PROJECT_SOURCE_DIR "/tests/golden/random_limit.csv");
  std::string line;
  std::getline(file, line);
  int compared = 0;
  while (std::getline(file, line)) {
    std::vector<std::string> c;
    std::stringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) c.push_back(cell);
    const auto x = [&](std::size_t i) { return std::stod(c[i]); };
    const LimitedLife<double> item{laws.at(c[1]), laws.at(c[2]), x(4), x(5),
                                   x(6),          x(7),          x(8), x(9)};
    const double value = log_probability(item, outcomes.at(c[3]), x(10), x(11));
    // Of a logarithm the absolute error is the integral's relative one; far out the logarithm's own
    // digits end.
    EXPECT_NEAR(value, x(12), 1e-10 * std::max(1.0, 0.01 * std::abs(x(12)))) << line;
    ++compared;
  }
  EXPECT_EQ(compared, 80);
}

// Both ways of integrating, where the lattice reaches, over items of any widths: narrow laws far apart, limits above the
// stress, lives that no item without a limit has.
TEST(RandomLimit, TheLatticeAgreesWithAdaptiveIntegration) {
  Rng rng(20261122, 1);
  constexpr auto normal = StandardDistribution::normal,
                 extreme = StandardDistribution::smallest_extreme_value;
  int reached = 0, all = 0;
  for (int i = 0; i < 3000; ++i) {
    const double s = 8.5 + rng.uniform(-0.3, 0.3);
    const LimitedLife<double> item{rng.uniform() < 0.5 ? normal : extreme,
                                   rng.uniform() < 0.5 ? normal : extreme,
                                   s,
                                   9.3,
                                   -0.15 * std::exp(rng.uniform(-1, 1)),
                                   0.2 * std::exp(rng.uniform(-4, 2)),
                                   8.4 + rng.uniform(-0.2, 0.2),
                                   0.03 * std::exp(rng.uniform(-5, 2))};
    const double at = (s - item.log10_a) / item.b + rng.uniform(-1, 2);
    const Outcome outcome = static_cast<Outcome>(i % 3);
    const LimitedLifeSlopes truth = adaptive_probability_and_slopes(item, outcome, at, 0);
    const auto quick = on_lattice(item, outcome, at);
    if (truth.value < -700) continue;
    ++all;
    if (!quick) continue;
    ++reached;
    const double room = 1e-9 * std::max(1.0, 0.1 * std::abs(truth.value));
    EXPECT_NEAR(quick->value, truth.value, room) << i;
    const auto close = [&](double a, double b) {
      if (std::isnan(b)) return;  // where slopes of the adaptive rule are beyond doubles
      EXPECT_NEAR(a, b, 1e-5 * std::max(1.0, std::abs(b))) << i << " outcome " << i % 3;
    };
    close(quick->by_log10_reversed, truth.by_log10_reversed);
    close(quick->by_log10_a, truth.by_log10_a);
    close(quick->by_b, truth.by_b);
    close(quick->by_sigma, truth.by_sigma);
    close(quick->by_location, truth.by_location);
    close(quick->by_scale, truth.by_scale);
  }
  EXPECT_GT(reached, 0.7 * all);
}

}  // namespace
}  // namespace wearwell::fatigue
