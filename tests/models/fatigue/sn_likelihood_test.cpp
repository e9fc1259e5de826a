#include "wearwell/models/fatigue/sn_likelihood.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "all_laws.h"
#include "support/between.h"

namespace wearwell::fatigue {
namespace {

// Tests of every outcome under several stresses.
LifeTests some_tests() {
  return {{{300e6, 100e6}, Outcome::failure, 1e5, 0, 1},
          {{250e6, 120e6}, Outcome::failure, 4e5, 0, 2},
          {{200e6, 50e6}, Outcome::runout, 2e6, 0, 3},
          {{320e6, 30e6}, Outcome::left, 2e5, 0, 1},
          {{230e6, 200e6}, Outcome::interval, 1e5, 8e5, 1}};
}

std::vector<SnLaw> all_laws() {
  std::vector<SnLaw> laws;
  for (int c = 0; c < 7; ++c) {
    for (const auto family : {LifeFamily::log10_normal, LifeFamily::weibull, LifeFamily::normal}) {
      SnLaw law;
      law.correction = static_cast<MeanStress>(c);
      law.family = family;
      laws.push_back(law);
    }
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

// Plausible parameters of a law, and steps of a thousandth of their plausible changes.
std::vector<double> plausible(const SnLaw& law, double shift) {
  if (!law.integrated() && !law.straight()) return plausible_bent(law, shift);
  std::vector<double> x = {9.35 + 0.05 * shift, -0.15 - 0.01 * shift};
  if (law.has_strength()) x.push_back(9 + 0.1 * shift);
  if (law.has_gamma()) x.push_back(0.5 + 0.1 * shift);
  x.push_back(law.family == LifeFamily::normal ? 3e5 * (1 + 0.3 * shift) : 0.3 * (1 + 0.3 * shift));
  if (law.limit) {
    x.push_back(8.25 + 0.05 * shift);
    x.push_back(0.06 * (1 + 0.2 * shift));
  }
  return x;
}

TEST(SnLikelihood, GradientIsTheDifferenceQuotient) {
  for (const SnLaw& law : all_laws()) {
    const auto likelihood = sn_likelihood(law, some_tests(), some_tests().size());
    for (const double shift : {-1.0, 0.0, 1.0}) {
      std::vector<double> x = plausible(law, shift);
      std::vector<double> gradient(x.size());
      const double value = likelihood->value_and_gradient(x, gradient);
      EXPECT_NEAR(value, likelihood->value(x), 1e-10 * std::abs(value));
      for (std::size_t i = 0; i < x.size(); ++i) {
        const double middle = x[i], step = 1e-5 * std::abs(x[i]);
        const auto at = [&](double to) {
          x[i] = middle + to;
          return likelihood->value(x);
        };
        // Fourth order, so that the step's error is far below the tolerance.
        const double slope =
            (8 * (at(step) - at(-step)) - (at(2 * step) - at(-2 * step))) / (12 * step);
        x[i] = middle;
        EXPECT_NEAR(gradient[i], slope, 1e-6 * (std::abs(slope) + std::abs(value / middle)))
            << "correction " << static_cast<int>(law.correction) << ", family "
            << static_cast<int>(law.family) << ", parameter " << i;
      }
    }
  }
}

// The probabilities of breaking before, between and beyond two lives are all there is.
TEST(SnLikelihood, OutcomesAddUpToOne) {
  for (const SnLaw& law : all_laws()) {
    const std::vector<double> x = plausible(law, 0);
    const Stress stress{260e6, 100e6};
    const auto probability = [&](Outcome outcome, double life, double until) {
      return std::exp(sn_likelihood(law, {{stress, outcome, life, until, 1}}, 1)->value(x));
    };
    EXPECT_NEAR(probability(Outcome::left, 2e5, 0) + probability(Outcome::interval, 2e5, 6e5) +
                    probability(Outcome::runout, 6e5, 0),
                1, 1e-10);
  }
}

// A density is the derivative of the probability below it.
TEST(SnLikelihood, DensityIsTheSlopeOfProbability) {
  for (const SnLaw& law : all_laws()) {
    const std::vector<double> x = plausible(law, 0);
    const Stress stress{260e6, 100e6};
    const auto value = [&](Outcome outcome, double life) {
      return std::exp(sn_likelihood(law, {{stress, outcome, life, 0, 1}}, 1)->value(x));
    };
    const double life = 3e5, step = 30;
    const double slope =
        (value(Outcome::left, life + step) - value(Outcome::left, life - step)) / (2 * step);
    EXPECT_NEAR(value(Outcome::failure, life) / slope, 1, 1e-6);
  }
}

TEST(SnLikelihood, PointwiseTermsAreTheTests) {
  for (const SnLaw& law : all_laws()) {
    const auto likelihood = sn_likelihood(law, some_tests(), some_tests().size());
    const std::vector<double> x = plausible(law, 0), terms = likelihood->pointwise(x);
    const std::vector<int> counts = likelihood->pointwise_counts();
    EXPECT_EQ(counts, (std::vector<int>{1, 2, 3, 1, 1}));
    double sum = 0;
    for (std::size_t i = 0; i < terms.size(); ++i) sum += counts[i] * terms[i];
    EXPECT_NEAR(sum, likelihood->value(x), 1e-12 * std::abs(sum));
  }
}

// So many tests that those under one stress enter by their mean and their scatter.
// Also where tests alike are taken together.
TEST(SnLikelihood, AlongAParameterItIsTheSame) {
  LifeTests many;
  for (int i = 0; i < 500; ++i) {
    for (const LifeTest& test : some_tests()) many.push_back(test);
  }
  for (const LifeTests& tests : {some_tests(), many}) {
    for (const SnLaw& law : all_laws()) {
      if (law.integrated() && tests.size() > 10) continue;
      const auto likelihood = sn_likelihood(law, tests, tests.size());
      const std::vector<double> x = plausible(law, 0), other = plausible(law, 0.7);
      int saved = 0;
      for (std::size_t axis = 0; axis < x.size(); ++axis) {
        const auto along = likelihood->along(x, axis);
        if (!along) continue;
        ++saved;
        for (const double at : {other[axis], x[axis]}) {
          std::vector<double> there = x;
          there[axis] = at;
          EXPECT_EQ(along(at), likelihood->value(there)) << axis;
        }
      }
      EXPECT_GE(saved, static_cast<int>(x.size()) - 1);
    }
  }
}

// Whatever is asked for: the value itself where it is above, and something below where it is not.
RC_GTEST_PROP(SnLikelihood, AboveANumberItIsTheSame, ()) {
  const std::vector<SnLaw> laws = all_laws();
  const SnLaw& law = laws[*rc::gen::inRange<std::size_t>(0, laws.size())];
  const auto likelihood = sn_likelihood(law, some_tests(), some_tests().size());
  const std::vector<double> x = plausible(law, 5 * *between(0.01, 1) - 2.5);
  const double value = likelihood->value(x);
  for (const double least : {value - 5, value - 0.1, value + 0.1, value + 5, value + 500.0}) {
    const double above = likelihood->value_above(x, least);
    RC_ASSERT((value > least ? above == value : !(above > least)));
  }
}

TEST(SnLikelihood, WithoutATestTheOthersAreLeft) {
  for (const SnLaw& law : all_laws()) {
    const auto likelihood = sn_likelihood(law, some_tests(), some_tests().size());
    const std::vector<double> x = plausible(law, 0);
    const std::vector<double> terms = likelihood->pointwise(x);
    for (std::size_t i = 0; i < terms.size(); ++i) {
      const double others = likelihood->without(i)->value(x);
      EXPECT_NEAR(others, likelihood->value(x) - terms[i], 1e-9 * (1 + std::abs(others))) << i;
    }
  }
}

TEST(SnLikelihood, ManyTestsAreTheirSum) {
  LifeTests tests;
  for (int i = 0; i < 500; ++i) {
    for (LifeTest test : some_tests()) {
      if (test.outcome == Outcome::failure) test.life *= 1 + 0.001 * i;
      tests.push_back(test);
    }
  }
  for (const SnLaw& law : all_laws()) {
    if (law.integrated()) continue;  // summed as few are
    const std::vector<double> x = plausible(law, 0.5);
    const auto likelihood = sn_likelihood(law, tests, tests.size());
    const std::vector<double> terms = likelihood->pointwise(x);
    double sum = 0;
    for (std::size_t i = 0; i < terms.size(); ++i) sum += tests[i].count * terms[i];
    std::vector<double> gradient(x.size());
    EXPECT_NEAR(likelihood->value_and_gradient(x, gradient), sum, 1e-11 * std::abs(sum));
    EXPECT_NEAR(likelihood->value(x), sum, 1e-11 * std::abs(sum));
  }
}

TEST(SnLikelihood, NothingBeyondTheStrength) {
  const auto likelihood = sn_likelihood({}, some_tests(), 5);
  const double too_weak[] = {9.35, -0.15, std::log10(199e6), 0.3};
  EXPECT_EQ(likelihood->value(too_weak), -INFINITY);
}

// Without scatter of the limit, and with the limit far below all stresses, there is none.
TEST(SnLikelihood, ALowLimitIsNoLimit) {
  SnLaw law;
  SnLaw limited = law;
  limited.limit = StandardDistribution::normal;
  const LifeTests tests = some_tests();
  const double x[] = {9.35, -0.15, 9, 0.3, 0, 0.05};
  EXPECT_NEAR(sn_likelihood(limited, tests, 5)->value(x),
              sn_likelihood(law, tests, 5)->value(std::span(x, 4)), 1e-6);
}

RC_GTEST_PROP(SnLikelihood, MoreStressIsNeverMoreLife, ()) {
  const auto laws = all_laws();
  const double alternating = *between(50e6, 500e6), mean = *between(1e6, 800e6),
               life = *between(1e4, 1e8), more = *between(1.001, 1.2);
  for (const SnLaw& law : laws) {
    if (law.scatter_grows) continue;  // far out in the tail the scatter falls faster than the curve
    const std::vector<double> x = plausible(law, 0);
    const auto survival = [&](double a, double m) {
      return sn_likelihood(law, {{{a, m}, Outcome::runout, life, 0, 1}}, 1)->value(x);
    };
    const double here = survival(alternating, mean);
    // Below the least number there is an integral over the limit promises no order: a Weibull life far beyond its own
    // end has a survival of e^-50000 or e^-1000000.
    constexpr double least = -700;
    if (law.integrated() && here < least) {
      RC_ASSERT(survival(more * alternating, mean) < 0.5 * least);
      RC_ASSERT(survival(alternating, more * mean) < 0.5 * least);
      continue;
    }
    RC_ASSERT(survival(more * alternating, mean) <= here + 1e-12 + 1e-9 * std::abs(here));
    RC_ASSERT(survival(alternating, more * mean) <= here + 1e-12 + 1e-9 * std::abs(here));
  }
}

}  // namespace
}  // namespace wearwell::fatigue
