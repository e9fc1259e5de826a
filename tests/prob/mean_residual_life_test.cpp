// Closed forms of mean lives against the integral of the survival function, of every family.
#include "wearwell/prob/mean_residual_life.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "wearwell/math/constants.h"
#include "wearwell/math/mean_beyond.h"
#include "wearwell/prob/response.h"

namespace wearwell {
namespace {

struct LifeExample {
  std::string name;
  std::vector<double> parameters;  // without a threshold
};

const std::vector<LifeExample> life_examples = {
    {"weibull", {700, 0.4}},
    {"weibull", {700, 1.7}},
    {"weibull", {700, 20}},
    {"exponential", {700}},
    {"gamma", {0.3, 500}},
    {"gamma", {6, 90}},
    {"lognormal", {700, 0.1}},
    {"lognormal", {700, 1.5}},
    {"log10-normal", {700, 0.4}},
    {"loglogistic", {700, 1.3}},
    {"loglogistic", {700, 5}},
    {"inverse-gaussian", {700, 300}},
    {"inverse-gaussian", {700, 9000}},
    {"birnbaum-saunders", {700, 0.3}},
    {"birnbaum-saunders", {700, 2}},
    {"frechet", {700, 1.4}},
    {"frechet", {700, 6}},
    {"generalized-gamma", {700, 0.6, 1.5}},
    {"generalized-gamma", {700, 0.6, 0.4}},
    {"generalized-gamma", {700, 0.6, 0.02}},
    {"generalized-gamma", {700, 0.6, 0}},
    {"generalized-gamma", {700, 0.6, -0.8}},
    {"generalized-gamma", {700, 1.2, 1}},
    {"exponentiated-weibull", {700, 1.5, 2}},
    {"exponentiated-weibull", {700, 5, 0.05}},
    {"exponentiated-weibull", {700, 0.4, 300}},
    {"exponentiated-weibull", {700, 110, 0.15}},
};

const ResponseForm* form_with(const LifeExample& life, bool threshold) {
  const std::size_t count = life.parameters.size() + (threshold ? 1 : 0);
  for (const ResponseForm& each : response_forms())
    if (each.name == life.name && each.family_parameters.size() == count &&
        each.family_parameters.back().name.starts_with("threshold") == threshold)
      return &each;
  return nullptr;
}

double integral(ResponseFamily family, double from, const std::vector<double>& s) {
  return mean_beyond([&](double x) { return log_survival(family, x, s.data()); },
                     quantile(family, 0.5, s.data()), from);
}

TEST(MeanResidualLife, IsTheIntegralOfTheSurvivalFunction) {
  for (const LifeExample& life : life_examples) {
    for (const double threshold : {0.0, 50.0}) {
      const ResponseForm* const form = form_with(life, threshold > 0);
      ASSERT_TRUE(form) << life.name;
      std::vector<double> s = life.parameters;
      if (threshold > 0) s.push_back(threshold);
      const auto mean = mean_residual_life(form->family, 0, s.data());
      ASSERT_TRUE(mean) << life.name;
      EXPECT_NEAR(*mean / integral(form->family, 0, s), 1, 1e-6) << life.name << " " << s[1];
      for (const double share : {1e-4, 0.1, 0.6, 0.99, 1 - 1e-9}) {
        const double from = quantile(form->family, share, s.data());
        const auto left = mean_residual_life(form->family, from, s.data());
        if (!left) continue;
        EXPECT_NEAR(*left / integral(form->family, from, s), 1, 1e-6)
            << life.name << " " << s[1] << " from " << share;
      }
    }
  }
}

// Each family of the list that can be a life has examples.
TEST(MeanResidualLife, IsTestedOfEveryFamily) {
  for (const ResponseForm& each : response_forms()) {
    if (!each.positive || each.counted || each.family_parameters.front().name == "mean") continue;
    bool found = false;
    for (const LifeExample& life : life_examples) found |= life.name == each.name;
    EXPECT_TRUE(found) << each.name;
  }
}

TEST(MeanResidualLife, IsClosedBeyondAnAge) {
  for (const std::string name : {"weibull", "exponential", "gamma", "lognormal"}) {
    for (const LifeExample& life : life_examples) {
      if (life.name != name) continue;
      EXPECT_TRUE(mean_residual_life(form_with(life, false)->family, 300, life.parameters.data()))
          << name;
    }
  }
  // An exponential life does not age; nor far in the tail, where the hazard is 1e9.
  const double weibull[] = {2, 1}, old[] = {1e-9, 1};
  EXPECT_NEAR(*mean_residual_life(ResponseFamily::weibull, 80, weibull), 2, 1e-9);
  EXPECT_NEAR(*mean_residual_life(ResponseFamily::weibull, 1, old) / 1e-9, 1, 1e-8);
  const double rayleigh[] = {1, 2};  // sqrt(pi)/2 erfc(2) e^4
  EXPECT_NEAR(*mean_residual_life(ResponseFamily::weibull, 2, rayleigh),
              std::sqrt(M_PI) / 2 * std::erfc(2) * std::exp(4), 1e-12);
}

TEST(MeanResidualLife, IsInfiniteWhereTheIntegralIs) {
  const auto of = [](const LifeExample& life) {
    return mean_residual_life(form_with(life, false)->family, 0, life.parameters.data()).value();
  };
  EXPECT_EQ(of({"loglogistic", {700, 1}}), infinity);
  EXPECT_EQ(of({"loglogistic", {700, 0.5}}), infinity);
  EXPECT_EQ(of({"frechet", {700, 0.9}}), infinity);
  EXPECT_EQ(of({"generalized-gamma", {700, 1, -1}}), infinity);
  EXPECT_EQ(of({"generalized-gamma", {700, 2, -0.7}}), infinity);
  EXPECT_TRUE(std::isnan(of({"weibull", {700, -1}})));
}

// Lives that may end before 0 are cut there by the integral.
TEST(MeanResidualLife, OfAThresholdBelowZeroIsLeftToTheIntegral) {
  const ResponseForm* const form = form_with({"weibull", {700, 1.7}}, true);
  const double s[] = {700, 1.7, -20};
  EXPECT_FALSE(mean_residual_life(form->family, 0, s));
}

}  // namespace
}  // namespace wearwell
