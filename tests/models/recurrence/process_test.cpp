#include "wearwell/models/recurrence/process.h"

#include <gtest/gtest.h>

#include <boost/math/distributions/gamma.hpp>
#include <boost/math/distributions/negative_binomial.hpp>
#include <cmath>

#include "histories.h"
#include "wearwell/base/rng.h"
#include "wearwell/models/recurrence/forecast.h"
#include "wearwell/models/recurrence/renewal_function.h"

namespace wearwell::recurrence {
namespace {

const Process power{ProcessKind::power_law, 200, 0, {}},
    renewal{ProcessKind::renewal, 200, 0.5, {}};

// Published for Crow's three systems: beta = 0.615, lambda = 0.461; there the gradient is zero.
TEST(PowerLaw, MaximumIsCrowsEstimate) {
  double logs = 0;
  for (const UnitHistory& unit : three_systems().units)
    for (const double at : unit.failures) logs += std::log(200 / at);
  const double x[] = {36 / logs, 12};
  EXPECT_NEAR(x[0], 0.615, 0.0005);
  EXPECT_NEAR(12 / std::pow(200, x[0]), 0.461, 0.0005);
  double gradient[2];
  process_likelihood(power, three_systems())->value_and_gradient(x, gradient);
  EXPECT_NEAR(gradient[0], 0, 1e-10);
  EXPECT_NEAR(gradient[1], 0, 1e-12);
}

TEST(Process, FactorsSumToTheLikelihoodAndGradientIsOfDifferences) {
  RecurrenceData data = three_systems();
  data.gaps.push_back({0, 197.2, 197.2, true, false});  // a second failure within one rounded age
  data.units[0].failures.push_back(197.2);
  for (const Process& process : {power, renewal}) {
    const auto likelihood = process_likelihood(process, data);
    const double x[] = {0.8, process.minimal_repair() ? 11.0 : 14.0};
    double sum = 0;
    for (const double each : likelihood->pointwise(x)) sum += each;
    EXPECT_NEAR(likelihood->value(x), sum, 1e-10);
    double gradient[2];
    EXPECT_EQ(likelihood->value_and_gradient(x, gradient), likelihood->value(x));
    for (int i = 0; i < 2; ++i) {
      double up[] = {x[0], x[1]}, down[] = {x[0], x[1]};
      up[i] += 1e-6;
      down[i] -= 1e-6;
      EXPECT_NEAR(gradient[i], (likelihood->value(up) - likelihood->value(down)) / 2e-6, 1e-6);
    }
  }
}

// Failures that are counted by interval: factors are Poisson probabilities, gradients those of differences, and a sum over
// intervals of one failure each tends to the likelihood of exact ages.
TEST(Process, CountsByIntervalHavePoissonProbabilities) {
  RecurrenceData data;
  data.units = {{"a", 0, 200, {50, 50, 120}, false, true}};
  data.gaps = {
      {0, 0, 50, false, true, 2}, {0, 50, 120, false, false, 1}, {0, 120, 200, false, false, 0}};
  const Process phases{ProcessKind::phases, 1, 0, {120}};
  for (const Process& process : {power, phases}) {
    const auto likelihood = process_likelihood(process, data);
    const double x[] = {0.8, process.kind == ProcessKind::phases ? 14.0 : 11.0};
    const double until[] = {process.mean_by(x, 50), process.mean_by(x, 120),
                            process.mean_by(x, 200)};
    const auto poisson = [](int n, double mean) {
      return n * std::log(mean) - mean - std::lgamma(n + 1.0);
    };
    const std::vector<double> terms = likelihood->pointwise(x);
    EXPECT_NEAR(terms[0], poisson(2, until[0]), 1e-12);
    EXPECT_NEAR(terms[1], poisson(1, until[1] - until[0]), 1e-12);
    EXPECT_NEAR(terms[2], poisson(0, until[2] - until[1]), 1e-12);
    EXPECT_NEAR(likelihood->value(x), terms[0] + terms[1] + terms[2], 1e-10);
    double gradient[2];
    likelihood->value_and_gradient(x, gradient);
    for (int i = 0; i < 2; ++i) {
      double up[] = {x[0], x[1]}, down[] = {x[0], x[1]};
      up[i] += 1e-6;
      down[i] -= 1e-6;
      EXPECT_NEAR(gradient[i], (likelihood->value(up) - likelihood->value(down)) / 2e-6, 1e-6);
    }
    const auto scores = process_scores(process, data)(x);
    EXPECT_NEAR(normal_cdf(scores[1].high),
                std::exp(poisson(0, until[1] - until[0])) + std::exp(terms[1]), 1e-10);
    EXPECT_NEAR(normal_cdf(scores[1].low), std::exp(poisson(0, until[1] - until[0])), 1e-10);
    EXPECT_FALSE(std::isfinite(scores[2].low));
  }
}

// By hand: 2 failures in 2 x 50 units of age of the first phase, 1 in 100 of the second.
TEST(Phases, CountFailuresAndTimeOfEachPhase) {
  Process phases{ProcessKind::phases, 1, 0, {50}};
  const RecurrenceData data =
      observed({{20, 50, 70}, {}}, {150, 50});  // a failure at the end of a phase belongs to it
  const double x[] = {40, 80};
  const auto likelihood = process_likelihood(phases, data);
  EXPECT_NEAR(likelihood->value(x), -2 * std::log(40) - 100.0 / 40 - std::log(80) - 100.0 / 80,
              1e-12);
  double sum = 0, gradient[2];
  for (const double each : likelihood->pointwise(x)) sum += each;
  EXPECT_NEAR(sum, likelihood->value(x), 1e-12);
  likelihood->value_and_gradient(x, gradient);
  EXPECT_NEAR(gradient[0], -2.0 / 40 + 100.0 / 1600, 1e-12);
  EXPECT_NEAR(gradient[1], -1.0 / 80 + 100.0 / 6400, 1e-12);
  EXPECT_NEAR(phases.mean_by(x, 90), 50.0 / 40 + 40.0 / 80, 1e-12);
  EXPECT_NEAR(phases.intensity(x, 49), 1.0 / 40, 1e-15);
  EXPECT_NEAR(phases.intensity(x, 50), 1.0 / 80, 1e-15);  // of what is to come
}

// One phase is the power law with beta = 1.
TEST(Phases, OneIsAConstantIntensity) {
  const RecurrenceData data = three_systems();
  const double by_number[] = {1, 10}, by_mtbf[] = {20};
  EXPECT_NEAR(process_likelihood({ProcessKind::phases, 1, 0, {}}, data)->value(by_mtbf),
              process_likelihood(power, data)->value(by_number), 1e-10);
}

// With beta = 1 both processes are the same Poisson process, factor by factor.
TEST(Process, AgreeWithoutAgeing) {
  const RecurrenceData data = three_systems();
  const double by_number[] = {1, 10}, by_scale[] = {1, 20};
  const auto a = process_likelihood(power, data)->pointwise(by_number);
  const auto b = process_likelihood(renewal, data)->pointwise(by_scale);
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-12);
}

// Of a unit that is observed from a later age on only what happens from there counts.
TEST(PowerLaw, LateStart) {
  RecurrenceData data;
  data.units = {{"1", 50, 200, {100}, false}};
  data.gaps = {{0, 50, 100, true, true}, {0, 100, 200, false, false}};
  const double x[] = {2, 8};
  // Intensity 2 x 8/200 x (100/200); expected number 8 (1 - 1/16).
  EXPECT_NEAR(process_likelihood(power, data)->value(x), std::log(0.04) - 7.5, 1e-12);
}

TEST(Process, ScoresAreThoseOfTheHazard) {
  RecurrenceData data;
  data.units = {{"1", 0, 200, {100}, false}};
  data.gaps = {{0, 0, 100, true, true}, {0, 100, 200, false, false}};
  const double x[] = {2, 4};
  const auto scores = process_scores(power, data)(x);
  EXPECT_NEAR(normal_cdf(scores[0].low), 1 - std::exp(-1.0), 1e-12);
  EXPECT_TRUE(scores[0].exact());
  EXPECT_NEAR(normal_cdf(scores[1].low), 1 - std::exp(-3.0), 1e-12);
  EXPECT_EQ(scores[1].high, INFINITY);
}

WeightedDraws one_point(double a, double b) {
  WeightedDraws draws{Points(1, 2), Eigen::VectorXd::Ones(1), {}, {}};
  draws.values << a, b;
  return draws;
}

TEST(Renewal, ExponentialAndLongRun) {
  const RenewalFunction exponential(1, 20, 100);
  for (const double t : {1.0, 33.0, 100.0}) EXPECT_NEAR(exponential(t), t / 20, 1e-3 * t / 20);
  EXPECT_NEAR(exponential.expected(70), 5, 5e-3);
  // After many gaps: t/mu + (sd^2/mu^2 - 1)/2.
  const RenewalFunction wearing(2, 20, 400), far(2, 20, 40000);
  const double mean = 20 * std::tgamma(1.5), square = 400;
  EXPECT_NEAR(wearing(400), 400 / mean + square / (2 * mean * mean) - 1, 0.02);
  EXPECT_NEAR(far(4000), 4000 / mean + square / (2 * mean * mean) - 1, 1e-9);
}

// With beta 0.3 gaps differ by decades, and 50 scales are no long run: simulated, beta 0.3 and eta 1.
TEST(Renewal, GapsThatDifferByDecades) {
  constexpr double beta = 0.3, horizon = 60;
  constexpr int count = 20'000;
  double sum = 0, squares = 0;
  Rng rng(7, 0);
  for (int i = 0; i < count; ++i) {
    double number = 0;
    for (double age = std::pow(-std::log(rng.uniform()), 1 / beta); age < horizon;
         age += std::pow(-std::log(rng.uniform()), 1 / beta))
      ++number;
    sum += number, squares += number * number;
  }
  const double mean = sum / count, error = std::sqrt((squares / count - mean * mean) / count);
  EXPECT_NEAR(RenewalFunction(beta, 1, horizon).expected(0), mean, 4 * error + 0.01 * mean);
  EXPECT_NEAR(RenewalFunction(beta, 1, 6000)(horizon), mean, 4 * error + 0.05 * mean);
}

// A failure at the end of a phase belongs to it; what is to come at that age, to the next.
TEST(Process, PredictionsAtTheEndOfAPhaseAreOfTheNext) {
  const Process phases{ProcessKind::phases, 1, 0, {500}};
  const double x[] = {100, 1000};
  EXPECT_EQ(phases.phase_at(500), 0U);
  EXPECT_DOUBLE_EQ(phases.intensity(x, 499), 0.01);
  EXPECT_DOUBLE_EQ(phases.intensity(x, 500), 0.001);
  EXPECT_NEAR(phases.mean_by(x, 501) - phases.mean_by(x, 500), 0.001, 1e-12);
}

// The expected number by the renewal equation is the mean of simulated futures, for a unit in the midst of a gap.
TEST(Renewal, ExpectedIsTheMeanOfFutures) {
  const double beta = 2.5, eta = 20, since = 13, ahead = 50;
  double sum = 0, squares = 0;
  constexpr int futures = 40000;
  Rng rng(1, 0);
  for (int i = 0; i < futures; ++i) {
    const auto gap = [&](double used) {
      return eta * std::pow(std::pow(used / eta, beta) - std::log(rng.uniform()), 1 / beta) - used;
    };
    int count = 0;
    for (double at = gap(since); at <= ahead; at += gap(0)) ++count;
    sum += count;
    squares += count * count;
  }
  const double mean = sum / futures, se = std::sqrt((squares / futures - mean * mean) / futures);
  EXPECT_NEAR(RenewalFunction(beta, eta, ahead).expected(since), mean, 4 * se + 1e-3);
  const Forecast found = forecast(renewal, one_point(beta, eta), {{since, since}}, ahead);
  EXPECT_NEAR(found.expected, mean, 4 * se + 1e-3);
}

// A gamma posterior of M_T makes the number of failures negative binomial.
TEST(Forecast, OfAGammaPosteriorIsNegativeBinomial) {
  constexpr int points = 2000;
  WeightedDraws draws{Points(points, 2), Eigen::VectorXd::Constant(points, 1.0 / points), {}, {}};
  const boost::math::gamma_distribution<> gamma(9, 1);
  for (int i = 0; i < points; ++i) draws.values.row(i) << 1, quantile(gamma, (i + 0.5) / points);
  // beta = 1: 300 more after 200, in two units, are 3 M_T.
  const Forecast found = forecast(power, draws, {{200, 5}, {200, 5}}, 300);
  const boost::math::negative_binomial_distribution<> number(9, 1 / (1 + 3.0));
  EXPECT_NEAR(found.expected, 27, 0.02);
  const auto smallest = [&](double p) {
    int k = 0;
    while (cdf(number, k) < p) ++k;
    return k;
  };
  EXPECT_EQ(found.count_low, smallest(0.05));
  EXPECT_EQ(found.count_high, smallest(0.95));
  EXPECT_NEAR(found.any, 1 - pdf(number, 0), 1e-4);
  EXPECT_NEAR(found.low, 3 * quantile(gamma, 0.05), 0.05);
  // Survival of the time to the next failure of one unit: (1 + t/200)^-9.
  EXPECT_NEAR(time_to_failure(power, draws, {200, 200}, 0.5), 200 * (std::pow(2, 1.0 / 9) - 1),
              0.02);
}

}  // namespace
}  // namespace wearwell::recurrence
