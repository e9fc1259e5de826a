// How often the check of fit accuses a right law whose units differ, or whose paths take random steps: parameters drawn
// from their priors, units from the parameters, readings from both. WEARWELL_REPLICATIONS says how many.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <cstdio>
#include <random>

#include "calibration/formula_design.h"
#include "calibration/shares.h"
#include "wearwell/base/rng.h"
#include "wearwell/infer/loo.h"
#include "wearwell/models/formula_model/formula_fit_data.h"

namespace wearwell::formula_model {
namespace {

constexpr std::size_t units = 6, readings = 6;

std::string study(const std::string& family, const std::string& family_parameters,
                  bool random_effects) {
  std::string text = R"(
[data.columns]
y = "y"
t = "t"
unit = "unit"
[likelihood.y]
family = ")" + family +
                     "\"\nmean = \"b*t\"\n" + family_parameters + R"(
[prior]
b = { distribution = "lognormal", median = 1, log_sd = 0.5 }
sigma = { distribution = "half-normal", scale = 0.5 }
)";
  if (random_effects) {
    text +=
        "scatter = { distribution = \"half-normal\", scale = 0.5 }\n[random_effects.unit]\n"
        "b = { distribution = \"lognormal\", log_sd = \"scatter\" }\n";
  }
  return text + "[predict]\nalong = \"t\"\n";
}

FormulaDesign design(const std::string& text) {
  std::vector<double> y, t;
  std::vector<std::string> unit;
  for (std::size_t u = 0; u < units; ++u) {
    for (std::size_t i = 1; i <= readings; ++i) {
      y.push_back(static_cast<double>(i));
      t.push_back(static_cast<double>(i));
      unit.push_back("u" + std::to_string(u));
    }
  }
  return {text, {numbers("y", y), numbers("t", t), texts("unit", unit)}};
}

enum class Path { straight, wiener, gamma };

// Draws of a gamma distribution: the standard library's, independent of the code that is tested.
double gamma_step(double shape, double scale, Rng& rng) {
  std::seed_seq seeds{rng.bits(), rng.bits()};
  std::mt19937_64 engine(seeds);
  return std::gamma_distribution<double>(shape, scale)(engine);
}

// The smallest p value times the number of tests; NaN where there was no posterior.
double judged(const FormulaDesign& own, Path kind, double bent, std::uint64_t stream) {
  Rng rng(20261123, stream);
  const std::vector<double> x = own.from_priors(rng);
  const double scatter = x.size() > 2 ? x[2] : 0;
  std::vector<Response> responses;
  for (std::size_t u = 0; u < units; ++u) {
    const double rate = x[0] * std::exp(scatter * rng.normal());
    double path = 0;
    for (std::size_t i = 1; i <= readings; ++i) {
      const double t = static_cast<double>(i);
      const double mean = rate * (t + bent * t * (t - 3.5));
      if (kind == Path::wiener) path += rate + x[1] * rng.normal();
      // Of a step of mean `rate` the variance is sigma times that.
      if (kind == Path::gamma) path += gamma_step(rate / x[1], x[1], rng);
      responses.push_back({.at = kind == Path::straight ? mean + x[1] * rng.normal() : path});
    }
  }
  const auto rows = std::make_shared<const FormulaRows>(own.with(responses), responses.size());
  const ExactPosterior exact = exact_posterior(rows, 3e-3);
  if (!exact.failure.empty()) return NAN;
  const WeightedSampler sampler(exact.nodes);
  WeightedDraws draws;
  draws.values.resize(100, static_cast<Eigen::Index>(x.size()));
  for (Eigen::Index i = 0; i < 100; ++i) draws.values.row(i) = sampler(rng).transpose();
  draws.weights.setConstant(100, 0.01);
  return judge_fit(*fit_data(rows), draws, Loo{}).p;
}

struct Alarms {
  int warned = 0, failed = 0, without = 0, count = 0;
};

Alarms simulate(const char* name, const FormulaDesign& own, Path kind, double bent, int otherwise) {
  const int count = replications(otherwise);
  std::vector<double> p(static_cast<std::size_t>(count));
  tbb::parallel_for(0, count, [&](int i) {
    p[static_cast<std::size_t>(i)] = judged(own, kind, bent, static_cast<std::uint64_t>(i));
  });
  Alarms alarms{.count = count};
  for (const double each : p) {
    alarms.without += std::isnan(each);
    alarms.warned += each < fit_warns_below;
    alarms.failed += each < fit_fails_below;
  }
  std::printf("%s, %d studies: warned %d, failed %d; %d without quadrature\n", name, count,
              alarms.warned, alarms.failed, alarms.without);
  std::fflush(stdout);
  return alarms;
}

void expect_few(const Alarms& alarms, const std::string& of) {
  expect_share(alarms.warned, alarms.count, 0.01, of + ", warned");
  expect_share(alarms.failed, alarms.count, 0.002, of + ", failed");
  EXPECT_EQ(alarms.without, 0);
}

TEST(FormulaFitCalibration, UnitsThatDiffer) {
  const FormulaDesign own = design(study("normal", "sd = \"sigma\"", true));
  expect_few(simulate("units that differ", own, Path::straight, 0, 400), "units that differ");
  // Half of 200 such studies fail.
  const Alarms bent = simulate("the same, bent", own, Path::straight, 0.1, 40);
  expect_share(bent.count - bent.failed, bent.count, 0.8, "bent paths that do not fail");
}

TEST(FormulaFitCalibration, RandomSteps) {
  expect_few(
      simulate("Wiener process", design(study("wiener-process", "sd = \"sigma*sqrt(t)\"", false)),
               Path::wiener, 0, 400),
      "Wiener process");
  expect_few(simulate("gamma process", design(study("gamma-process", "scale = \"sigma\"", false)),
                      Path::gamma, 0, 400),
             "gamma process");
}

}  // namespace
}  // namespace wearwell::formula_model
