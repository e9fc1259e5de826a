#include "wearwell/models/fatigue/damage.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "wearwell/models/fatigue/life.h"

namespace wearwell::fatigue {
namespace {

// log10_a [Pa], b, sigma, and of a random limit its location and scale.
const double x[] = {std::log10(2000e6), -0.12, 0.2, std::log10(150e6), 0.05};

SnLaw plain(MeanStress correction = MeanStress::none) {
  SnLaw law;
  law.correction = correction;
  if (correction == MeanStress::goodman) law.strength = 1200e6;
  return law;
}

SnLaw limited() {
  SnLaw law = plain();
  law.limit = StandardDistribution::normal;
  return law;
}

constexpr MinerRule rules[] = {MinerRule::original, MinerRule::elementary, MinerRule::haibach,
                               MinerRule::liu_zenner};

// The Miner life of a constant amplitude is the S-N life, whatever the rule, for every item.
TEST(BlockDamage, ConstantAmplitudeIsTheCurve) {
  for (const MeanStress correction : {MeanStress::none, MeanStress::goodman, MeanStress::swt}) {
    const SnLaw law = plain(correction);
    for (const MinerRule miner : rules) {
      const DamageRule rule{miner, {2e6, {}}};
      for (const double alternating : {200e6, 430e6, 600e6}) {
        if (alternating == 200e6 && miner != MinerRule::elementary) continue;  // below the knee
        const Stress stress{alternating, 100e6};
        const BlockDamage damage(law, x, rule, {{stress, 250.0}});
        for (const double p : {0.01, 0.1, 0.5, 0.9}) {
          const double z = quantile(law.standard(), p);
          const double blocks = std::pow(10, -damage.log10_damage(z));
          const double life = cycles(law, life_quantile(law, x, stress, p));
          EXPECT_NEAR(250 * blocks / life, 1, 1e-12) << int(miner) << " " << alternating;
        }
      }
    }
  }
}

TEST(BlockDamage, ConstantAmplitudeOfALimitIsTheCurve) {
  const SnLaw law = limited();
  const Stress stress{220e6, 0};
  const BlockDamage damage(law, x, {MinerRule::original, {}}, {{stress, 10.0}});
  for (const double v : {-2.0, 0.0, 2.0}) {
    const double life = law.log10_life_of_item(x, std::log10(220e6), v) + 0.2 * 1.5;
    EXPECT_NEAR(std::pow(10, -damage.log10_damage(1.5, v) + 1 - life), 1, 1e-12);
  }
  EXPECT_EQ(damage.log10_damage(0, 4), -INFINITY);  // its limit is 238 MPa
}

// By hand: cycles above and below a knee at 200 MPa.
TEST(BlockDamage, RulesBelowTheKnee) {
  const SnLaw law = plain();
  const LoadCycles cycles = {
      {{400e6, 0}, 10}, {{150e6, 0}, 1e5}, {{300e6, 0}, 100}, {{90e6, 0}, 1e7}};
  const double k = 1 / 0.12;
  const auto n = [&](double s) { return std::pow(s / 2000e6, -k); };
  const double above = 10 / n(400e6) + 100 / n(300e6);
  const auto damage = [&](MinerRule rule) {
    return std::pow(10, BlockDamage(law, x, {rule, {{}, 200e6}}, cycles).log10_damage(0));
  };
  EXPECT_NEAR(damage(MinerRule::original) / above, 1, 1e-12);
  EXPECT_NEAR(damage(MinerRule::elementary) / (above + 1e5 / n(150e6) + 1e7 / n(90e6)), 1, 1e-12);
  const auto haibach = [&](double s) { return n(200e6) * std::pow(200e6 / s, 2 * k - 1); };
  EXPECT_NEAR(damage(MinerRule::haibach) / (above + 1e5 / haibach(150e6) + 1e7 / haibach(90e6)), 1,
              1e-12);
  // Slope (k + 3.6)/2 through the curve at 400 MPa, down to 100 MPa.
  const auto line = [&](double s) { return n(400e6) * std::pow(400e6 / s, 0.5 * (k + 3.6)); };
  EXPECT_NEAR(
      damage(MinerRule::liu_zenner) / (10 / line(400e6) + 100 / line(300e6) + 1e5 / line(150e6)), 1,
      1e-12);
}

// A knee at a life is the item's own: stronger items have it at a higher stress.
TEST(BlockDamage, KneeAtALifeMovesWithTheItem) {
  const SnLaw law = plain();
  const DamageRule rule{MinerRule::original, {1e6, {}}};
  for (const double z : {-2.0, 0.0, 1.0}) {
    const double at = std::pow(10, x[0] + x[1] * (6 - 0.2 * z));  // lives 1e6 cycles
    EXPECT_NEAR(BlockDamage(law, x, rule, {{{at * 1.001, 0}, 1}}).log10_damage(z), -6, 0.01);
    EXPECT_EQ(BlockDamage(law, x, rule, {{{at * 0.999, 0}, 1}}).log10_damage(z), -INFINITY);
  }
}

RC_GTEST_PROP(BlockDamage, NeverFallsWhenCyclesAreAddedOrStressed, ()) {
  const SnLaw law = plain(*rc::gen::element(MeanStress::none, MeanStress::goodman));
  LoadCycles cycles;
  const int count = *rc::gen::inRange(1, 12);
  for (int i = 0; i < count; ++i)
    cycles.push_back({{1e6 * *rc::gen::inRange(20, 700), 1e6 * *rc::gen::inRange(-200, 400)},
                      0.5 * *rc::gen::inRange(1, 2000)});
  LoadCycles more = cycles;
  more.push_back({{1e6 * *rc::gen::inRange(20, 700), 1e6 * *rc::gen::inRange(-200, 400)}, 1});
  LoadCycles higher = cycles;
  for (LoadCycle& each : higher) each.stress.alternating *= 1.01;
  // Of these three: Liu and Zenner's line turns with the largest stress.
  for (const MinerRule rule : {MinerRule::original, MinerRule::elementary, MinerRule::haibach}) {
    const Knee knee{{}, 1e6 * *rc::gen::inRange(50, 400)};
    const double z = 0.1 * *rc::gen::inRange(-30, 30);
    const auto damage = [&](const LoadCycles& all) {
      return BlockDamage(law, x, {rule, knee}, all).log10_damage(z);
    };
    RC_ASSERT(damage(more) >= damage(cycles) - 1e-13);
    RC_ASSERT(damage(higher) >= damage(cycles) - 1e-13);
    double sum = 0;
    for (const double share : BlockDamage(law, x, {rule, knee}, cycles).shares(cycles))
      sum += share;
    RC_ASSERT(sum == 0 || std::abs(sum - 1) < 1e-12);
  }
}

// Twice the cycles do twice the damage.
TEST(BlockDamage, ScalesWithTheCycles) {
  const SnLaw law = plain();
  for (const MinerRule rule : rules) {
    const DamageRule with{rule, {3e6, {}}};
    const LoadCycles once = {{{400e6, 0}, 1}, {{180e6, 0}, 3e4}};
    const LoadCycles twice = {{{400e6, 0}, 2}, {{180e6, 0}, 6e4}};
    EXPECT_NEAR(BlockDamage(law, x, with, twice).log10_damage(0.3) -
                    BlockDamage(law, x, with, once).log10_damage(0.3),
                std::log10(2.0), 1e-14);
  }
}

// Where the mean stress reaches the strength one cycle is the end.
TEST(BlockDamage, BeyondTheStrength) {
  const BlockDamage damage(plain(MeanStress::goodman), x, {}, {{{10e6, 1200e6}, 1}});
  EXPECT_EQ(damage.log10_damage(0), INFINITY);
  EXPECT_EQ(damage.shares({{{10e6, 1200e6}, 1}})[0], 1);
}

}  // namespace
}  // namespace wearwell::fatigue
