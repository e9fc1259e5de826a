// Simulation-based calibration (Talts et al. 2018) of families of lives by quadrature: exact lives, lives between two looks, run-outs,
// late entries. Lives are drawn by formulas written out here. WEARWELL_REPLICATIONS says how many.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <boost/math/special_functions/gamma.hpp>
#include <cmath>

#include "calibration/formula_design.h"
#include "calibration/inspected_lives.h"
#include "calibration/places_of_truth.h"
#include "calibration/shares.h"
#include "wearwell/base/rng.h"

namespace wearwell::formula_model {
namespace {

constexpr int bins = 10;
constexpr std::size_t parts = 30;
constexpr std::uint64_t seed = 20261127;

// A life of the parameters in the order of the priors.
using DrawLife = double (*)(const std::vector<double>& x, Rng& rng);

double weibull(double scale, double shape, Rng& rng) {
  return scale * std::pow(-std::log(rng.uniform()), 1 / shape);
}

void calibrate(const std::string& name, const std::string& likelihood_and_prior, DrawLife draw) {
  const FormulaDesign design(
      "[data.columns]\nlife = { column = \"life\", unit = \"1\" }\n[likelihood.life]\n" +
          likelihood_and_prior,
      {numbers("life", std::vector<double>(parts, 500))});
  std::vector<std::vector<double>> all(static_cast<std::size_t>(replications(200)));
  tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t i) {
    Rng rng(seed, i);
    const std::vector<double> x = design.from_priors(rng);
    const auto lives = inspected_lives(
        parts, [&] { return draw(x, rng); }, Watch{.longest = 600, .apart = 120, .late = 60});
    all[i] = places_of_study(x, std::make_shared<const FormulaRows>(design.with(lives), parts), i);
  });
  expect_even(name, design.model->parameters, all, bins);
}

TEST(LifeFamiliesCalibration, BirnbaumSaunders) {
  calibrate("Birnbaum-Saunders", R"toml(
family = "birnbaum-saunders"
scale = "eta"
shape = "a"
[prior]
eta = { distribution = "lognormal", median = 300, log_sd = 0.5 }
a = { distribution = "lognormal", median = 0.6, log_sd = 0.4 }
)toml",
            [](const std::vector<double>& x, Rng& rng) {
              const double half = 0.5 * x[1] * rng.normal(), root = half + std::hypot(half, 1);
              return x[0] * root * root;
            });
}

TEST(LifeFamiliesCalibration, GeneralizedGamma) {
  calibrate("generalized gamma", R"toml(
family = "generalized-gamma"
scale = "eta"
sigma = "s"
lambda = "q"
[prior]
eta = { distribution = "lognormal", median = 300, log_sd = 0.5 }
s = { distribution = "lognormal", median = 0.6, log_sd = 0.4 }
q = { distribution = "normal", mean = 0.5, sd = 0.7 }
)toml",
            [](const std::vector<double>& x, Rng& rng) {
              const double kappa = 1 / (x[2] * x[2]);
              const double standard = boost::math::gamma_p_inv(kappa, rng.uniform()) / kappa;
              return x[0] * std::exp(x[1] * std::log(standard) / x[2]);
            });
}

TEST(LifeFamiliesCalibration, ExponentiatedWeibull) {
  calibrate("exponentiated Weibull", R"toml(
family = "exponentiated-weibull"
scale = "eta"
shape = "beta"
exponent = "e"
[prior]
eta = { distribution = "lognormal", median = 300, log_sd = 0.5 }
beta = { distribution = "lognormal", median = 1.5, log_sd = 0.4 }
e = { distribution = "lognormal", median = 1, log_sd = 0.6 }
)toml",
            [](const std::vector<double>& x, Rng& rng) {
              const double p = std::pow(rng.uniform(), 1 / x[2]);
              return x[0] * std::pow(-std::log1p(-p), 1 / x[1]);
            });
}

// A shape below 1 has an unbounded density at the threshold.
TEST(LifeFamiliesCalibration, WeibullWithAThreshold) {
  calibrate("Weibull with a threshold", R"toml(
family = "weibull"
scale = "eta"
shape = "beta"
threshold = "t0"
[prior]
eta = { distribution = "lognormal", median = 200, log_sd = 0.5 }
beta = { distribution = "lognormal", median = 1.8, log_sd = 0.4 }
t0 = { distribution = "uniform", lower = 0, upper = 200 }
)toml",
            [](const std::vector<double>& x, Rng& rng) { return x[2] + weibull(x[0], x[1], rng); });
}

TEST(LifeFamiliesCalibration, LognormalWithAThreshold) {
  calibrate("lognormal with a threshold", R"toml(
family = "lognormal"
median = "m"
log_sd = "s"
threshold = "t0"
[prior]
m = { distribution = "lognormal", median = 200, log_sd = 0.5 }
s = { distribution = "lognormal", median = 0.6, log_sd = 0.4 }
t0 = { distribution = "uniform", lower = 0, upper = 200 }
)toml",
            [](const std::vector<double>& x, Rng& rng) {
              return x[2] + x[0] * std::exp(x[1] * rng.normal());
            });
}

TEST(LifeFamiliesCalibration, DeadOnArrival) {
  calibrate("Weibull, some dead on arrival", R"toml(
family = "weibull"
scale = "eta"
shape = "beta"
share_dead_on_arrival = "d"
[prior]
eta = { distribution = "lognormal", median = 300, log_sd = 0.5 }
beta = { distribution = "lognormal", median = 1.5, log_sd = 0.4 }
d = { distribution = "beta", alpha = 2, beta = 5 }
)toml",
            [](const std::vector<double>& x, Rng& rng) {
              return rng.uniform() < x[2] ? 0 : weibull(x[0], x[1], rng);
            });
}

}  // namespace
}  // namespace wearwell::formula_model
