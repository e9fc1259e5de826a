#include "wearwell/prognosis/information.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/rng.h"

namespace wearwell::prognosis {
namespace {

// Wear grows by a rate r from 0 to a limit of 1: life 1 / r. One reading at time t shows r t with an error.
struct Wear {
  std::vector<double> life, weight;
  double at = 0, error = 0;  // of the inspection

  explicit Wear(double time, double sd) : at(time), error(sd) {
    for (int i = 0; i < 400; ++i) {
      const double z = -3.5 + 7.0 * i / 399;
      life.push_back(100 * std::exp(-0.4 * z));
      weight.push_back(std::exp(-z * z / 2));
    }
  }
  WeightedLives now() const { return {life, weight}; }

  // By a fine grid of readings.
  std::vector<Outcome> outcomes(int count = 600) const {
    std::vector<Outcome> all;
    double total = 0;
    for (int k = 0; k < count; ++k) {
      const double reading = -0.3 + 4.5 * k / count;
      Outcome outcome;
      outcome.reading = reading;
      std::vector<double> left, share;
      double alive = 0, mass = 0;
      for (std::size_t i = 0; i < life.size(); ++i) {
        const double off = (reading - at / life[i]) / error;
        const double w = weight[i] * std::exp(-off * off / 2);
        mass += w;
        if (life[i] <= at) continue;
        alive += w;
        left.push_back(life[i] - at);
        share.push_back(w);
      }
      outcome.probability = mass;
      outcome.passed = mass > 0 ? 1 - alive / mass : 1;
      outcome.remaining = WeightedLives(left, share);
      total += mass;
      if (mass > 0) all.push_back(std::move(outcome));
    }
    for (Outcome& each : all) each.probability /= total;
    return all;
  }
};

TEST(InspectionWorth, IsNeverNegativeAndNoMoreThanKnowingAll) {
  const Costs costs{20, 2, 0.1};
  const double rate = 0.06;
  double before = -1;
  for (const double error : {3.0, 0.3, 0.1, 0.03, 0.01}) {
    const Wear wear(25, error);
    const InspectionWorth worth =
        inspection_worth(wear.now(), 0, wear.outcomes(), wear.at, costs, rate);
    EXPECT_GT(worth.worth, before - 0.02) << error;  // a better gauge is worth more
    EXPECT_NEAR(worth.error, 0, 0.01) << error;
    before = worth.worth;
    // Knowing each life: replaced just before it ends, where that is worth it, or now.
    double informed = 0, mass = 0;
    for (std::size_t i = 0; i < wear.life.size(); ++i) {
      const double life = wear.life[i];
      informed += wear.weight[i] *
                  (life <= wear.at ? costs.failure - rate * life : costs.replacement - rate * life);
      mass += wear.weight[i];
    }
    EXPECT_GT(worth.with, informed / mass - 0.05) << error;
  }
  EXPECT_GT(before, 0.3);
}

// A gauge that shows nothing is worth nothing, except that deciding later is deciding the same.
TEST(InspectionWorth, OfAGaugeThatShowsNothingIsNothing) {
  const Wear wear(10, 1e4);
  const Costs costs{20, 2, 0.1};
  const InspectionWorth worth =
      inspection_worth(wear.now(), 0, wear.outcomes(), wear.at, costs, 0.06);
  EXPECT_NEAR(worth.worth, 0, 0.01);
  EXPECT_NEAR(worth.net, worth.worth - 0.1, 0.001);
}

// Units drawn, read, decided upon and run to their end.
TEST(InspectionWorth, IsWhatASimulationSaves) {
  const Wear wear(25, 0.05);
  const Costs costs{20, 2, 0.1};
  const double rate = 0.06;
  const std::vector<Outcome> outcomes = wear.outcomes();
  const InspectionWorth worth = inspection_worth(wear.now(), 0, outcomes, wear.at, costs, rate);
  std::vector<double> moments;
  for (const Outcome& each : outcomes)
    moments.push_back(each.passed < 1 ? cheapest_moment(each.remaining, costs, rate).after : 0);
  const UnitReplacement blind = cheapest_moment(wear.now(), costs, rate);
  std::vector<double> cumulated;
  double sum = 0;
  for (const double w : wear.weight) cumulated.push_back(sum += w);
  Rng rng(11, 0);
  double saved = 0, squares = 0;
  const int runs = 200000;
  const auto cost = [&](double life, double replaced) {
    return life < replaced ? costs.failure - rate * life : costs.replacement - rate * replaced;
  };
  for (int i = 0; i < runs; ++i) {
    const auto k = static_cast<std::size_t>(
        std::lower_bound(cumulated.begin(), cumulated.end(), rng.uniform() * sum) -
        cumulated.begin());
    const double life = wear.life[k];
    double informed = cost(life, 1e9);
    if (life > wear.at) {
      const double reading = wear.at / life + wear.error * rng.normal();
      const auto nearest = std::min_element(
          outcomes.begin(), outcomes.end(), [&](const Outcome& a, const Outcome& b) {
            return std::abs(a.reading - reading) < std::abs(b.reading - reading);
          });
      informed =
          cost(life, wear.at + moments[static_cast<std::size_t>(nearest - outcomes.begin())]);
    }
    const double one = cost(life, blind.after) - informed;
    saved += one;
    squares += one * one;
  }
  const double error = std::sqrt(squares) / runs;
  EXPECT_NEAR(worth.worth, saved / runs, 5 * error + 0.01);
}

}  // namespace
}  // namespace wearwell::prognosis
