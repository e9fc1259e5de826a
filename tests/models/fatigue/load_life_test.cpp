#include "wearwell/models/fatigue/load_life.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/models/fatigue/life.h"
#include "wearwell/models/fatigue/load_cycles.h"

namespace wearwell::fatigue {
namespace {

// A posterior of so many draws, about the study of examples/fatigue.
SnResult posterior(int draws, bool limit = false) {
  SnResult result;
  result.law.correction = MeanStress::goodman;
  if (limit) result.law.limit = StandardDistribution::normal;
  result.parameters = {"log10_a", "b", "log10_Sut", "sigma"};
  result.stress_unit = read_unit("MPa", "Pa");
  result.tested = {200e6, 450e6, 0, 350e6, 1e4, 2e6, 25, 22};
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  Points& values = result.posterior.values;
  values.resize(draws, limit ? 6 : 4);
  result.posterior.weights.setConstant(draws, 1.0 / draws);
  for (int i = 0; i < draws; ++i) {
    const double u = normal(random);
    auto row = values.row(i);
    row[0] = std::log10(2000e6) + 0.02 * u;
    row[1] = -0.12 - 0.003 * u + 0.001 * normal(random);
    row[2] = std::log10(1200e6) + 0.01 * normal(random);
    row[3] = 0.18 * std::exp(0.12 * normal(random));
    if (!limit) continue;
    row[4] = std::log10(170e6) + 0.01 * normal(random);
    row[5] = 0.03 * std::exp(0.2 * normal(random));
  }
  if (limit) result.parameters.insert(result.parameters.end(), {"log10_limit", "sigma_limit"});
  return result;
}

const LoadCycles history = {
    {{330e6, 60e6}, 3}, {{260e6, 20e6}, 40}, {{180e6, 80e6}, 900}, {{120e6, 10e6}, 2e4}};

// What happens to one item after the other: parameters, place, damage sum are drawn, damage is summed
// cycle by cycle along the curve as it is written in docs/reference/fatigue.md.
std::vector<double> lives_one_by_one(const SnResult& result, const LoadQuestion& question,
                                     int items, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_int_distribution<Eigen::Index> any(0, result.posterior.values.rows() - 1);
  std::vector<double> lives;
  for (int i = 0; i < items; ++i) {
    const double* x = result.posterior.values.row(any(random)).data();
    const double strength = std::pow(10, x[2]), z = normal(random);
    const double limit = result.law.limit ? std::pow(10, x[4] + x[5] * normal(random)) : 0;
    double damage = 0;
    for (const LoadCycle& cycle : history) {
      const double reversed = cycle.stress.alternating / (1 - cycle.stress.mean / strength);
      if (reversed <= limit) continue;
      const auto life = [&](double stress) {
        return std::pow((stress - limit) / std::pow(10, x[0]), 1 / x[1]) * std::pow(10, x[3] * z);
      };
      double n = life(reversed);
      if (question.rule.miner == MinerRule::haibach && n > *question.rule.knee.life) {
        const double knee_life = *question.rule.knee.life;
        const double knee = std::pow(10, x[0]) * std::pow(knee_life / std::pow(10, x[3] * z), x[1]);
        n = knee_life * std::pow(knee / reversed, -2 / x[1] - 1);
      }
      damage += cycle.count / n;
    }
    const double sum = question.sum.median * std::pow(question.sum.factor, normal(random));
    lives.push_back(damage > 0 ? sum / damage : INFINITY);
  }
  std::sort(lives.begin(), lives.end());
  return lives;
}

// Shares of items below the quantiles, to four standard errors of so many items.
void expect_same(const LoadLife& life, const std::vector<double>& lives) {
  const auto n = static_cast<double>(lives.size());
  const auto below = [&](double at) {
    return static_cast<double>(std::lower_bound(lives.begin(), lives.end(), at) - lives.begin()) /
           n;
  };
  const auto expect = [&](double at, double p) {
    const double error = 4 * std::sqrt(p * (1 - p) / n) + 2e-4;
    if (std::isinf(at)) {
      EXPECT_LE(below(1e300), p + error);
    } else {
      EXPECT_NEAR(below(at), p, error) << at;
    }
  };
  expect(life.next05, 0.05);
  expect(life.next50, 0.5);
  expect(life.next95, 0.95);
  for (const BlockLife& each : life.lives) expect(each.next, each.percent / 100);
}

TEST(LoadLife, IsThatOfItemsOneByOne) {
  const SnResult result = posterior(4000);
  LoadQuestion question;
  question.sum = {0.7, 1.5};
  expect_same(load_life(result, history, question), lives_one_by_one(result, question, 200'000, 1));
  question.rule = {MinerRule::haibach, {1e6, {}}};
  expect_same(load_life(result, history, question), lives_one_by_one(result, question, 200'000, 2));
}

// A point of weight k counts as k points: a posterior of uneven weights against one with copies.
TEST(LoadLife, AWeightCountsAsCopies) {
  const SnResult few = posterior(300);
  SnResult weighted = few, copied = few;
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < 300; ++i) {
    const int copies = 1 + static_cast<int>(i % 4);
    weighted.posterior.weights[i] = copies / 750.0;
    rows.insert(rows.end(), static_cast<std::size_t>(copies), i);
  }
  copied.posterior.values = few.posterior.values(rows, Eigen::all);
  copied.posterior.weights.setConstant(750, 1.0 / 750);
  LoadQuestion question;
  question.sum = {1, 1};
  const LoadLife a = load_life(weighted, history, question);
  const LoadLife b = load_life(copied, history, question);
  EXPECT_NEAR(a.next05 / b.next05, 1, 1e-9);
  EXPECT_NEAR(a.sd / b.sd, 1, 1e-9);
  EXPECT_NEAR(a.shares[0], b.shares[0], 1e-12);
  for (std::size_t i = 0; i < a.lives.size(); ++i) {
    EXPECT_NEAR(a.lives[i].bound / b.lives[i].bound, 1, 1e-9);
    EXPECT_NEAR(a.lives[i].next / b.lives[i].next, 1, 1e-9);
  }
  for (std::size_t i = 0; i < a.contributions.size(); ++i)
    EXPECT_NEAR(a.contributions[i].share, b.contributions[i].share, 1e-9);
}

TEST(LoadLife, IsThatOfItemsWithLimitsOneByOne) {
  const SnResult result = posterior(2000, true);
  LoadQuestion question;
  question.rule.miner = MinerRule::original;
  question.sum = {1, 1.3};
  expect_same(load_life(result, history, question), lives_one_by_one(result, question, 200'000, 3));
}

// Where only the damage sum is unknown, B10 is lognormal as it is.
TEST(LoadLife, BoundsOfAKnownCurve) {
  SnResult result = posterior(1);
  result.posterior.values = result.posterior.values.replicate(2000, 1).eval();
  result.posterior.weights.setConstant(2000, 1.0 / 2000);
  LoadQuestion question;
  question.sum = {0.5, 2};
  const LoadLife life = load_life(result, history, question);
  const double z = quantile(StandardDistribution::normal, 0.1);
  const double b10 =
      0.5 *
      std::pow(10, -BlockDamage(result.law, result.posterior.values.row(0).data(), {}, history)
                        .log10_damage(z));
  EXPECT_NEAR(life.lives[1].q50 / b10, 1, 1e-3);
  EXPECT_NEAR(life.lives[1].bound / (b10 * std::pow(2, z)), 1, 2e-3);
  // The scatter of items and of the sum, and nothing else.
  ASSERT_EQ(life.contributions.size(), 6u);
  const double items = std::pow(result.posterior.values(0, 3), 2),
               sum = std::pow(std::log10(2.0), 2);
  EXPECT_NEAR(life.contributions[4].share, items / (items + sum), 2e-3);
  EXPECT_NEAR(life.sd, std::sqrt(items + sum), 2e-3 * life.sd);
}

TEST(LoadLife, ConstantAmplitudeHasTheLivesOfTheStudy) {
  const SnResult result = posterior(4000);
  LoadQuestion question;
  question.percents = {10};
  const Stress stress{300e6, 50e6};
  const LoadLife life = load_life(result, {{stress, 1}}, question);
  MixedLife next(result.law.family);
  for (Eigen::Index i = 0; i < result.posterior.values.rows(); ++i) {
    const double* x = result.posterior.values.row(i).data();
    add_life(next, 1.0 / 4000, result.law, x, result.law.log10_reversed(x, stress));
  }
  EXPECT_NEAR(life.lives[0].next / next.quantile(0.1), 1, 1e-3);
  EXPECT_NEAR(life.next50 / next.quantile(0.5), 1, 1e-3);
}

TEST(LoadLife, TellsWhatIsExtrapolated) {
  const SnResult result = posterior(200);
  const LoadLife life =
      load_life(result, {{{500e6, 0}, 1}, {{300e6, 0}, 1}, {{100e6, 400e6}, 1}}, {});
  EXPECT_NEAR(life.above, life.shares[0], 1e-15);
  EXPECT_NEAR(life.below, life.shares[2], 1e-15);
  EXPECT_NEAR(life.beyond_mean, life.shares[2], 1e-15);
  EXPECT_NEAR(std::accumulate(life.shares.begin(), life.shares.end(), 0.0), 1, 1e-12);
  EXPECT_GT(life.above, 0.9);
}

TEST(LoadLife, RefusesWhatHasNoSum) {
  SnResult result = posterior(10);
  LoadQuestion question;
  question.rule.miner = MinerRule::haibach;
  EXPECT_NE(message_of<InputError>([&] { load_life(result, history, question); }).find("--knee"),
            std::string::npos);
  result.law.family = LifeFamily::normal;
  EXPECT_NE(
      message_of<InputError>([&] { load_life(result, history, {}); }).find("normal in cycles"),
      std::string::npos);
  result = posterior(10, true);
  EXPECT_NE(message_of<InputError>([&] { load_life(result, history, {}); }).find("original"),
            std::string::npos);
}

// Two columns of correlation r and slopes 1 and 2: Shapley's values by hand (Song et al. 2016, eq. 4).
TEST(VarianceShares, OfTwoThatDepend) {
  constexpr int n = 200'000;
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  Points x(n, 2);
  Eigen::VectorXd y(n);
  const double r = 0.6;
  for (int i = 0; i < n; ++i) {
    x(i, 0) = normal(random);
    x(i, 1) = r * x(i, 0) + std::sqrt(1 - r * r) * normal(random);
    y[i] = x(i, 0) + 2 * x(i, 1);
  }
  const double all = 1 + 4 + 4 * r;
  const double first = (1 + 2 * r + r * r * (4 - 1) / 2) / all;
  const std::vector<double> shares =
      variance_shares({x, Eigen::VectorXd::Constant(n, 1.0 / n), {}, {}}, y);
  EXPECT_NEAR(shares[0], first, 0.01);
  EXPECT_NEAR(shares[0] + shares[1], 1, 1e-10);
  EXPECT_NEAR(shares[2], 0, 1e-10);
}

// Near stresses become one; their damage stays.
TEST(Reduced, KeepsTheDamage) {
  std::mt19937_64 random(3);
  std::gamma_distribution<double> gamma(2, 40e6);
  std::normal_distribution<double> normal(30e6, 30e6);
  LoadCycles many;
  for (int i = 0; i < 40'000; ++i) many.push_back({{gamma(random) + 1e6, normal(random)}, 0.5});
  const SnResult result = posterior(1);
  const LoadCycles few = reduced(many, 2048, true);
  EXPECT_LE(few.size(), 2048u);
  double count = 0;
  for (const LoadCycle& each : few) count += each.count;
  EXPECT_NEAR(count, 20'000, 1e-6);
  const auto damage = [&](const LoadCycles& cycles) {
    return BlockDamage(result.law, result.posterior.values.row(0).data(), {}, cycles)
        .log10_damage(0);
  };
  EXPECT_NEAR(damage(few), damage(many), 2e-3);
  EXPECT_LE(reduced(many, 512, false).size(), 512u);
}

}  // namespace
}  // namespace wearwell::fatigue
