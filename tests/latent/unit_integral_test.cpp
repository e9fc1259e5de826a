#include "wearwell/latent/unit_integral.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "wearwell/math/constants.h"

namespace wearwell::latent {
namespace {

// Units whose log likelihoods are given formulas, with slopes by differences.
class Formulas final : public UnitTerms {
 public:
  using F = std::function<double(const double* z)>;
  Formulas(int effects, std::vector<F> formulas) : effects_(effects), f_(std::move(formulas)) {}

  std::size_t units() const override { return f_.size(); }
  int effects() const override { return effects_; }
  void evaluate(std::span<const double> z, std::span<const std::uint8_t> wanted,
                std::span<double> value, std::span<double> slope) override {
    const auto d = static_cast<std::size_t>(effects_);
    for (std::size_t u = 0; u < f_.size(); ++u) {
      if (!wanted[u]) continue;
      value[u] = f_[u](&z[u * d]);
      if (slope.empty()) continue;
      for (std::size_t e = 0; e < d; ++e) {
        double at[2] = {z[u * d], d > 1 ? z[u * d + 1] : 0};
        const double here = at[e], step = 1e-6 * (1 + std::abs(here));
        at[e] = here + step;
        const double above = f_[u](at);
        at[e] = here - step;
        slope[u * d + e] = (above - f_[u](at)) / (2 * step);
      }
    }
  }

