#include "wearwell/infer/model_weights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace wearwell {
namespace {

Loo loo_of(const std::vector<double>& elpd, int count = 1) {
  Loo loo;
  for (const double each : elpd) loo.terms.push_back({each, each, 0.1, count});
  return loo;
}

double score(const std::vector<Loo>& models, const std::vector<double>& weights) {
  double sum = 0;
  for (std::size_t i = 0; i < models[0].terms.size(); ++i) {
    double density = 0;
    for (std::size_t k = 0; k < models.size(); ++k)
      density += weights[k] * std::exp(models[k].terms[i].elpd);
    sum += models[0].terms[i].count * std::log(density);
  }
  return sum;
}

std::vector<double> weights_of(const std::vector<Loo>& models) {
  std::vector<const Loo*> all;
  for (const Loo& each : models) all.push_back(&each);
  return model_weights(all);
}

// No other point of a fine grid over three weights scores more.
TEST(ModelWeights, NoOtherMixturePredictsBetter) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  for (int repeat = 0; repeat < 20; ++repeat) {
    std::vector<Loo> models;
    for (int k = 0; k < 3; ++k) {
      std::vector<double> elpd;
      for (int i = 0; i < 15; ++i) elpd.push_back(-12 + normal(random) - 0.2 * k * repeat / 10);
      models.push_back(loo_of(elpd));
    }
    for (std::size_t i = 0; i < 15; ++i) {
      for (Loo& each : models) each.terms[i].count = 1 + static_cast<int>(i % 3);
    }
    const std::vector<double> found = weights_of(models);
    EXPECT_NEAR(found[0] + found[1] + found[2], 1, 1e-12);
    const double best = score(models, found);
    constexpr int steps = 100;
    for (int a = 0; a <= steps; ++a) {
      for (int b = 0; a + b <= steps; ++b) {
        const double x = a / double{steps}, y = b / double{steps};
        EXPECT_LE(score(models, {x, y, 1 - x - y}), best + 1e-7);
      }
    }
  }
}

TEST(ModelWeights, OfOneOfTwinsAndOfTheHopeless) {
  EXPECT_EQ(weights_of({loo_of({-3, -4})}), std::vector<double>{1});
  const std::vector<double> twins = weights_of({loo_of({-3, -4}), loo_of({-3, -4})});
  EXPECT_DOUBLE_EQ(twins[0], 0.5);
  EXPECT_NEAR(weights_of({loo_of({-3, -4}), loo_of({-900, -901})})[0], 1, 1e-12);
  EXPECT_NEAR(weights_of({loo_of({-3, -4}), loo_of({-INFINITY, -5})})[0], 1, 1e-8);
  // By units, all densities of an observation change alike: weights stay.
  const auto a = weights_of({loo_of({-3, -6, -4}), loo_of({-5, -4, -4.5})});
  const auto b = weights_of({loo_of({-903, 6, -4}), loo_of({-905, 8, -4.5})});
  EXPECT_NEAR(a[0], b[0], 1e-7);
  EXPECT_THROW(weights_of({loo_of({-3}), loo_of({-3, -4})}), std::invalid_argument);
}

}  // namespace
}  // namespace wearwell
