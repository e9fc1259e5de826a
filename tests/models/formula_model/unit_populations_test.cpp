// Units of one population, which a study has left open: each in each population against sums over dense grids, and how many of
// them reach the limit against Monte Carlo over all nodes of the posterior.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "models/formula_model/watched.h"
#include "wearwell/base/rng.h"
#include "wearwell/prognosis/common_population.h"
#include "wearwell/prognosis/fleet_risk.h"

namespace wearwell::formula_model {
namespace {

using prognosis::InPopulations;

const std::vector<double> rates_of_five = {0.8, 1.3, 1.0, 0.6, 1.1};

std::vector<Column> lines() {
  std::vector<double> depth, time;
  std::vector<std::string> unit;
  Rng rng(7, 0);
  for (std::size_t u = 0; u < rates_of_five.size(); ++u) {
    for (int i = 1; i <= 5; ++i) {
      time.push_back(i);
      depth.push_back(rates_of_five[u] * i + 0.3 * rng.normal());
      unit.push_back("u" + std::to_string(u));
    }
  }
  return {numbers("depth", depth), numbers("time", time), texts("unit", unit)};
}

// The law of one unit's rate b given readings (time, depth), SI, at one point of the parameters: on a grid of z.
struct Rate {
  std::vector<double> b, share;
  double log_likelihood = 0;

