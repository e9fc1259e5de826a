#include "wearwell/math/mean_beyond.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "wearwell/math/constants.h"

namespace wearwell {
namespace {

// eta Gamma(1 + 1/beta); beyond x of an exponential life the mean stays.
TEST(MeanBeyond, OfWeibullLives) {
  for (const double shape : {0.3, 0.8, 1.0, 1.7, 6.0, 40.0}) {
    for (const double scale : {1e-9, 1.0, 3e7}) {
      const auto log_survival = [&](double x) { return -std::pow(x / scale, shape); };
      const double median = scale * std::pow(std::numbers::ln2, 1 / shape);
      EXPECT_NEAR(mean_beyond(log_survival, median) / (scale * std::tgamma(1 + 1 / shape)), 1, 1e-8)
          << shape << " " << scale;
      if (shape == 1) {
        EXPECT_NEAR(mean_beyond(log_survival, median, 5 * scale) / scale, 1, 1e-8);
        EXPECT_NEAR(mean_beyond(log_survival, median, 600 * scale) / scale, 1, 1e-8);
      }
    }
  }
}

// Gamma(1 + 1/beta, (x/eta)^beta) eta exp((x/eta)^beta); R: gamma(1.5)*pgamma(4, 1.5,
// lower.tail = FALSE)*exp(4) - 2, of beta = 2, eta = 1, x = 2, by parts sqrt(pi)/2 erfc(2) exp(4).
TEST(MeanBeyond, OfSurvivors) {
  const auto log_survival = [](double x) { return -x * x; };
  EXPECT_NEAR(mean_beyond(log_survival, std::sqrt(std::numbers::ln2), 2),
              std::sqrt(std::numbers::pi) / 2 * std::erfc(2) * std::exp(4), 1e-9);
}

// A life with a threshold: a kink in the survival function.
TEST(MeanBeyond, OfAThreshold) {
  for (const double threshold : {1e-3, 1.0, 1e4}) {
    const auto log_survival = [&](double x) { return x > threshold ? threshold - x : 0; };
    const double median = threshold + std::numbers::ln2;
    EXPECT_NEAR(mean_beyond(log_survival, median) / (threshold + 1), 1, 1e-8) << threshold;
    EXPECT_NEAR(mean_beyond(log_survival, median, threshold / 2) / (threshold / 2 + 1), 1, 1e-8);
  }
}

// Loglogistic lives: scale (pi/b)/sin(pi/b), infinite for b <= 1; Pareto's 1/(b - 1) beyond 1.
TEST(MeanBeyond, OfHeavyTails) {
  const auto loglogistic = [](double shape) {
    return [shape](double x) { return -std::log1p(std::pow(x, shape)); };
  };
  for (const double shape : {1.01, 1.2, 2.0, 8.0}) {
    const double angle = std::numbers::pi / shape;
    EXPECT_NEAR(mean_beyond(loglogistic(shape), 1) / (angle / std::sin(angle)), 1, 1e-6) << shape;
  }
  EXPECT_EQ(mean_beyond(loglogistic(1), 1), infinity);
  EXPECT_EQ(mean_beyond(loglogistic(0.5), 1), infinity);
}

TEST(MeanBeyond, OfLognormalLives) {
  for (const double sigma : {0.1, 1.0, 3.0}) {
    const auto log_survival = [&](double x) {
      const double z = std::log(x) / sigma;
      return z < 30 ? std::log(0.5 * std::erfc(z / std::numbers::sqrt2))
                    : -0.5 * z * z - std::log(z * std::sqrt(2 * std::numbers::pi));
    };
    EXPECT_NEAR(mean_beyond(log_survival, 1) / std::exp(sigma * sigma / 2), 1, 1e-7) << sigma;
  }
}

TEST(MeanBeyond, IsNaNWhereNothingSurvives) {
  const auto log_survival = [](double x) { return x < 1 ? std::log1p(-x) : -infinity; };
  EXPECT_NEAR(mean_beyond(log_survival, 0.5), 0.5, 1e-8);
  EXPECT_NEAR(mean_beyond(log_survival, 0.5, 0.5), 0.25, 1e-8);
  EXPECT_TRUE(std::isnan(mean_beyond(log_survival, 0.5, 1)));
  EXPECT_TRUE(std::isnan(mean_beyond(log_survival, NAN)));
  EXPECT_TRUE(std::isnan(mean_beyond([](double) { return NAN; }, 1, 1)));
}

}  // namespace
}  // namespace wearwell
