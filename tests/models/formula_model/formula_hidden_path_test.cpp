// Gamma and inverse Gaussian processes seen through errors of readings: against integrals of one step, averages over simulated
// paths, and what is left where errors are very small.
#include "wearwell/models/formula_model/formula_hidden_path.h"

#include <gtest/gtest.h>

#include <boost/math/quadrature/tanh_sinh.hpp>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "models/formula_model/process_form.h"

namespace wearwell::formula_model {
namespace {

double log_step(Process process, double x, double mean, double scale) {
  if (process == Process::gamma) {
    const double a = mean / scale;
    return (a - 1) * std::log(x / scale) - x / scale - std::log(scale) - std::lgamma(a);
  }
  return std::log(mean) - 0.5 * std::log(2 * std::numbers::pi * scale * x * x * x) -
         (x - mean) * (x - mean) / (2 * scale * x);
}

double normal(double z, double sd) {
  return std::exp(-0.5 * z * z / (sd * sd)) / (sd * std::sqrt(2 * std::numbers::pi));
}

struct Unit {
  std::vector<double> reading, mean, spread, noise;
  ProcessRows rows() const { return {reading, mean, spread, noise}; }
  std::vector<double> terms(Process process) const {
    std::vector<double> value(reading.size());
    process_terms(form_of(process), rows(), value, {});
    return value;
  }
  double sum(Process process) const {
    const std::vector<double> all = terms(process);
    return std::accumulate(all.begin(), all.end(), 0.0);
  }
};

// By the logarithm of the step, in which its density has no pole.
double one_reading(Process process, double y, double mean, double scale, double noise) {
  boost::math::quadrature::tanh_sinh<double> rule(15);
  const auto f = [&](double v) {
    const double x = std::exp(v);
    return std::exp(log_step(process, x, mean, scale)) * x * normal(y - x, noise);
  };
  double sum = 0;
  for (double v = -160; v < 10; v += v < -4 ? 12 : 0.25) {
    sum += rule.integrate(f, v, v + (v < -4 ? 12 : 0.25), 1e-12);
  }
  return std::log(sum);
}

class HiddenPaths : public testing::TestWithParam<Process> {};

TEST_P(HiddenPaths, OneStepIsItsIntegral) {
  for (const double shape : {0.2, 0.9, 4.0, 300.0}) {
    for (const double noise : {0.05, 0.6}) {
      for (const double y : {-0.02, 0.4, 1.3}) {
        const double mean = 0.8, scale = mean / shape;
        const double expected = one_reading(GetParam(), y, mean, scale, noise);
        if (expected < -60) continue;
        const Unit unit{{y}, {mean}, {scale}, {noise}};
        // In a reading's far tail polynomials do less well.
        const double tolerance = expected > -9 ? 2e-6 : 2e-3;
        EXPECT_NEAR(unit.sum(GetParam()), expected, tolerance) << shape << " " << noise << " " << y;
      }
    }
  }
}

const Unit several{{0.7, 1.0, 1.9, 1.8, 4.1},
                   {0.6, 1.1, 1.7, 2.4, 3.6},
                   {0.5, 0.5, 0.5, 0.5, 0.5},
                   {0.3, 0.3, 0.35, 0.3, 0.4}};

double drawn_step(Process process, double mean, double scale, std::mt19937_64& random) {
  if (process == Process::gamma) {
    return std::gamma_distribution<double>(mean / scale, scale)(random);
  }
  // Michael, Schucany and Haas (1976).
  const double lambda = mean * mean / scale;
  const double z = std::normal_distribution<double>()(random), y = z * z;
  const double x = mean + mean * mean * y / (2 * lambda) -
                   mean / (2 * lambda) * std::sqrt(4 * mean * lambda * y + mean * mean * y * y);
  return std::uniform_real_distribution<double>()(random) <= mean / (mean + x) ? x
                                                                               : mean * mean / x;
}

std::vector<double> drawn_path(Process process, const Unit& unit, std::mt19937_64& random) {
  std::vector<double> path;
  double at = 0;
  for (std::size_t i = 0; i < unit.mean.size(); ++i) {
    const double before = i > 0 ? unit.mean[i - 1] : 0;
    at += drawn_step(process, unit.mean[i] - before, unit.spread[i], random);
    path.push_back(at);
  }
  return path;
}

// The likelihood, and where the path stands, from paths that are simulated and weighted by their readings.
TEST_P(HiddenPaths, SeveralStepsAreAnAverageOverSimulatedPaths) {
  std::mt19937_64 random(20261122);
  constexpr int paths = 1'000'000;
  double sum = 0, squares = 0, at = 0, at_square = 0;
  for (int n = 0; n < paths; ++n) {
    const std::vector<double> path = drawn_path(GetParam(), several, random);
    double weight = 1;
    for (std::size_t i = 0; i < path.size(); ++i) {
      weight *= normal(several.reading[i] - path[i], several.noise[i]);
    }
    sum += weight;
    squares += weight * weight;
    at += weight * path.back();
    at_square += weight * path.back() * path.back();
  }
  const double mean = sum / paths;
  const double error = std::sqrt(squares / paths - mean * mean) / std::sqrt(double(paths)) / mean;
  EXPECT_LT(error, 0.01);
  EXPECT_NEAR(several.sum(GetParam()), std::log(mean), 3.5 * error);
  const Standing stands = standing(form_of(GetParam()), several.rows());
  const double middle = at / sum, variance = at_square / sum - middle * middle;
  EXPECT_NEAR(stands.at, middle, 5 * error * std::sqrt(variance));
  EXPECT_NEAR(stands.variance / variance, 1, 6 * error);
}

// Errors of readings above and below the steps, shapes above and below 1: a finer lattice says the same.
TEST_P(HiddenPaths, AFinerLatticeSaysTheSame) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> z;
  for (const double shape : {0.05, 0.5, 2.0, 50.0}) {
    for (const double noise : {0.02, 0.2, 1.0, 8.0}) {
      Unit unit;
      for (int i = 1; i <= 8; ++i) {
        unit.mean.push_back(i);
        unit.spread.push_back(1 / shape);
        unit.noise.push_back(noise);
      }
      unit.reading = drawn_path(GetParam(), unit, random);
      for (double& each : unit.reading) each += noise * z(random);
      const double off = hidden_unsettled(form_of(GetParam()), unit.rows());
      EXPECT_LT(off, 3e-6) << shape << " " << noise;
    }
  }
}

TEST_P(HiddenPaths, DerivativesAreThoseOfTheValue) {
  Unit unit = several;
  const std::size_t n = unit.reading.size();
  std::vector<double> value(n), slope(most_response_parameters * n);
  process_terms(form_of(GetParam()), unit.rows(), value, slope);
  std::size_t at = 0;
  for (std::vector<double>* family_parameter : {&unit.mean, &unit.spread, &unit.noise}) {
    for (std::size_t i = 0; i < n; ++i, ++at) {
      const double x = (*family_parameter)[i], step = 1e-4 * x;
      (*family_parameter)[i] = x + step;
      const double above = unit.sum(GetParam());
      (*family_parameter)[i] = x - step;
      const double below = unit.sum(GetParam());
      (*family_parameter)[i] = x;
      const double by_difference = (above - below) / (2 * step);
      EXPECT_NEAR(slope[at], by_difference, 1e-5 * std::max(1.0, std::abs(by_difference))) << at;
    }
  }
}

// Errors so small that the readings are the path.
TEST_P(HiddenPaths, SmallErrorsLeaveTheProcessItself) {
  Unit unit{{0.5, 1.2, 1.9, 3.1}, {0.6, 1.1, 1.7, 2.4}, {0.3, 0.3, 0.3, 0.3}, {}};
  const double exact = unit.sum(GetParam());
  unit.noise.assign(4, 1e-3);
  EXPECT_NEAR(unit.sum(GetParam()), exact, 3e-4);
}

// What is told of simulated units is true of them: scores are standard normal, and where they stand is off by as much as
// its variance says.
TEST_P(HiddenPaths, SimulatedUnitsAreWhereTheyAreSaidToBe) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> z;
  double sum = 0, squares = 0, off = 0, inside = 0;
  constexpr int units = 1500;
  std::vector<NormalScore> scores;
  for (int n = 0; n < units; ++n) {
    Unit unit = several;
    const std::vector<double> path = drawn_path(GetParam(), unit, random);
    for (std::size_t i = 0; i < path.size(); ++i)
      unit.reading[i] = path[i] + unit.noise[i] * z(random);
    process_scores(form_of(GetParam()), unit.rows(), scores);
    for (const NormalScore& each : scores) {
      sum += each.low;
      squares += each.low * each.low;
    }
    const Standing stands = standing(form_of(GetParam()), unit.rows());
    const double miss = (path.back() - stands.at) / std::sqrt(stands.variance);
    off += miss * miss / units;
    inside += std::abs(miss) < 1.6448536 ? 1.0 / units : 0;
  }
  const double count = units * 5.0;
  EXPECT_NEAR(sum / count, 0, 4 / std::sqrt(count));
  EXPECT_NEAR(squares / count, 1, 4 * std::sqrt(2 / count));
  EXPECT_NEAR(off, 1, 4 * std::sqrt(2.2 / units));
  EXPECT_NEAR(inside, 0.9, 4 * std::sqrt(0.09 / units));
}

INSTANTIATE_TEST_SUITE_P(Both, HiddenPaths,
                         testing::Values(Process::gamma, Process::inverse_gaussian),
                         [](const auto& which) {
                           return which.param == Process::gamma ? "Gamma" : "InverseGaussian";
                         });

}  // namespace
}  // namespace wearwell::formula_model