 private:
  int effects_;
  std::vector<F> f_;
};

double normal(double y, double mean, double sd) {
  const double z = (y - mean) / sd;
  return -0.5 * z * z - std::log(sd) - 0.91893853320467274178;
}

double student(double y, double mean, double scale) {  // of 3 degrees of freedom
  const double t = (y - mean) / scale;
  return std::lgamma(2.0) - std::lgamma(1.5) - 0.5 * std::log(3 * M_PI) - std::log(scale) -
         2 * std::log1p(t * t / 3);
}

// A sum over so fine a grid that the narrowest integrand here is smooth on it.
double brute_force(const Formulas::F& f) {
  constexpr double step = 2e-5;
  constexpr int most = 1'000'000;
  double highest = -infinity, sum = 0;
  for (int i = -most; i <= most; ++i) {
    const double z = i * step, log_f = f(&z) - 0.5 * z * z;
    if (!(log_f > -infinity) || log_f < highest - 45) continue;
    if (log_f > highest) {
      sum *= std::exp(highest - log_f);
      highest = log_f;
    }
    sum += std::exp(log_f - highest);
  }
  return highest + std::log(sum * step) - 0.91893853320467274178;
}

// One to five readings of a unit; precise, coarse and contradicting each other; a rate that is
// lognormal, one that is normal; an outlier under a long-tailed law; a count of nothing.
TEST(UnitIntegral, AgreesWithBruteForce) {
  const auto readings = [](std::vector<double> y, double sd, double scatter) {
    return [=](const double* z) {
      double sum = 0;
      for (std::size_t i = 0; i < y.size(); ++i) {
        sum += normal(y[i], 2 * std::exp(scatter * z[0]) * (static_cast<double>(i) + 1), sd);
      }
      return sum;
    };
  };
  const std::vector<Formulas::F> units = {
      readings({2.3}, 0.5, 0.4),
      readings({2.3, 4.1, 6.9, 8.0, 10.4}, 0.1, 0.4),
      readings({2.3, 4.1, 6.9}, 1e-3, 0.8),
      readings({2.3, 4.1}, 50, 1.5),
      readings({9, 2, 30}, 0.3, 0.2),
      readings({-1, -2}, 0.3, 1),
      [](const double* z) { return normal(4, 3 + 0.7 * z[0], 0.4); },
      [](const double* z) { return student(-6, z[0], 0.2) + student(6, z[0], 0.2); },
      [](const double* z) { return student(-6, z[0], 0.2) + 2 * student(3, z[0], 0.2); },
      [](const double* z) { return -10 * std::exp(2 * z[0]); },
      [](const double* z) { return 40 * z[0] - std::exp(3 * z[0]); },
      [](const double*) { return 0.0; },
      [](const double* z) { return z[0] > -1.5 ? 3 * std::log(z[0] + 1.5) : -infinity; },
  };
  Formulas terms(1, units);
  UnitIntegrals result;
  integrate(terms, result);
  for (std::size_t u = 0; u < units.size(); ++u) {
    // Bumps narrower than the step, of e^-9 of the whole, and an edge cost digits.
    const bool rough = u == 7 || u == 8 || u + 1 == units.size();
    EXPECT_NEAR(result.log_likelihood[u], brute_force(units[u]), rough ? 3e-6 : 1e-9) << u;
    double sum = 0;
    for (const Sweep& sweep : result.sweeps) sum += sweep.weight[u];
    EXPECT_NEAR(sum, 1, 1e-10) << u;
  }
}

// Far from where the search begins, which is a summit of its own: nothing grows there.
TEST(UnitIntegral, FindsAModeThatIsNowhereNear) {
  const std::vector<Formulas::F> units = {[](const double* z) {
    double sum = 0;
    for (int i = 1; i <= 5; ++i) sum += normal(2.0 * i, 2e-7 * i * std::exp(4.6 * z[0]), 0.01);
    return sum;
  }};
  Formulas terms(1, units);
  UnitIntegrals result;
  integrate(terms, result);
  EXPECT_TRUE(result.settled);
  double mean = 0;
  for (const Sweep& sweep : result.sweeps) mean += sweep.weight[0] * sweep.z[0];
  EXPECT_NEAR(mean, std::log(1e7) / 4.6, 1e-3);
  EXPECT_NEAR(result.log_likelihood[0], brute_force(units[0]), 1e-9);
}

// Readings a + b t with both effects: the integral of a normal law of five dimensions is known.
TEST(UnitIntegral, TwoEffectsAgreeWithTheNormalLaw) {
  const double y[] = {1.2, 3.3, 4.1, 6.6}, sd = 0.5, r = -0.6, sa = 0.8, sb = 0.3;
  const auto linear = [&](const double* z) {
    const double a = 1 + sa * z[0], b = 1.5 + sb * (r * z[0] + std::sqrt(1 - r * r) * z[1]);
    double sum = 0;
    for (int i = 0; i < 4; ++i) sum += normal(y[i], a + b * i, sd);
    return sum;
  };
  // log N(y; 1 + 1.5 t, sd^2 I + [1 t] S [1 t]') by R: see below.
  //   t <- 0:3; y <- c(1.2, 3.3, 4.1, 6.6); Z <- cbind(1, t); S <- diag(c(.8,.3)) %*% matrix(c(1,-.6,-.6,1),2) %*% diag(c(.8,.3))
  //   V <- .25*diag(4) + Z %*% S %*% t(Z); e <- y - 1 - 1.5*t
  //   -.5*(4*log(2*pi) + log(det(V)) + t(e) %*% solve(V, e))
  const double expected = -3.88748719648174;
  // Far from linear: a rate that is lognormal and a power, on a grid of brute force.
  const auto bent = [&](const double* z) {
    double sum = 0;
    for (int i = 1; i < 5; ++i) {
      sum += normal(y[i - 1], std::exp(0.5 * z[0]) * std::pow(i, 1 + 0.3 * z[1]), 0.4);
    }
    return sum;
  };
  double brute = 0;
  constexpr double step = 0.005;
  for (int i = -1600; i <= 1600; ++i) {
    for (int j = -1600; j <= 1600; ++j) {
      const double z[] = {i * step, j * step};
      const double log_f = bent(z) - 0.5 * (z[0] * z[0] + z[1] * z[1]);
      if (log_f > -60) brute += std::exp(log_f);
    }
  }
  brute = std::log(brute * step * step / (2 * M_PI));
  Formulas terms(2, {linear, bent});
  UnitIntegrals result;
  integrate(terms, result);
  EXPECT_NEAR(result.log_likelihood[0], expected, 1e-8);
  EXPECT_NEAR(result.log_likelihood[1], brute, 1e-7);
  EXPECT_TRUE(result.settled);
  double mean = 0;
  for (const Sweep& sweep : result.sweeps) mean += sweep.weight[0] * sweep.z[0];
  EXPECT_NEAR(mean, 0.360528583740304, 1e-8);
}

TEST(UnitIntegral, AUnitWithoutADensityIsSaid) {
  Formulas terms(1, {[](const double*) { return -infinity; }, [](const double*) { return -1.0; }});
  UnitIntegrals result;
  integrate(terms, result);
  EXPECT_EQ(result.log_likelihood[0], -infinity);
  EXPECT_NEAR(result.log_likelihood[1], -1, 1e-12);
  EXPECT_EQ(result.sum(), -infinity);
}

}  // namespace
}  // namespace wearwell::latent
