#include "wearwell/models/recurrence/exact_bounds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "wearwell/base/rng.h"

namespace wearwell::recurrence {
namespace {

const std::vector<double> twenty_two = {2.7,   10.3,  12.5,  30.6,  57.0,  61.3,  80.0,  109.5,
                                        125.0, 128.6, 143.8, 167.9, 229.2, 296.7, 320.6, 328.2,
                                        366.2, 396.7, 421.1, 438.2, 501.2, 620.0};

PowerLawSample sample_of(std::size_t n, bool failure_ended) {
  return {1, n, failure_ended ? n - 1 : n, 1, 1, !failure_ended, failure_ended};
}

// The factors of MIL-HDBK-189, which multiply the estimate end/(n beta) = end logs/n^2; with more digits by
// tests/golden/crow_bounds.R.
TEST(CrowBounds, HaveThePublishedFactors) {
  struct Factors {
    std::size_t n;
    double outside;
    bool failure_ended;
    double lower, upper;
  };
  for (const Factors& each : {Factors{2, 0.05, true, 0.5552, 72.67},
                              {3, 0.05, true, 0.5137, 14.24},
                              {2, 0.1, true, 0.8065, 33.76},
                              {22, 0.05, true, 0.6700631, 1.848119},
                              {2, 0.05, false, 0.200, 38.66},
                              {2, 0.1, false, 0.261, 18.66},
                              {3, 0.05, false, 0.263, 9.736},
                              {10, 0.1, false, 0.5491043, 2.13557},
                              {10, 0.025, false, 0.4213635, 3.041812}}) {
    const auto found = exact_mtbf(sample_of(each.n, each.failure_ended), each.outside);
    ASSERT_TRUE(found);
    const auto square = static_cast<double>(each.n * each.n);
    const double close = each.n > 3 ? 2e-6 : each.failure_ended ? 5e-4 : 3e-3;
    EXPECT_NEAR(found->lower * square / each.lower, 1, close) << each.n << " " << each.outside;
    EXPECT_NEAR(found->upper * square / each.upper, 1, close) << each.n << " " << each.outside;
  }
}

// ReliaSoft's example of a test that its last failure ended: beta 0.6142, MTBF 45.883 h, and its bounds with 90 %.
TEST(CrowBounds, OfReliaSoftsDevelopmentTest) {
  const auto sample = power_law_sample({{"1", 0, 620, twenty_two, true}});
  ASSERT_TRUE(sample && sample->failure_ended);
  EXPECT_NEAR(22 / sample->logs, 0.6142104, 1e-7);
  EXPECT_NEAR(sample->end * sample->logs / (22 * 22), 45.883, 5e-4);
  const auto beta = exact_beta(*sample, 0.05), mtbf = exact_mtbf(*sample, 0.05);
  ASSERT_TRUE(beta && mtbf);
  EXPECT_NEAR(beta->lower, 0.392872, 1e-6);
  EXPECT_NEAR(beta->upper, 0.8113725, 1e-6);
  EXPECT_NEAR(mtbf->lower, 30.74451, 1e-4);
  EXPECT_NEAR(mtbf->upper, 84.79723, 1e-4);
}

// NIST/SEMATECH e-Handbook 8.4.5.2, case study 1: MTBF 310.234 h at the end of 1500 h.
TEST(CrowBounds, OfTheCaseStudyOfNist) {
  const auto sample =
      power_law_sample({{"1", 0, 1500, {5, 40, 43, 175, 389, 712, 747, 795, 1299, 1478}, false}});
  ASSERT_TRUE(sample && sample->time_ended);
  ASSERT_TRUE(sample->unbiased_beta());
  EXPECT_NEAR(1500 / (10 * *sample->unbiased_beta()), 310.234, 5e-4);
  const auto mtbf = exact_mtbf(*sample, 0.1);
  ASSERT_TRUE(mtbf);
  EXPECT_NEAR(mtbf->lower, 153.3157, 1e-3);
  EXPECT_NEAR(mtbf->upper, 596.2738, 1e-3);
}

// NIST/SEMATECH e-Handbook 8.4.5.1: 2 failures in 800 h, factors 0.3177 and 5.6281 of 400 h with 90 %; without failures
// there is a lower bound only, time/ln(1/alpha).
TEST(CrowBounds, OfAConstantIntensity) {
  const Interval two = exact_constant_mtbf(2, 800, false, 0.05);
  EXPECT_NEAR(two.lower / 400, 0.3177, 5e-5);
  EXPECT_NEAR(two.upper / 400, 5.6281, 5e-5);
  const Interval none = exact_constant_mtbf(0, 800, false, 0.1);
  EXPECT_NEAR(none.lower, 800 / std::log(10.0), 1e-9);
  EXPECT_TRUE(std::isinf(none.upper));
  // The time to the second failure, over the mean, is gamma distributed: the same upper bound, a longer lower one.
  EXPECT_EQ(exact_constant_mtbf(2, 800, true, 0.05).upper, two.upper);
  EXPECT_GT(exact_constant_mtbf(2, 800, true, 0.05).lower, two.lower);
}

// Exact coverage of each end, whatever beta and the intensity are.
TEST(CrowBounds, CoverIfAFailureEndsTheTest) {
  constexpr std::size_t n = 5;
  constexpr double outside = 0.1, beta = 0.4, lambda = 0.7;
  constexpr int samples = 20'000;
  const Interval factors = *exact_mtbf(sample_of(n, true), outside);
  Rng rng(20261127, 1);
  double below = 0, above = 0;
  for (int i = 0; i < samples; ++i) {
    std::vector<double> ages;
    double mean = 0;
    for (std::size_t k = 0; k < n; ++k) {
      mean -= std::log(rng.uniform());
      ages.push_back(std::pow(mean / lambda, 1 / beta));
    }
    const PowerLawSample sample = *power_law_sample({{"1", 0, ages.back(), ages, true}});
    const double scale = sample.end * sample.logs,
                 mtbf = 1 / (lambda * beta * std::pow(sample.end, beta - 1));
    below += mtbf < factors.lower * scale;
    above += mtbf > factors.upper * scale;
  }
  const double error = 4 * std::sqrt(outside * (1 - outside) / samples);
  EXPECT_NEAR(below / samples, outside, error);
  EXPECT_NEAR(above / samples, outside, error);
}

// At least the nominal coverage, of two units with a time limit.
TEST(CrowBounds, CoverIfTimeEndsTheTest) {
  constexpr double outside = 0.1, beta = 0.6, mean = 3, end = 10;
  constexpr int samples = 20'000;
  std::map<std::size_t, Interval> factors;
  Rng rng(20261127, 2);
  double below = 0, above = 0, counted = 0;
  for (int i = 0; i < samples; ++i) {
    std::vector<UnitHistory> units;
    for (const char* name : {"1", "2"}) {
      UnitHistory unit{name, 0, end, {}, false};
      for (double at = 0; (at -= std::log(rng.uniform())) < mean;)
        unit.failures.push_back(end * std::pow(at / mean, 1 / beta));
      units.push_back(unit);
    }
    const PowerLawSample sample = *power_law_sample(units);
    if (sample.failures == 0) continue;
    const auto [found, first] = factors.try_emplace(sample.failures);
    if (first) found->second = *exact_mtbf(sample_of(sample.failures, false), outside);
    const double scale = sample.end * sample.logs * 2, mtbf = end / (beta * mean);
    ++counted;
    below += mtbf < found->second.lower * scale;
    above += mtbf > found->second.upper * scale;
  }
  const double error = 4 * std::sqrt(outside * (1 - outside) / counted);
  EXPECT_LT(below / counted, outside + error);
  EXPECT_LT(above / counted, outside + error);
  EXPECT_GT(below / counted, 0.4 * outside);  // not without end
  EXPECT_GT(above / counted, 0.4 * outside);
}

// At the ends of the interval so many failures, or so few, have the probability outside. Two units, 3 and 1 failures.
TEST(CrowBounds, OfTheAgePerFailureAreThoseOfTheNumberOfFailures) {
  const auto two =
      power_law_sample({{"1", 0, 100, {20, 30, 95}, false}, {"2", 0, 100, {7}, false}});
  const Interval age = *exact_age_per_failure(*two, 0.05);
  const auto at_most = [](int n, double mean) {
    double term = std::exp(-mean), sum = 0;
    for (int i = 0; i <= n; ++i, term *= mean / i) sum += term;
    return sum;
  };
  EXPECT_NEAR(at_most(4, 2 * 100 / age.lower), 0.05, 1e-9);
  EXPECT_NEAR(1 - at_most(3, 2 * 100 / age.upper), 0.05, 1e-9);
  // Until the last of 22 failures: chi-square with 44 degrees of freedom, from tables 29.787 and 60.481.
  const Interval last =
      *exact_age_per_failure(*power_law_sample({{"1", 0, 620, twenty_two, true}}), 0.05);
  EXPECT_NEAR(last.lower, 2 * 620 / 60.481, 1e-3);
  EXPECT_NEAR(last.upper, 2 * 620 / 29.787, 1e-2);
  const auto ends = power_law_sample({{"1", 0, 100, {20, 30}, false}, {"2", 0, 80, {7}, false}});
  EXPECT_FALSE(exact_age_per_failure(*ends, 0.05));
}

TEST(CrowBounds, SayWhereTheyDoNotApply) {
  EXPECT_FALSE(power_law_sample({{"1", 5, 100, {20, 30}, false}}));
  const auto ends = power_law_sample({{"1", 0, 100, {20, 30}, false}, {"2", 0, 80, {7}, false}});
  ASSERT_TRUE(ends);
  EXPECT_TRUE(exact_beta(*ends, 0.05));
  EXPECT_FALSE(exact_mtbf(*ends, 0.05));
  const auto mixed = power_law_sample({{"1", 0, 100, {20, 100}, true}, {"2", 0, 100, {7}, false}});
  EXPECT_EQ(mixed->random, 2U);
  EXPECT_FALSE(exact_mtbf(*mixed, 0.05));
  EXPECT_TRUE(std::isinf(exact_mtbf(sample_of(1, false), 0.05)->upper));
  EXPECT_FALSE(exact_beta(*power_law_sample({{"1", 0, 100, {}, false}}), 0.05));
  Process phases;
  phases.kind = ProcessKind::phases;
  phases.phase_ends = {50};
  const std::vector<UnitHistory> units = {{"1", 0, 100, {20, 100}, true}, {"2", 0, 90, {7}, false}};
  EXPECT_TRUE(exact_phase(phases, units, 0, 0.05));
  EXPECT_FALSE(exact_phase(phases, units, 1, 0.05));
}

}  // namespace
}  // namespace wearwell::recurrence
