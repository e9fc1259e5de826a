#include "wearwell/prognosis/inspection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "prognosis/weibull_lives.h"
#include "wearwell/base/rng.h"

namespace wearwell::prognosis {
namespace {

// Of an exponential life inspections go on with probability exp(-interval / mean) each: E N = 1 / (1 - exp(...)). The
// expected cost until detection is least where exp(x) - x = 1 + c_i / (hidden mean), x = interval / mean (Barlow and Proschan,
// chapter 4, section 3.2).
TEST(HiddenFailure, OfAnExponentialLifeIsThatOfBarlowAndProschan) {
  const double mean = 100, hidden = 2;
  const WeightedLives lives = weibull_lives(1, mean, 40000);
  const Costs costs{50, 0, 3};
  const auto cost = [&](double interval) {
    return hidden_failure(lives, costs, hidden, interval).cost;
  };
  for (const double interval : {5.0, 20.0, 90.0}) {
    const double expected = 1 / (1 - std::exp(-interval / mean));
    const InspectedLife life = hidden_failure(lives, costs, hidden, interval);
    EXPECT_NEAR(life.inspections, expected, 1e-3 * expected);
    EXPECT_NEAR(life.cost, 3 * expected + hidden * (interval * expected - mean) + 50, 0.05);
  }
  double x = 0.2;  // Newton on exp(x) - x - 1 = c_i / (hidden mean)
  for (int i = 0; i < 50; ++i) x -= (std::exp(x) - x - 1 - 3 / (hidden * mean)) / (std::exp(x) - 1);
  double best = 0, least = 1e9;
  for (double interval = 2; interval < 60; interval += 0.05)
    if (cost(interval) < least) least = cost(interval), best = interval;
  EXPECT_NEAR(best, x * mean, 0.02 * x * mean);
}

TEST(HiddenFailure, IsWhatASimulationPays) {
  Rng rng(5, 0);
  const Costs costs{7, 0, 0.4};
  double paid = 0, time = 0;
  for (int i = 0; i < 300000; ++i) {
    const double life = std::pow(-std::log(rng.uniform()), 1 / 2.2), interval = 0.35;
    const double found = interval * std::ceil(life / interval);
    paid += costs.failure + costs.inspection * found / interval + 3 * (found - life);
    time += found;
  }
  const InspectedLife life = hidden_failure(weibull_lives(2.2, 1), costs, 3, 0.35);
  EXPECT_NEAR(life.cost / life.length / (paid / time), 1, 0.005);
}

TEST(PerfectInspection, IsWhatASimulationPays) {
  Rng rng(6, 0);
  const Costs costs{30, 4, 0.5};
  for (const double interval : {0.1, 0.3, 0.9}) {
    double paid = 0, time = 0;
    for (int i = 0; i < 300000; ++i) {
      const double life = std::pow(-std::log(rng.uniform()), 1 / 2.2);
      double at = 0;
      bool failed = life < interval;  // nobody looked before
      while (!failed) {
        at += interval;
        paid += costs.inspection;
        if (life < at + interval) break;  // seen, and replaced
      }
      paid += failed ? costs.failure : costs.replacement;
      time += failed ? life : at;
    }
    const InspectedLife life = perfect_inspection(weibull_lives(2.2, 1), costs, interval);
    EXPECT_NEAR(life.cost / life.length / (paid / time), 1, 0.007) << interval;
  }
}

TEST(CheapestInterval, IsTheLeastOfAll) {
  const WeightedLives lives = weibull_lives(2.2, 1000);
  const Costs costs{30, 4, 0.2};
  const InspectionInterval best = cheapest_interval(lives, costs);
  for (double interval = 5; interval < 1500; interval += 5) {
    const InspectedLife life = perfect_inspection(lives, costs, interval);
    EXPECT_LE(best.rate, life.cost / life.length * (1 + 1e-4)) << interval;
  }
  EXPECT_LE(best.from, best.interval);
  EXPECT_GE(best.to, best.interval);
  EXPECT_LT(best.rate, cheapest_age(lives, costs).rate);  // what is seen saves more than age
  EXPECT_EQ(cheapest_interval(lives, {30, 4, 1000}).interval,
            std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace wearwell::prognosis
