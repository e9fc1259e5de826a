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

}  // namespace
}  // namespace wearwell::formula_model
