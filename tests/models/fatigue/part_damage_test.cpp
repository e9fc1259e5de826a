// Parts under changing stresses against closed forms, damage summed item by item, and simulated parts.
#include "wearwell/models/fatigue/part_damage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "wearwell/math/constants.h"
#include "wearwell/models/fatigue/part_run.h"
#include "wearwell/models/fatigue/stress_lives.h"

namespace wearwell::fatigue {
namespace {

Stress amplitude(double mpa) {
  return {mpa * 1e6, 0};
}

// A posterior made by hand: points spread evenly about the middle.
ThinnedPosterior spread_points(const std::vector<double>& middle, const std::vector<double>& width,
                               Eigen::Index count = 200) {
  WeightedDraws draws;
  draws.values.resize(count, static_cast<Eigen::Index>(middle.size()));
  draws.weights.setConstant(count, 1.0 / static_cast<double>(count));
  for (Eigen::Index i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < middle.size(); ++j) {
      const double place = std::fmod(0.5 + 0.7548776662 / std::pow(1.3, double(j)) * double(i), 1);
      draws.values(i, static_cast<Eigen::Index>(j)) = middle[j] + width[j] * (place - 0.5);
    }
  }
  return ThinnedPosterior(draws, static_cast<std::size_t>(count));
}

std::vector<double> survivors_of(const ThinnedPosterior& few, const PartDamage& damage) {
  std::vector<double> weight = damage.log_survival();
  for (std::size_t i = 0; i < weight.size(); ++i) weight[i] = few.weights[i] * std::exp(weight[i]);
  return weight;
}

double sum_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double each : values) sum += each;
  return sum;
}

LoadCycles with_more(LoadCycles run, const Stress& stress, double count) {
  run.push_back({stress, count});
  return run;
}

struct LawCase {
  const char* name;
  SnLaw law;
  std::vector<double> middle, width;
};

std::vector<LawCase> law_cases() {
  std::vector<LawCase> all;
  for (const LifeFamily family : {LifeFamily::log10_normal, LifeFamily::weibull}) {
    SnLaw law;
    law.correction = MeanStress::none;
    law.family = family;
    all.push_back({"basquin", law, {9.35, -0.15, 0.15}, {0.05, 0.01, 0.05}});
    SnLaw grows = law;
    grows.scatter_grows = true;
    all.push_back({"growing scatter", grows, {9.35, -0.15, 0.15, 0.1}, {0.05, 0.01, 0.05, 0.05}});
    SnLaw limited = law;
    limited.limit = StandardDistribution::normal;
    all.push_back(
        {"random limit", limited, {9.3, -0.25, 0.2, 8.4, 0.03}, {0.04, 0.01, 0.05, 0.03, 0.01}});
    SnLaw knee = law;
    knee.curve = SnCurve::knee;
    knee.second_slope = SecondSlope::infinite;
    knee.limit = StandardDistribution::normal;
    all.push_back({"knee", knee, {8, 5.8, 0.2, 8.45, 0.04}, {1, 0.1, 0.05, 0.03, 0.02}});
    SnLaw bent = law;
    bent.curve = SnCurve::bastenaire;
    all.push_back({"bastenaire", bent, {6.6, 8.3, 0.8, 8.1, 0.2}, {0.1, 0.1, 0.1, 0.03, 0.05}});
  }
  return all;
}

const LoadCycles three_stresses = {
    {amplitude(265), 1.2e6}, {amplitude(310), 1e5}, {amplitude(400), 2e4}};

// P(survive) at one point: the same score z and limit at all stresses, limits on a dense lattice.
double dense_survival(const SnLaw& law, const double* x, const LoadCycles& run) {
  const DamageRule original{MinerRule::original, {}};
  const BlockDamage block(law, x, law.straight() ? DamageRule{} : original, run);
  const auto survives = [&](double limit) {
    if (block.log10_damage(0, limit) == -infinity) return 1.0;
    if (!law.scatter_grows)  // log10 of damage is a straight line in the score
      return 1 - cdf(law.standard(), block.log10_damage(0, limit) / x[law.sigma_index()]);
    double low = -60, high = 60;  // scores
    for (int i = 0; i < 60; ++i) {
      const double z = 0.5 * (low + high);
      (block.log10_damage(z, limit) > 0 ? low : high) = z;
    }
    return 1 - cdf(law.standard(), low);
  };
  if (!law.limit) return survives(0);
  constexpr int cells = 500;
  double sum = 0;
  for (int k = 0; k < cells; ++k) sum += survives(quantile(*law.limit, (k + 0.5) / cells));
  return sum / cells;
}

