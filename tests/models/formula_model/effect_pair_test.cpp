// The integral over two effects of a unit whose log likelihood is quadratic in them: by brute force.
#include "wearwell/models/formula_model/effect_pair.h"

#include <gtest/gtest.h>

#include <cmath>

#include "wearwell/base/rng.h"
#include "wearwell/math/constants.h"
#include "wearwell/models/formula_model/normal_unit.h"

namespace wearwell::formula_model {
namespace {

// A product rule of even steps in z, over all that is within e^-32 of the highest.
double brute_force(const EffectPair& pair) {
  constexpr int rough = 300;
  constexpr double far = 9, step = 2 * far / rough;
  double highest = -INFINITY, low[2] = {far, far}, high[2] = {-far, -far};
  for (const double below : {0.0, 32.0}) {
    for (int i = 0; i <= rough; ++i) {
      for (int j = 0; j <= rough; ++j) {
        const double z[2] = {-far + i * step, -far + j * step}, f = pair.log_f(z[0], z[1]);
        highest = std::max(highest, f);
        if (below == 0 || f < highest - 3 * below) continue;
        for (int e = 0; e < 2; ++e) {
          low[e] = std::min(low[e], z[e] - 2 * step);
          high[e] = std::max(high[e], z[e] + 2 * step);
        }
      }
    }
  }
  constexpr int fine = 1500;
  const double a = (high[0] - low[0]) / fine, b = (high[1] - low[1]) / fine;
  double sum = 0;
  for (int i = 0; i <= fine; ++i) {
    for (int j = 0; j <= fine; ++j) {
      sum += std::exp(pair.log_f(low[0] + i * a, low[1] + j * b) - highest);
    }
  }
  return highest + std::log(sum * a * b) - log_two_pi;
}

EffectPair drawn(Rng& rng) {
  EffectPair pair{};
  const double turn = 3 * rng.uniform();
  const double strong = std::exp(7 * rng.uniform()), weak = std::exp(-3 + 6 * rng.uniform());
  const double c = std::cos(turn), s = std::sin(turn);
  pair.H[0] = strong * c * c + weak * s * s;
  pair.H[1] = (strong - weak) * c * s;
  pair.H[2] = strong * s * s + weak * c * c;
  for (int e = 0; e < 2; ++e) {
    pair.lognormal[e] = rng.uniform() < 0.75;
    pair.scatter[e] = std::exp(-3 + 3.2 * rng.uniform());
    pair.best[e] = std::exp(pair.scatter[e] * rng.normal()) - 1 + 0.1 * rng.normal();
  }
  pair.correlation = 1.6 * rng.uniform() - 0.8;
  return pair;
}

TEST(EffectPair, IsWhatBruteForceSays) {
  Rng rng(20261125, 0);
  EffectPair::Nodes nodes;
  for (int i = 0; i < 30; ++i) {
    const EffectPair pair = drawn(rng);
    const auto integral = pair.log_integral(nodes);
    ASSERT_TRUE(integral) << i;
    EXPECT_NEAR(*integral, brute_force(pair), 2e-8)
        << i << " H " << pair.H[0] << " " << pair.H[1] << " " << pair.H[2] << " best "
        << pair.best[0] << " " << pair.best[1] << " scatter " << pair.scatter[0] << " "
        << pair.scatter[1] << " r " << pair.correlation;
    double all = 0;
    for (std::size_t n = 0; n < nodes.count; ++n) all += nodes.share[n];
    EXPECT_NEAR(all, 1, 1e-10);
  }
}

TEST(EffectPair, StaysBelowItsBound) {
  Rng rng(20261129, 0);
  EffectPair::Nodes nodes;
  int below = 0;
  for (int i = 0; i < 300; ++i) {
    EffectPair pair = drawn(rng);
    if (i % 2 == 1) {  // steps that the population hardly reaches
      pair.best[i % 4 / 2] += 20 * rng.uniform() - 0.9;
      pair.scatter[i % 4 / 2] *= 0.3;
    }
    const auto integral = pair.log_integral(nodes);
    if (!integral) continue;
    EXPECT_LE(*integral, pair.log_bound() + 1e-9) << i;
    below += pair.log_bound() < -3;
  }
  EXPECT_GT(below, 30);
}

// Of normal effects there is a formula; so there is of a unit without rows.
TEST(EffectPair, IsTheFormulaOfNormalEffects) {
  Rng rng(20261125, 1);
  EffectPair::Nodes nodes;
  for (int i = 0; i < 20; ++i) {
    EffectPair pair = drawn(rng);
    pair.lognormal[0] = pair.lognormal[1] = false;
    Eigen::Matrix2d H, A;
    H << pair.H[0], pair.H[1], pair.H[1], pair.H[2];
    const double r = pair.correlation;
    A << pair.scatter[0], 0, pair.scatter[1] * r, pair.scatter[1] * std::sqrt(1 - r * r);
    const NormalUnit exact({pair.best[0], pair.best[1]}, H, A);
    const auto integral = pair.log_integral(nodes);
    ASSERT_TRUE(integral);
    // Nodes end where the normal law has 1e-9 left.
    EXPECT_NEAR(*integral, exact.log_integral, 5e-9);
    const auto m = pair.moments(nodes);
    const Eigen::Vector2d first = A * exact.mean;
    const Eigen::Matrix2d second = A * exact.square * A.transpose();
    EXPECT_NEAR(m.first[0], first[0], 1e-7);
    EXPECT_NEAR(m.first[1], first[1], 1e-7);
    EXPECT_NEAR(m.second[0], second(0, 0), 1e-7);
    EXPECT_NEAR(m.second[1], second(0, 1), 1e-7);
    EXPECT_NEAR(m.second[2], second(1, 1), 1e-7);
  }
  const auto nothing =
      EffectPair{{0, 0}, {0, 0, 0}, {true, true}, {0.4, 0.3}, 0.2}.log_integral(nodes);
  ASSERT_TRUE(nothing);
  EXPECT_NEAR(*nothing, 0, 5e-9);
}

// Moments are the integral's derivatives.
TEST(EffectPair, MomentsAreSlopes) {
  Rng rng(20261125, 2);
  EffectPair::Nodes nodes;
  const auto slope = [&](const EffectPair& pair, double h, auto move) {
    EffectPair above = pair, below = pair;
    move(above, h);
    move(below, -h);
    return (*above.log_integral(nodes) - *below.log_integral(nodes)) / (2 * h);
  };
  for (int i = 0; i < 20; ++i) {
    const EffectPair pair = drawn(rng);
    ASSERT_TRUE(pair.log_integral(nodes));
    const auto m = pair.moments(nodes);
    for (int e = 0; e < 2; ++e) {
      const double by_scatter =
          slope(pair, 1e-4 * pair.scatter[e], [e](EffectPair& p, double h) { p.scatter[e] += h; });
      EXPECT_NEAR(m.slope_v[e], by_scatter, 1e-4 * (1 + std::abs(by_scatter))) << i << " " << e;
      // (s - best)' H e: by the best step.
      const double by_best = slope(pair, 1e-4, [e](EffectPair& p, double h) { p.best[e] += h; });
      const double off0 = m.first[0] - pair.best[0], off1 = m.first[1] - pair.best[1];
      EXPECT_NEAR(
          e == 0 ? pair.H[0] * off0 + pair.H[1] * off1 : pair.H[1] * off0 + pair.H[2] * off1,
          by_best, 1e-4 * (1 + std::abs(by_best)))
          << i << " " << e;
    }
    const double by_correlation =
        slope(pair, 1e-4, [](EffectPair& p, double h) { p.correlation += h; });
    EXPECT_NEAR(m.by_correlation, by_correlation, 1e-4 * (1 + std::abs(by_correlation))) << i;
  }
}

}  // namespace
}  // namespace wearwell::formula_model