  Rate(const double* x, const std::vector<std::pair<double, double>>& readings) {
    double sum = 0;
    for (double z = -8; z <= 8; z += 0.005) {
      b.push_back(x[0] * std::exp(x[1] * z));
      double log_f = -0.5 * z * z;
      for (const auto& [time, depth] : readings) {
        const double off = (depth - b.back() * time) / x[2];
        log_f -= 0.5 * off * off + std::log(x[2] / um);
      }
      share.push_back(std::exp(log_f));
      sum += share.back();
    }
    for (double& each : share) each /= sum;
    log_likelihood = std::log(sum);
  }
  double failed_by(double time) const {
    double sum = 0;
    for (std::size_t i = 0; i < b.size(); ++i) sum += b[i] * time >= 12 * um ? share[i] : 0;
    return sum;
  }
};

std::vector<std::pair<double, double>> rows_of(const std::vector<Column>& columns, std::size_t u) {
  std::vector<std::pair<double, double>> rows;
  for (std::size_t i = 5 * u; i < 5 * u + 5; ++i)
    rows.emplace_back(columns[1].numbers[i] * h, columns[0].numbers[i] * um);
  return rows;
}

double failed(const InPopulations& unit, std::size_t k, double after) {
  return unit.passed[k] + (1 - unit.passed[k]) * unit.remaining[k].cdf(after);
}

TEST(UnitPopulations, AreSumsOverGridsByBruteForce) {
  const std::vector<std::vector<double>> x = {
      {1 * um / h, 0.3, 0.3 * um}, {1.2 * um / h, 0.5, 0.2 * um}, {0.9 * um / h, 0.2, 0.4 * um}};
  const std::vector<Column> columns = lines();
  const Watched watched(straight, columns, points(x));
  ASSERT_EQ(watched.tracker->populations().size(), 3u);
  const std::vector<std::pair<double, double>> since = {{6 * h, 7.1 * um}, {7 * h, 8.0 * um}};
  for (const bool seen : {false, true}) {
    SCOPED_TRACE(seen ? "seen" : "new");
    FollowedUnit unit(*watched.tracker, seen ? "u2" : "new");
    for (std::size_t shown = 0; shown <= since.size(); ++shown) {
      if (shown > 0) unit.update({since[shown - 1].second, since[shown - 1].first});
      const auto apart = unit.unit->in_populations([](const auto&) {});
      ASSERT_TRUE(apart);
      const double now = unit.unit->forecast().now;
      std::vector<std::pair<double, double>> before, all;
      if (seen) before = rows_of(columns, 2);
      all = before;
      all.insert(all.end(), since.begin(), since.begin() + static_cast<std::ptrdiff_t>(shown));
      // Points may come in another order: one in which each says what ours says.
      std::vector<std::vector<double>> off(3, std::vector<double>(3));
      std::vector<double> expected;
      for (std::size_t j = 0; j < 3; ++j) {
        const Rate given(x[j].data(), all);
        expected.push_back(given.log_likelihood - Rate(x[j].data(), before).log_likelihood);
        for (std::size_t k = 0; k < 3; ++k) {
          for (const double after : {2 * h, 5 * h, 9 * h})
            off[k][j] = std::max(off[k][j],
                                 std::abs(failed(*apart, k, after) - given.failed_by(now + after)));
        }
      }
      const std::vector<double>& found = apart->log_likelihood;
      std::vector<std::size_t> order = {0, 1, 2};
      double least = 1;
      do {
        double worst = 0;
        for (std::size_t k = 0; k < 3; ++k) {
          const double reported = found[k] - found[0],
                       due = expected[order[k]] - expected[order[0]];
          worst = std::max({worst, off[k][order[k]], std::abs(reported - due)});
        }
        least = std::min(least, worst);
      } while (std::next_permutation(order.begin(), order.end()));
      EXPECT_LT(least, 0.02) << shown;
    }
  }
}

// The five units of a study and twenty new ones, in all of 12,000 or so nodes of its posterior.
TEST(UnitPopulations, CountAsMonteCarloOverAllNodesOfTheFit) {
  const std::vector<Column> columns = lines();
  const Watched watched(straight, columns);
  const WeightedDraws nodes = watched.fitted();
  prognosis::KnownLives lives = prognosis::lives_of_tracker(*watched.tracker, "fit", true);
  ASSERT_EQ(lives.units.size(), 5u);
  for (int i = 0; i < 20; ++i) {
    const std::string name = "new " + std::to_string(i);
    lives.units.push_back(prognosis::known_unit(name, watched.tracker->begin(name)));
  }
  std::vector<const prognosis::KnownUnit*> units;
  for (const prognosis::KnownUnit& each : lives.units) units.push_back(&each);
  const double after[] = {5 * h, 10 * h};
  const prognosis::CommonPopulation common = prognosis::in_common(lives, units, after);
  ASSERT_TRUE(common.why.empty()) << common.why;
  constexpr int draws = 4000;
  std::vector<std::vector<int>> seen(2, std::vector<int>(26));
  Rng rng(3, 0);
  std::vector<double> cumulated(static_cast<std::size_t>(nodes.weights.size()));
  double sum = 0;
  for (std::size_t i = 0; i < cumulated.size(); ++i)
    cumulated[i] = sum += nodes.weights[static_cast<Eigen::Index>(i)];
  for (int d = 0; d < draws; ++d) {
    const auto at = std::upper_bound(cumulated.begin(), cumulated.end(), sum * rng.uniform());
    const double* x = nodes.values.row(at - cumulated.begin()).data();
    std::vector<Rate> of_seen;
    for (std::size_t u = 0; u < 5; ++u) of_seen.emplace_back(x, rows_of(columns, u));
    for (std::size_t m = 0; m < 2; ++m) {
      std::size_t count = 0;
      for (const Rate& each : of_seen) count += rng.uniform() < each.failed_by(5 * h + after[m]);
      for (int i = 0; i < 20; ++i)
        count += x[0] * std::exp(x[1] * rng.normal()) * after[m] >= 12 * um;
      ++seen[m][count];
    }
  }
  for (std::size_t m = 0; m < 2; ++m) {
    std::vector<std::vector<double>> probability;
    for (const auto& each : common.failed) probability.push_back(each[m]);
    const prognosis::Count exact = prognosis::how_many(probability, common.weight);
    double below = 0, below_seen = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
      below += exact[i];
      below_seen += static_cast<double>(seen[m][i]) / draws;
      const double error = std::sqrt(std::max(below * (1 - below), 0.0) / draws);
      EXPECT_NEAR(below_seen, below, 4 * error + 0.008) << m << " " << i;
    }
    std::vector<double> alone;
    for (const prognosis::KnownUnit* each : units)
      alone.push_back(each->passed + (1 - each->passed) * each->remaining.cdf(after[m]));
    const prognosis::Count independent = prognosis::how_many(alone);
    EXPECT_NEAR(prognosis::mean(exact), prognosis::mean(independent), 0.1);
    EXPECT_GT(prognosis::sd(exact), 1.1 * prognosis::sd(independent));
  }
}

}  // namespace
}  // namespace wearwell::formula_model
