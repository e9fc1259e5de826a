#include "wearwell/models/fatigue/life.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "all_laws.h"
#include "support/between.h"
#include "wearwell/models/fatigue/sn_likelihood.h"

namespace wearwell::fatigue {
namespace {

std::vector<SnLaw> all_laws() {
  std::vector<SnLaw> laws;
  for (const auto family : {LifeFamily::log10_normal, LifeFamily::weibull, LifeFamily::normal}) {
    SnLaw law;
    law.family = family;
    laws.push_back(law);
  }
  for (const auto family : {LifeFamily::log10_normal, LifeFamily::weibull}) {
    for (const auto limit :
         {StandardDistribution::normal, StandardDistribution::smallest_extreme_value}) {
      SnLaw law;
      law.family = family;
      law.limit = limit;
      laws.push_back(law);
    }
  }
  for (const SnLaw& law : bent_laws()) laws.push_back(law);
  return laws;
}

std::vector<double> plausible(const SnLaw& law) {
  if (!law.integrated() && !law.straight()) return plausible_bent(law, 0);
  std::vector<double> x = {9.35, -0.15, 9, law.family == LifeFamily::normal ? 3e5 : 0.3};
  if (law.limit) x.insert(x.end(), {8.25, 0.06});
  return x;
}

constexpr Stress stress{260e6, 100e6};

// The likelihood of a run-out is another way to the same number: by quadrature over the limit.
TEST(Life, SurvivalIsTheLikelihoodOfARunout) {
  for (const SnLaw& law : all_laws()) {
    const std::vector<double> x = plausible(law);
    for (const double life : {5e4, 3e5, 2e6}) {
      const double expected =
          std::exp(sn_likelihood(law, {{stress, Outcome::runout, life, 0, 1}}, 1)->value(x));
      EXPECT_NEAR(survival(law, x.data(), stress, life), expected, 1e-5);
    }
  }
}

// Laws without weight change nothing, wherever they lie.
TEST(MixedLife, LawsWithoutWeightChangeNothing) {
  for (const auto family : {LifeFamily::log10_normal, LifeFamily::weibull, LifeFamily::normal}) {
    const bool normal = family == LifeFamily::normal;
    MixedLife plain(family), with(family);
    for (MixedLife* each : {&plain, &with}) {
      each->add(0.5, normal ? 1e5 : 5, normal ? 1e4 : 0.3);
      each->add(0.5, normal ? 2e5 : 5.5, normal ? 2e4 : 0.2);
    }
    with.add(1e-14, normal ? 1e300 : 300, 1e100);
    with.add(1e-14, normal ? -1e300 : -300, 1e-3);
    with.add(1e-14, std::nan(""), 1);
    for (const double p : {0.01, 0.1, 0.5, 0.99}) {
      EXPECT_NEAR(with.quantile(p) / plain.quantile(p), 1, 1e-9) << p;
      EXPECT_NEAR(plain.cdf(plain.quantile(p)), p, 1e-9);
    }
    with.add(1e-3, std::nan(""), 1);
    EXPECT_TRUE(std::isnan(with.quantile(0.5)));
  }
}

TEST(Life, QuantileUndoesSurvival) {
  for (const SnLaw& law : all_laws()) {
    const std::vector<double> x = plausible(law);
    for (const double p : {0.01, 0.1, 0.5, 0.9}) {
      const double at = life_quantile(law, x.data(), stress, p);
      if (std::isinf(at)) continue;  // fewer ever fail
      EXPECT_NEAR(survival(law, x.data(), stress, cycles(law, at)), 1 - p, 1e-9);
    }
  }
}

// Some items never fail: where the limit is higher than the stress.
TEST(Life, HasNoEndBelowTheLimit) {
  SnLaw law;
  law.limit = StandardDistribution::normal;
  const double x[] = {9.35, -0.15, 9, 0.3, 8.45, 0.06};  // the median limit is 282 MPa
  EXPECT_EQ(life_quantile(law, x, {200e6, 0}, 0.5), INFINITY);
  EXPECT_TRUE(std::isfinite(life_quantile(law, x, {400e6, 0}, 0.5)));
}

TEST(Life, AllowedStressLastsAsLongAsItShould) {
  for (const SnLaw& law : all_laws()) {
    const std::vector<double> x = plausible(law);
    for (const double reliability : {0.1, 0.5, 0.9, 0.99}) {
      const double reversed = log10_reversed_allowed(law, x.data(), 1e6, reliability);
      for (const StressLine& line : {StressLine{100e6, {}}, StressLine{0, 0.1}}) {
        const double alternating = alternating_allowed(law, x.data(), line, reversed);
        EXPECT_NEAR(survival(law, x.data(), line.at(alternating), 1e6), reliability, 1e-6);
      }
    }
  }
}

// Draws of a posterior without end reach far; the search for a stress ends there too.
TEST(Life, AllowedStressOfParametersWithoutEnd) {
  SnLaw law;
  law.correction = MeanStress::none;
  law.limit = StandardDistribution::normal;
  for (const double a : {1e18, 400., -400., -1e18}) {
    const double x[] = {a, -0.1, 0.3, 8.4, 0.05};
    EXPECT_EQ(log10_reversed_allowed(law, x, 1e6, 0.9), std::copysign(INFINITY, a)) << a;
  }
  const double without_limit[] = {9.3, -0.1, 0.3, 1e18, 0.05},
               nothing[] = {NAN, -0.1, 0.3, 8.4, 0.05};
  EXPECT_EQ(log10_reversed_allowed(law, without_limit, 1e6, 0.9), INFINITY);
  EXPECT_TRUE(std::isnan(log10_reversed_allowed(law, nothing, 1e6, 0.9)));
}

// A mixture by hand: half of the lives about 1e4, half about 1e6, or without end.
TEST(MixedLife, ByHand) {
  MixedLife life(LifeFamily::log10_normal);
  life.add(0.5, 4, 0.1);
  life.add(0.5, 6, 0.1);
  EXPECT_NEAR(life.cdf(1e4), 0.25, 1e-12);
  EXPECT_NEAR(life.cdf(1e5), 0.5, 1e-12);
  EXPECT_NEAR(life.quantile(0.25), 1e4, 1e-4);
  EXPECT_NEAR(life.quantile(0.75), 1e6, 1e-2);
  EXPECT_NEAR(life.density(4), 0.5 * 0.3989422804014327 / 0.1, 1e-12);
  MixedLife endless(LifeFamily::log10_normal);
  endless.add(0.5, 4, 0.1);
  endless.add(0.5, INFINITY, 0.1);
  EXPECT_NEAR(endless.quantile(0.25), 1e4, 1e-4);
  EXPECT_EQ(endless.quantile(0.6), INFINITY);
}

// Thousands of laws along a bent ridge, as a quadrature leaves them.
TEST(MixedLife, MergingMovesNoLife) {
  for (const auto family : {LifeFamily::log10_normal, LifeFamily::weibull}) {
    MixedLife life(family);
    constexpr int n = 300;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        const double u = (i + 0.5) / n, v = (j + 0.5) / n;
        life.add(4 * u * v / (n * n * 1.0), 5 + u + 0.3 * v * v, 0.1 + 0.4 * v);
      }
    }
    MixedLife merged = life;
    merged.merge();
    for (const double p : {0.001, 0.01, 0.1, 0.5, 0.99}) {
      EXPECT_NEAR(merged.quantile(p) / life.quantile(p), 1, 5e-5) << p;
    }
  }
}

// What a correction takes from the alternating stress, the inverse gives back.
RC_GTEST_PROP(AlternatingStress, UndoesTheCorrection, ()) {
  const double alternating = *between(1e6, 800e6), mean = *between(1e6, 900e6);
  const double ratio = 1 - *between(1e-3, 100), gamma = *between(0.01, 1), strength = 2000e6;
  for (const MeanStress correction :
       {MeanStress::none, MeanStress::goodman, MeanStress::gerber, MeanStress::soderberg,
        MeanStress::morrow, MeanStress::swt, MeanStress::walker}) {
    for (const StressLine& line :
         {StressLine{mean, {}}, StressLine{-mean, {}}, StressLine{0, {}}, StressLine{0, ratio}}) {
      const double factor = log10_factor(correction, line.at(alternating), strength, gamma);
      if (std::isinf(factor)) continue;  // not borne, or harmless
      const double back =
          alternating_stress(correction, alternating * std::pow(10, factor), line, strength, gamma);
      RC_ASSERT(std::abs(back / alternating - 1) < 1e-6);
    }
  }
}

}  // namespace
}  // namespace wearwell::fatigue
