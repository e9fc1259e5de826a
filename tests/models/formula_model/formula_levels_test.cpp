// B-lives at any level and confidence, lives of those that have come so far, and measurements of units that were seen,
// against the formulas of straight paths summed over the draws.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "support/posterior_study.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/study/run_study.h"

namespace wearwell {
namespace {

double normal_below(double z) {
  return 0.5 * std::erfc(-z / std::sqrt(2.0));
}

// The z with that share below, by halving.
double normal_at(double p) {
  double low = -40, high = 40;
  for (int i = 0; i < 200; ++i)
    (normal_below((low + high) / 2) < p ? low : high) = (low + high) / 2;
  return low;
}

double quantile(std::vector<std::pair<double, double>> values_and_weights, double p) {
  std::sort(values_and_weights.begin(), values_and_weights.end());
  double all = 0, sum = 0;
  for (const auto& [value, weight] : values_and_weights) all += weight;
  for (const auto& [value, weight] : values_and_weights) {
    if ((sum += weight) >= p * all) return value;
  }
  return NAN;
}

class FormulaLevels : public ScratchTest {
 protected:
  void SetUp() override {
    ScratchTest::SetUp();
    for (const char* file : {"formula/wear.csv", "life/bearings.csv"}) {
      const std::filesystem::path from =
          std::filesystem::path(PROJECT_SOURCE_DIR) / "examples" / file;
      std::filesystem::copy_file(from, folder() / from.filename());
    }
  }
  // An example with another [predict].
  std::string example(const std::string& name, const std::string& predict) const {
    std::ifstream file(PROJECT_SOURCE_DIR "/examples/" + name + "/study.toml");
    std::stringstream text;
    text << file.rdbuf();
    return text.str().substr(0, text.str().find("[predict]")) + "[predict]\n" + predict;
  }
  PosteriorSummary run(const std::string& text, int draws = 4000) const {
    return run_study(wearwell::read_posterior_study(write("study.toml", text)),
                     {Method::exact, 1, {}, draws, {}}, {}, false);
  }
  std::string refusal(const std::string& text) const {
    return message_of<InputError>(
        [&] { wearwell::read_posterior_study(write("study.toml", text)).description(); });
  }
  static const QuantitySummary& found(const PosteriorSummary& result, const std::string& name,
                                      const std::string& of) {
    for (const QuantitySummary& each : result.quantities) {
      if (each.name == name && each.of == of) return each;
    }
    throw std::logic_error("no " + name + " of " + of);
  }
};

const char* const machines =
    "along = \"distance\"\ngiven = { force = \"20 N\" }\nlimit = { wear = \"100 um\" }\n";

// The life of a machine is 0.25 m / k (in the study's units), lognormal about the median machine's.
TEST_F(FormulaLevels, BLivesOfMachinesAreThoseOfTheirLaw) {
  const PosteriorSummary result = run(example(
      "formula", machines + std::string("b_lives = [0.1, 5, \"30 %\"]\ncredible_level = 0.95\n")));
  const Points& draws = result.posterior_draws.front().values;
  for (const double percent : {0.1, 5.0, 30.0}) {
    const QuantitySummary& b = found(result, fmt::format("B{:g} life", percent), "machine");
    EXPECT_EQ(b.unit, "km");
    EXPECT_EQ(*b.credible_level, 0.95);
    std::vector<std::pair<double, double>> lives;
    double below = 0;
    for (Eigen::Index i = 0; i < draws.rows(); ++i) {
      const double middle = 0.25e-3 / draws(i, 0), scatter = draws(i, 2);
      lives.emplace_back(middle * std::exp(scatter * normal_at(percent / 100)), 1);
      below += normal_below(std::log(*b.drawn.predictive / middle) / scatter) /
               static_cast<double>(draws.rows());
    }
    EXPECT_NEAR(b.drawn.q05 / quantile(lives, 0.05), 1, 0.005) << percent;
    EXPECT_NEAR(b.drawn.q50 / quantile(lives, 0.5), 1, 0.005) << percent;
    EXPECT_NEAR(b.drawn.q95 / quantile(lives, 0.95), 1, 0.005) << percent;
    EXPECT_NEAR(*b.drawn.bound / quantile(lives, 0.05), 1, 0.005) << percent;
    EXPECT_NEAR(below / (percent / 100), 1, 0.03) << percent;
    EXPECT_NEAR(b.exact->q50 / b.drawn.q50, 1, 0.05) << percent;
    // Each point has the noise of its mixture of cells, and few points stand for the posterior: up to 0.6 % on some machines. The same of all cells of the quadrature: 100 um x 50 mm^2 = k x 20 N x distance, in km.
    const QuantityDistribution whole(result.fit->exact->nodes, [&](const double* x) {
      return 2.5e-13 / x[0] * std::exp(x[2] * normal_at(percent / 100));
    });
    EXPECT_NEAR(b.exact->q05 / whole.quantile(0.05), 1, 0.008) << percent;
    EXPECT_NEAR(b.exact->q50 / whole.quantile(0.5), 1, 0.008) << percent;
    EXPECT_NEAR(b.exact->q95 / whole.quantile(0.95), 1, 0.008) << percent;
    EXPECT_NEAR(*b.exact->bound / whole.quantile(0.05), 1, 0.008) << percent;
  }
  // What is asked beside them changes no bit of the life.
  const PosteriorSummary plain = run(example("formula", machines));
  EXPECT_EQ(found(plain, "life", "new machine").exact->b10,
            found(result, "life", "new machine").exact->b10);
  EXPECT_EQ(found(result, "B5 remaining useful life", "machine 3").best().bound.value(),
            found(result, "remaining useful life", "machine 3").best().q05);
}

TEST_F(FormulaLevels, LivesOfMachinesThatHaveComeSoFar) {
  const double far = 400;
  const PosteriorSummary result = run(example(
      "formula",
      machines + std::string("b_lives = [10]\ncredible_level = 0.8\nsurvived = \"400 km\"\n")));
  const Points& draws = result.posterior_draws.front().values;
  const QuantityQuantiles left = found(result, "remaining useful life", "new machine").drawn;
  const QuantityQuantiles b10 = found(result, "B10 remaining useful life", "machine").drawn;
  std::vector<std::pair<double, double>> lives;
  double all = 0, by_q05 = 0, by_q50 = 0;
  for (Eigen::Index i = 0; i < draws.rows(); ++i) {
    const double middle = 0.25e-3 / draws(i, 0), scatter = draws(i, 2);
    const auto outlasts = [&](double life) {
      return normal_below(-std::log(life / middle) / scatter);
    };
    const double come = outlasts(far);
    all += come;
    by_q05 += come - outlasts(far + left.q05);
    by_q50 += come - outlasts(far + left.q50);
    lives.emplace_back(middle * std::exp(-scatter * normal_at(0.9 * come)) - far, come);
  }
  EXPECT_NEAR(found(result, "survival to 400 km", "new machine").drawn.q50,
              100 * all / static_cast<double>(draws.rows()), 0.05);
  EXPECT_NEAR(by_q05 / all, 0.05, 0.001);
  EXPECT_NEAR(by_q50 / all, 0.5, 0.004);
  EXPECT_NEAR(b10.q50 / quantile(lives, 0.5), 1, 0.01);
  EXPECT_NEAR(*b10.bound / quantile(lives, 0.2), 1, 0.01);
  EXPECT_EQ(*b10.predictive, left.b10);
}

// What remains to one that was seen, beyond a place that it has not come to yet, is what remained before, cut there: of any
// posterior, so few draws are enough.
TEST_F(FormulaLevels, RemainingLivesOfASeenMachineAreCutAtThePlace) {
  const PosteriorSummary now =
      run(example("formula", machines + std::string("b_lives = [20, 36, 60]\n")), 50);
  const double last = 50;  // km, of machine 3
  const QuantityQuantiles& before = found(now, "remaining useful life", "machine 3").best();
  const double place = *found(now, "B20 remaining useful life", "machine 3").best().predictive;
  const PosteriorSummary later = run(
      example("formula",
              machines + fmt::format("b_lives = [20, 50]\nsurvived = \"{} km\"\n", last + place)),
      50);
  EXPECT_NE(found(later, "remaining useful life", "machine 3").at.find("on"), std::string::npos);
  const double survival =
      found(later, "survival to " + fmt::format("{:.6g} km", last + place), "machine 3").best().q50;
  EXPECT_NEAR(survival, 80, 1e-6);
  // 0.2 + 0.8 * 0.2 = 0.36, 0.2 + 0.8 * 0.5 = 0.6.
  const auto b = [&](const PosteriorSummary& of, const char* name) {
    return *found(of, name, "machine 3").best().predictive;
  };
  EXPECT_NEAR(b(later, "B20 remaining useful life"), b(now, "B36 remaining useful life") - place,
              1e-6 * before.q50);
  EXPECT_NEAR(b(later, "B50 remaining useful life"), b(now, "B60 remaining useful life") - place,
              1e-6 * before.q50);
}

TEST_F(FormulaLevels, WeibullLivesGivenThatTheyWereReached) {
  const PosteriorSummary result =
      run(example("life", "b_lives = [10]\ncredible_level = 0.95\nsurvived = \"60e6 cycles\"\n"));
  const Points& draws = result.posterior_draws.front().values;
  const double far = 60e6, million = 1e6;  // lives are told in millions, eta in cycles
  const QuantityQuantiles left = found(result, "remaining useful life", "new unit").drawn;
  const QuantityQuantiles b10 = found(result, "B10 remaining useful life", "unit").drawn;
  std::vector<std::pair<double, double>> lives;
  double all = 0, by_q05 = 0;
  for (Eigen::Index i = 0; i < draws.rows(); ++i) {
    const double eta = draws(i, 0), beta = draws(i, 1);
    const auto outlasts = [&](double life) { return std::exp(-std::pow(life / eta, beta)); };
    all += outlasts(far);
    by_q05 += outlasts(far) - outlasts(far + million * left.q05);
    const double b = eta * std::pow(std::pow(far / eta, beta) - std::log(0.9), 1 / beta) - far;
    lives.emplace_back(b / million, outlasts(far));
  }
  EXPECT_NEAR(by_q05 / all, 0.05, 1e-4);
  EXPECT_NEAR(b10.q50 / quantile(lives, 0.5), 1, 0.005);
  EXPECT_NEAR(*b10.bound / quantile(lives, 0.05), 1, 0.01);
  EXPECT_NEAR(*b10.predictive, left.b10, 1e-9 * left.b10);
}

TEST_F(FormulaLevels, WhatCannotBeHadIsRefused) {
  const auto expect = [&](const std::string& predict, const std::string& words) {
    const std::string said = refusal(example("formula", predict));
    EXPECT_NE(said.find(words), std::string::npos) << said;
  };
  expect(machines + std::string("b_lives = [0]\n"), "b_lives: are percentages between 0 and 100");
  expect(machines + std::string("credible_level = 1\n"),
         "credible_level: must lie between 0 and 1");
  expect(machines + std::string("survived = \"0 km\"\n"), "survived: must lie beyond 0 km");
  expect(machines + std::string("units = [\"3\"]\n"), "units: needs predict.at");
  expect("along = \"distance\"\nat = \"20 km\"\ngiven = { force = \"20 N\" }\nunits = \"99\"\n",
         "units: the data have no machine '99' (1, 2");
  expect("along = \"distance\"\nat = \"20 km\"\ngiven = { force = \"20 N\" }\nb_lives = 5\n",
         "b_lives: needs predict.limit");
}

}  // namespace
}  // namespace wearwell
