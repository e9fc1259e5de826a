// Published maximum likelihood fits of lives, from the file of a study to its likelihood
// (tests/golden/formula_model.R computes them a second time).
#include <gtest/gtest.h>

#include <cmath>

#include "support/scratch.h"
#include "wearwell/infer/maximize.h"
#include "wearwell/models/formula_model/formula_likelihood.h"
#include "wearwell/models/formula_model/formula_reader.h"

namespace wearwell::formula_model {
namespace {

class PublishedLives : public ScratchTest {
 protected:
  std::shared_ptr<const LogDensity> likelihood(const std::string& file, const std::string& text) {
    std::filesystem::copy_file(PROJECT_SOURCE_DIR "/" + file, folder() / "d.csv");
    const Source source =
        source_of(write("study.toml", "model = \"formula\"\n[data]\nfile = \"d.csv\"\n" + text));
    const TomlReader root = TomlReader::parse(source.study);
    const auto model = read_formula_model(root, source);
    return formula_likelihood(std::make_shared<const FormulaRows>(model, model->data.table.rows));
  }
};

Maximum climb(const LogDensity& density, const std::vector<double>& start,
              const std::vector<double>& unit, double lowest = -INFINITY) {
  const auto n = static_cast<Eigen::Index>(start.size());
  return maximize(density, Eigen::Map<const Eigen::VectorXd>(start.data(), n),
                  Eigen::Map<const Eigen::VectorXd>(unit.data(), n),
                  {Eigen::VectorXd::Constant(n, lowest), Eigen::VectorXd::Constant(n, INFINITY)});
}

std::string alloy(const std::string& shape, const std::string& priors) {
  return R"toml(
[data.columns]
life = "kcycles"
stress = { column = "stress", unit = "ksi" }
status = "status"
[formula]
x = "log(stress / 100 [ksi])"
mu = "b0 + b1 * x + b2 * x^2"
[likelihood.life]
family = "weibull"
scale = "exp(mu)"
shape = ")toml" +
         shape +
         "\"\n[prior]\nb0 = { distribution = \"flat\" }\nb1 = { distribution = \"flat\" }\nb2 = { "
         "distribution = \"flat\" "
         "}\n" +
         priors;
}

// Meeker and Escobar (1998), nickel-base super alloy with four run-outs, log stress in ksi: 217.61, -85.52, 8.483, 0.375, -93.38.
TEST_F(PublishedLives, QuadraticWeibullRegression) {
  const auto density = likelihood("tests/golden/superalloy.csv",
                                  alloy("1/sigma", "sigma = { distribution = \"flat\" }\n"));
  const Maximum found = climb(*density, {3, -7, 5, 0.5}, {1, 1, 1, 0.1});
  ASSERT_TRUE(found.converged);
  const double center = std::log(100.0);  // where the square is counted from here
  const double b2 = found.x[2], b1 = found.x[1] - 2 * center * b2;
  const double b0 = found.x[0] - center * b1 - center * center * b2;
  EXPECT_NEAR(b0, 217.611143, 2e-2);
  EXPECT_NEAR(b1, -85.522376, 1e-2);
  EXPECT_NEAR(b2, 8.482727, 1e-3);
  EXPECT_NEAR(found.x[3], 0.374740, 1e-5);
  EXPECT_NEAR(found.value, -93.381881, 2e-6);
}

// The same with a scale of log life that falls with stress.
TEST_F(PublishedLives, QuadraticWeibullRegressionWithAScaleThatDependsOnStress) {
  const auto density =
      likelihood("tests/golden/superalloy.csv",
                 alloy("exp(-(s0 + s1 * x))",
                       "s0 = { distribution = \"flat\" }\ns1 = { distribution = \"flat\" }\n"));
  const Maximum found = climb(*density, {3, -7, 5, -0.7, 0}, {1, 1, 1, 0.3, 0.3});
  ASSERT_TRUE(found.converged);
  const double expected[] = {3.635940, -7.503421, 9.665032, -0.947862, -1.175712};
  for (int i = 0; i < 5; ++i)
    EXPECT_NEAR(found.x[i], expected[i], 1e-4 * std::abs(expected[i])) << i;
  EXPECT_NEAR(found.value, -92.580896, 2e-6);
}

// The ball bearings with a threshold: the maximum within. Towards the first life the likelihood has no bound.
TEST_F(PublishedLives, WeibullWithThreshold) {
  const auto density = likelihood("examples/life/bearings.csv", R"toml(
[data.columns]
life = "million_revolutions"
[likelihood.life]
family = "weibull"
scale = "eta"
shape = "beta"
threshold = "gamma"
[prior]
eta = { distribution = "flat" }
beta = { distribution = "flat" }
gamma = { distribution = "flat" }
)toml");
  const Maximum found = climb(*density, {70, 1.8, 10}, {10, 0.2, 2}, 1e-3);
  ASSERT_TRUE(found.converged);
  EXPECT_NEAR(found.x[0], 63.880047, 2e-3);
  EXPECT_NEAR(found.x[1], 1.594299, 5e-5);
  EXPECT_NEAR(found.x[2], 14.875916, 1e-3);
  EXPECT_NEAR(found.value, -112.850189, 2e-6);
}

std::string lives(const std::string& column, const std::string& family,
                  const std::vector<std::pair<std::string, std::string>>& family_parameters) {
  std::string text = "[data.columns]\nlife = \"" + column + "\"\n[likelihood.life]\nfamily = \"" +
                     family + "\"\n",
              priors = "[prior]\n";
  for (const auto& [family_parameter, name] : family_parameters) {
    text += family_parameter + " = \"" + name + "\"\n";
    priors += name + " = { distribution = \"flat\" }\n";
  }
  return text + priors;
}

// The ball bearings, Lawless (1982), sec. 5.3: exp(4.230), 0.510, 0.308.
TEST_F(PublishedLives, GeneralizedGamma) {
  const auto density =
      likelihood("examples/life/bearings.csv",
                 lives("million_revolutions", "generalized-gamma",
                       {{"scale", "eta"}, {"sigma", "sigma"}, {"lambda", "lambda"}}));
  const Maximum found = climb(*density, {70, 0.6, 0.6}, {10, 0.1, 0.3});
  ASSERT_TRUE(found.converged);
  EXPECT_NEAR(found.x[0], 68.731340, 1e-3);
  EXPECT_NEAR(found.x[1], 0.509923, 5e-6);
  EXPECT_NEAR(found.x[2], 0.307934, 5e-5);
  EXPECT_NEAR(found.value, -112.968895, 2e-6);
}

TEST_F(PublishedLives, ExponentiatedWeibull) {
  const auto density =
      likelihood("examples/life/bearings.csv",
                 lives("million_revolutions", "exponentiated-weibull",
                       {{"scale", "eta"}, {"shape", "beta"}, {"exponent", "power"}}));
  const Maximum found = climb(*density, {40, 1.2, 3}, {10, 0.2, 1}, 1e-3);
  ASSERT_TRUE(found.converged);
  EXPECT_NEAR(found.x[0], 33.519650, 2e-2);
  EXPECT_NEAR(found.x[1], 1.043001, 5e-4);
  EXPECT_NEAR(found.x[2], 4.756926, 5e-3);
  EXPECT_NEAR(found.value, -112.975410, 2e-6);
}

// 101 aluminium coupons of Birnbaum and Saunders (1969): 131.8188 and 0.1704 (Ng, Kundu and Balakrishnan 2003).
TEST_F(PublishedLives, BirnbaumSaunders) {
  const auto density =
      likelihood("tests/golden/coupons.csv",
                 lives("kcycles", "birnbaum-saunders", {{"scale", "median"}, {"shape", "alpha"}}));
  const Maximum found = climb(*density, {120, 0.3}, {10, 0.05});
  ASSERT_TRUE(found.converged);
  EXPECT_NEAR(found.x[0], 131.818792, 1e-4);
  EXPECT_NEAR(found.x[1], 0.170385, 1e-6);
  EXPECT_NEAR(found.value, -457.270528, 2e-6);
}

// Ten bearings of McCool (1974): 212.05 h and 0.2825, an example of Ng, Kundu and Balakrishnan (2003).
TEST_F(PublishedLives, BirnbaumSaundersOfTenBearings) {
  const auto density =
      likelihood("tests/golden/bearing_hours.csv",
                 lives("hours", "birnbaum-saunders", {{"scale", "median"}, {"shape", "alpha"}}));
  const Maximum found = climb(*density, {180, 0.4}, {10, 0.05});
  ASSERT_TRUE(found.converged);
  EXPECT_NEAR(found.x[0], 212.0491, 2e-3);
  EXPECT_NEAR(found.x[1], 0.2824892, 2e-6);
  EXPECT_NEAR(found.value, -54.97175, 1e-5);
}

// Remission times of 128 patients with bladder cancer (Lee and Wang 2003): 0.654, 2.796, -410.68 in many papers.
TEST_F(PublishedLives, ExponentiatedWeibullOfRemissions) {
  const auto density =
      likelihood("tests/golden/remissions.csv",
                 lives("months", "exponentiated-weibull",
                       {{"scale", "eta"}, {"shape", "beta"}, {"exponent", "power"}}));
  const Maximum found = climb(*density, {5, 0.8, 2}, {1, 0.1, 0.5}, 1e-3);
  ASSERT_TRUE(found.converged);
  EXPECT_NEAR(found.x[0], 3.345819, 5e-3);
  EXPECT_NEAR(found.x[1], 0.6544094, 5e-4);
  EXPECT_NEAR(found.x[2], 2.796005, 5e-3);
  EXPECT_NEAR(found.value, -410.6801, 1e-4);
}

// Rats with carcinomas (Pike 1966), 17 failures and two run-outs: 108.4, 2.712 and 122 days (Lawless 1982).
TEST_F(PublishedLives, WeibullWithThresholdAndRunouts) {
  const auto density = likelihood("tests/golden/carcinoma.csv", R"toml(
[data.columns]
life = "days"
status = "status"
[likelihood.life]
family = "weibull"
scale = "eta"
shape = "beta"
threshold = "gamma"
[prior]
eta = { distribution = "flat" }
beta = { distribution = "flat" }
gamma = { distribution = "flat" }
)toml");
  const Maximum found = climb(*density, {130, 3, 100}, {10, 0.3, 5}, 1e-3);
  ASSERT_TRUE(found.converged);
  EXPECT_NEAR(found.x[0], 108.3827, 2e-2);
  EXPECT_NEAR(found.x[1], 2.711477, 5e-4);
  EXPECT_NEAR(found.x[2], 122.026, 2e-2);
  EXPECT_NEAR(found.value, -87.32425, 1e-5);
}

// 26 patients with ovarian cancer, of whom 12 died (Edmonson et al. 1979; R's survival): 6.426, 1.426, -0.766 and -96.95 (flexsurv).
TEST_F(PublishedLives, GeneralizedGammaWithRunouts) {
  const auto density = likelihood("tests/golden/ovarian.csv", R"toml(
[data.columns]
life = "days"
status = "status"
[likelihood.life]
family = "generalized-gamma"
scale = "eta"
sigma = "sigma"
lambda = "lambda"
[prior]
eta = { distribution = "flat" }
sigma = { distribution = "flat" }
lambda = { distribution = "flat" }
)toml");
  const Maximum found = climb(*density, {665, 1, -0.5}, {50, 0.1, 0.3});
  ASSERT_TRUE(found.converged);
  EXPECT_NEAR(std::log(found.x[0]), 6.427039, 1e-3);
  EXPECT_NEAR(found.x[1], 1.425840, 1e-3);
  EXPECT_NEAR(found.x[2], -0.764567, 3e-3);
  EXPECT_NEAR(found.value, -96.9490657, 2e-6);
}

// 121 patients with breast cancer (Boag 1949): a lognormal life of the share that dies of it.
TEST_F(PublishedLives, ShareThatCanFailOfLognormalLives) {
  const auto density = likelihood("tests/golden/breast_cancer.csv", R"toml(
[data.columns]
life = "months"
status = "status"
[likelihood.life]
family = "lognormal"
median = "m"
log_sd = "s"
share_defective = "p"
[prior]
m = { distribution = "flat" }
s = { distribution = "flat" }
p = { distribution = "uniform", lower = 0, upper = 1 }
)toml");
  const Maximum found = climb(*density, {35, 1, 0.8}, {5, 0.1, 0.05}, 1e-3);
  ASSERT_TRUE(found.converged);
  EXPECT_NEAR(found.x[0], 37.40952, 2e-2);
  EXPECT_NEAR(found.x[1], 1.208465, 5e-4);
  EXPECT_NEAR(found.x[2], 0.800838, 2e-4);
  EXPECT_NEAR(found.value, -430.36231, 1e-4);
}

// 99 mice that died of three causes (Hoel 1972, conventional laboratory): each cause alone by R's survreg, others as run-outs.
TEST_F(PublishedLives, CausesOfDeathOfMice) {
  const auto density = likelihood("tests/golden/mice.csv", R"toml(
[data.columns]
life = "days"
mode = "mode"
[failure_modes]
column = "mode"
[likelihood.life]
family = "weibull"
scale = "eta[mode]"
shape = "beta[mode]"
[prior]
eta = { distribution = "flat" }
beta = { distribution = "flat" }
)toml");
  const Maximum found = climb(*density, {1000, 700, 900, 1.2, 7, 2}, {50, 20, 50, 0.1, 0.3, 0.1});
  ASSERT_TRUE(found.converged);
  const double expected[] = {1361.35, 676.973, 805.6164, 1.437047, 8.073424, 1.919198};
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(found.x[i], expected[i], 1e-4 * expected[i]) << i;
  EXPECT_NEAR(found.value, -188.3732 - 239.2395 - 305.9005, 3e-4);
}

}  // namespace
}  // namespace wearwell::formula_model