double dense_survival(const SnLaw& law, const ThinnedPosterior& few, const LoadCycles& run) {
  double sum = 0;
  for (std::size_t i = 0; i < few.weights.size(); ++i)
    sum += few.weights[i] *
           dense_survival(law, few.values.row(static_cast<Eigen::Index>(i)).data(), run);
  return sum;
}

TEST(PartDamage, IsTheDamageOfEachPartSummed) {
  for (const LawCase& each : law_cases()) {
    SCOPED_TRACE(each.name);
    const ThinnedPosterior few = spread_points(each.middle, each.width, 30);
    const PartDamage damage(each.law, few, three_stresses, amplitude(300));
    const std::vector<double> weight = survivors_of(few, damage);
    const double now = dense_survival(each.law, few, three_stresses);
    EXPECT_GT(now, 0.05);
    EXPECT_LT(now, 0.98);
    // Limits are in 40 slices at each point; without them the sum is exact.
    EXPECT_NEAR(sum_of(weight), now, each.law.limit ? 2e-3 : 1e-9);
    const prognosis::WeightedLives remaining = damage.remaining(weight);
    for (const double r : {3e3, 4e4, 3e5, 2e6, 5e7}) {
      const double left =
          dense_survival(each.law, few, with_more(three_stresses, amplitude(300), r));
      EXPECT_NEAR(remaining.cdf(r), 1 - left / now, each.law.limit ? 4e-3 : 1e-3) << r;
    }
  }
}

// One slope: accelerated failure times, so that all cycles have an equivalent at the stress ahead.
TEST(PartDamage, OfOneSlopeIsEquivalentCycles) {
  for (const LifeFamily family : {LifeFamily::log10_normal, LifeFamily::weibull}) {
    SnLaw law;
    law.correction = MeanStress::none;
    law.family = family;
    const double b = -0.15;
    const ThinnedPosterior few = spread_points({9.35, b, 0.15}, {0.05, 0, 0.05});
    double equivalent = 0;
    for (const LoadCycle& each : three_stresses)
      equivalent += each.count * std::pow(each.stress.alternating / 300e6, -1 / b);
    const LoadCycles constant = {{amplitude(300), equivalent}};
    const PartDamage changing(law, few, three_stresses, amplitude(300)),
        same(law, few, constant, amplitude(300));
    const StressLives lives(law, few, amplitude(300));
    std::vector<double> table = lives.log_survival(equivalent, 0);
    for (std::size_t i = 0; i < table.size(); ++i) {
      const double* x = few.values.row(static_cast<Eigen::Index>(i)).data();
      const double z = (std::log10(equivalent) - law.log10_life(x, std::log10(300e6))) / x[2];
      const double exact = log_survival_and_slope(law.standard(), z).value;
      EXPECT_NEAR(changing.log_survival()[i], exact, 1e-9 * (1 + std::abs(exact)));
      table[i] = few.weights[i] * std::exp(table[i]);
    }
    const auto a = changing.remaining(survivors_of(few, changing)),
               c = same.remaining(survivors_of(few, same)), t = lives.remaining(table, equivalent);
    for (const double p : {0.001, 0.01, 0.1, 0.5, 0.9, 0.99}) {
      EXPECT_NEAR(a.quantile(p) / c.quantile(p), 1, 1e-6) << p;
      EXPECT_NEAR(t.cdf(a.quantile(p)), p, 2e-3) << p;  // tables of survival
    }
    // D = n/N: the used share of a constant load.
    const std::vector<double> levels = {0.05, 0.5, 0.95};
    const auto used = changing.used(survivors_of(few, changing), std::vector<double>{0}, levels);
    for (std::size_t k = 0; k < levels.size(); ++k)
      EXPECT_NEAR(used[0][k], equivalent / (equivalent + c.quantile(1 - levels[k])), 4e-3);
  }
}

TEST(PartDamage, OrderAndDivisionOfLoadsDoNotMatter) {
  for (const LawCase& each : law_cases()) {
    SCOPED_TRACE(each.name);
    const ThinnedPosterior few = spread_points(each.middle, each.width, 40);
    LoadCycles other = {{amplitude(400), 5e3},
                        {amplitude(265), 1.2e6},
                        {amplitude(310), 4e4},
                        {amplitude(400), 1.5e4},
                        {amplitude(310), 6e4}};
    const PartDamage a(each.law, few, three_stresses, amplitude(300)),
        c(each.law, few, other, amplitude(300));
    const auto first = a.remaining(survivors_of(few, a)),
               second = c.remaining(survivors_of(few, c));
    EXPECT_NEAR(sum_of(survivors_of(few, a)), sum_of(survivors_of(few, c)), 1e-12);
    for (const double p : {0.01, 0.1, 0.4})
      EXPECT_NEAR(first.quantile(p) / second.quantile(p), 1, 1e-9);
  }
}

TEST(PartDamage, BelowEveryLimitThereIsNone) {
  const LawCase knee = law_cases()[3];
  const ThinnedPosterior few = spread_points(knee.middle, knee.width, 40);
  const PartDamage damage(knee.law, few, {{amplitude(100), 1e9}}, amplitude(100));
  EXPECT_NEAR(sum_of(survivors_of(few, damage)), 1, 1e-9);
  EXPECT_EQ(damage.remaining(survivors_of(few, damage)).quantile(0.01), infinity);
  // Where all have survived what the weak do not, the strong are left.
  const PartDamage proven(knee.law, few, {{amplitude(290), 1e9}}, amplitude(275));
  const std::vector<double> weight = survivors_of(few, proven);
  EXPECT_LT(sum_of(weight), 0.9);
  EXPECT_GT(proven.remaining(weight).quantile(0.05), 1e14);
}

// Parts drawn with their place in the scatter, their limit and damage sum: how many survive, and
// where their remaining lives lie among the forecast.
TEST(PartDamage, IsThatOfSimulatedParts) {
  std::mt19937_64 random(20260143);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  for (const LawCase& each : law_cases()) {
    SCOPED_TRACE(each.name);
    const SnLaw& law = each.law;
    const DamageSum sum{0.8, 1.5};
    const ThinnedPosterior few = spread_points(each.middle, each.width, 60);
    const Stress ahead = amplitude(300);
    const PartDamage damage(law, few, three_stresses, ahead, sum);
    const std::vector<double> weight = survivors_of(few, damage);
    const auto remaining = damage.remaining(weight);
    std::discrete_distribution<int> drawn(few.weights.begin(), few.weights.end());
    constexpr int parts = 10000;
    int survive = 0;
    std::vector<double> lives;
    for (int k = 0; k < parts; ++k) {
      const double* x = few.values.row(drawn(random)).data();
      const double z = quantile(law.standard(), uniform(random));
      const double limit = law.limit ? quantile(*law.limit, uniform(random)) : 0;
      const double at = sum.median * std::pow(sum.factor, normal(random));
      const auto life = [&](const Stress& stress) {
        const double reversed = std::log10(stress.alternating);
        const double center =
            law.limit ? law.log10_life_of_item(x, reversed, limit) : law.log10_life(x, reversed);
        return center == infinity ? infinity : std::pow(10, center + law.sigma_at(x, center) * z);
      };
      double used = 0;
      for (const LoadCycle& cycle : three_stresses) used += cycle.count / life(cycle.stress);
      if (!(used < at)) continue;
      ++survive;
      lives.push_back((at - used) * life(ahead));
    }
    const double share = sum_of(weight);
    EXPECT_NEAR(static_cast<double>(survive) / parts, share,
                4 * std::sqrt(share * (1 - share) / parts) + 2e-3);
    for (const double p : {0.02, 0.1, 0.3, 0.6, 0.9}) {
      const double r = remaining.quantile(p);
      if (!(r < 1e14)) continue;
      const auto below =
          std::count_if(lives.begin(), lives.end(), [&](double y) { return y <= r; });
      EXPECT_NEAR(static_cast<double>(below) / survive, p,
                  4 * std::sqrt(p * (1 - p) / survive) + 3e-3)
          << p;
    }
  }
}

TEST(PartRun, IsTheSameHoweverItWasRead) {
  const Stress low = amplitude(300), high = amplitude(400);
  const PartRun once = run_after({}, {{1e5, low}, {1.4e5, high}, {2e5, low}});
  const PartRun divided =
      run_after({}, {{2e5, low}, {1.2e5, high}, {5e4, low}, {1.4e5, {}}, {1e5, {}}, {1.4e5, low}});
  for (const PartRun& each : {once, divided}) {
    ASSERT_EQ(each.cycles.size(), 2u);
    EXPECT_EQ(each.cycles[0].count, 1.6e5);
    EXPECT_EQ(each.cycles[1].count, 4e4);
    EXPECT_EQ(each.now, 2e5);
    EXPECT_EQ(each.last->alternating, low.alternating);
  }
  EXPECT_TRUE(run_after({}, {{1e5, low}, {2e5, {}}}).is_under(low));
  EXPECT_FALSE(once.is_under(low));
  PartRun begun;
  begun.add(1e5, low);
  EXPECT_TRUE(run_after(begun, {{9e4, high}, {1e5, high}}).is_under(low));
}

}  // namespace
}  // namespace wearwell::fatigue
