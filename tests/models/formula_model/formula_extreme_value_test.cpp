// Lives of units with a random effect on their log scale: against the rows themselves and against R.
#include "wearwell/models/formula_model/formula_extreme_value.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "support/scratch.h"
#include "wearwell/models/formula_model/formula_likelihood.h"
#include "wearwell/models/formula_model/formula_reader.h"

namespace wearwell::formula_model {
namespace {

constexpr const char* priors = R"(
[prior]
middle = { distribution = "lognormal", median = 100, log_sd = 1 }
slope = { distribution = "lognormal", median = 1.5, log_sd = 0.5 }
b = { distribution = "normal", mean = 0, sd = 1 }
s = { distribution = "half-normal", scale = 1 }
)";
constexpr const char* weighted =
    "status = { column = \"state\", failure = \"failed\" }\nentry = \"since\"\ncount = \"n\"\n";
constexpr const char* lives =
    "id,life,state,x,since,n\n1,80,failed,0.2,0,1\n1,140,running,1.1,20,2\n1,60,failed,0.7,50,1\n"
    "2,200,failed,0.1,0,1\n2,90,failed,0.4,0,3\n3,310,running,1.5,100,1\n3,150,running,0,0,4\n"
    "4,12,failed,0.9,3,1\n4,25,failed,0.3,0,1\n4,70,failed,0.5,0,1\n";

class FormulaExtremeValue : public ScratchTest {
 protected:
  std::shared_ptr<FormulaModel> read(const std::string& likelihood,
                                     const std::string& effect = "lognormal",
                                     const std::string& table = lives,
                                     const std::string& columns = weighted,
                                     std::string prior = priors) const {
    if (likelihood.find("slope") == std::string::npos) {
      prior.erase(prior.find("slope ="), prior.find("b =") - prior.find("slope ="));
    }
    write("d.csv", table);
    const Source source = source_of(write(
        "study.toml",
        "model = \"formula\"\n[data]\nfile = \"d.csv\"\n[data.columns]\nlife = \"life\"\n"
        "x = \"x\"\nid = \"id\"\n" +
            columns + "[likelihood.life]\n" + likelihood + prior + "[random_effects.id]\n" +
            (effect == "lognormal" ? "middle = { distribution = \"lognormal\", log_sd = \"s\" }\n"
                                   : "middle = { distribution = \"normal\", sd = \"s\" }\n")));
    return read_formula_model(TomlReader::parse(source.study), source);
  }

  static bool collapses(const FormulaModel& model) {
    return has_extreme_values(model, bind_columns(model, model.data.table.rows));
  }

  // By the rows alone: the general integral and the means of its gradients.
  static double by_rows(const FormulaModel& model, const std::vector<double>& x,
                        std::vector<double>& each, std::vector<double>& gradient) {
    const auto columns = bind_columns(model, model.data.table.rows);
    UnitRows rows(model, columns);
    rows.move_to(x.data());
    latent::UnitIntegrals integrals;
    latent::integrate(rows, integrals);
    EXPECT_TRUE(integrals.settled);
    each = integrals.log_likelihood;
    gradient.assign(x.size(), 0.0);
    for (const latent::Sweep& sweep : integrals.sweeps)
      rows.add_gradient(sweep.z, sweep.weight, gradient);
    return integrals.sum();
  }

  static void expect_as_rows(const std::shared_ptr<FormulaModel>& model,
                             const std::vector<std::vector<double>>& points) {
    ASSERT_TRUE(collapses(*model));
    const auto rows = std::make_shared<const FormulaRows>(model, model->data.table.rows);
    const auto likelihood = formula_likelihood(rows);
    for (const std::vector<double>& x : points) {
      ASSERT_EQ(x.size(), model->parameters.size());
      std::vector<double> each, expected, gradient(x.size());
      const double value = by_rows(*model, x, each, expected);
      ASSERT_TRUE(std::isfinite(value));
      EXPECT_NEAR(likelihood->value(x), value, 1e-9 * (1 + std::abs(value)));
      EXPECT_NEAR(likelihood->value_and_gradient(x, gradient), value, 1e-9 * (1 + std::abs(value)));
      for (std::size_t i = 0; i < x.size(); ++i) {
        EXPECT_NEAR(gradient[i], expected[i], 1e-7 * (1 + std::abs(expected[i])))
            << model->parameters[i].name;
      }
      const std::vector<double> own = likelihood->pointwise(x);
      ASSERT_EQ(own.size(), each.size());
      for (std::size_t u = 0; u < each.size(); ++u)
        EXPECT_NEAR(own[u], each[u], 1e-9 * (1 + std::abs(each[u])));
      const latent::UnitIntegrals& nodes = rows->integrate(x.data());
      EXPECT_NEAR(nodes.sum(), value, 1e-9 * (1 + std::abs(value)));
      for (std::size_t u = 0; u < each.size(); ++u) {
        double all = 0;
        for (const latent::Sweep& sweep : nodes.sweeps) all += sweep.weight[u];
        EXPECT_NEAR(all, 1, 1e-9);
      }
    }
  }
};

const std::vector<std::vector<double>> four = {
    {110, 1.3, 0.4, 0.5}, {40, 0.7, -0.6, 1.6}, {300, 3.5, 0.1, 0.03}, {150, 2, 0, 2.5}};

TEST_F(FormulaExtremeValue, WeibullLivesAreThoseOfTheRows) {
  expect_as_rows(read("family = \"weibull\"\nscale = \"middle*exp(b*x)\"\nshape = \"slope\"\n"),
                 four);
}

// The effect to a power that depends on a parameter, as a frailty that multiplies hazards has it.
TEST_F(FormulaExtremeValue, AnyPowerOfTheEffect) {
  expect_as_rows(
      read("family = \"weibull\"\nscale = \"50*exp(b*x)*middle^(-1/slope)\"\nshape = \"slope\"\n"),
      {{1.3, 1.3, 0.4, 0.5}, {0.2, 0.7, -0.6, 1.6}, {2, 3.5, 0.1, 0.03}});
}

TEST_F(FormulaExtremeValue, ExponentialLives) {
  expect_as_rows(read("family = \"exponential\"\nmean = \"middle*exp(b*x)\"\n"),
                 {{110, 0.4, 0.5}, {40, -0.6, 1.6}, {300, 0.1, 0.03}});
}

TEST_F(FormulaExtremeValue, NormalEffects) {
  std::string near = priors;
  near.replace(near.find("median = 100"), 12, "median = 4");
  expect_as_rows(read("family = \"smallest-extreme-value\"\nlocation = \"middle + 30*b*x\"\nscale "
                      "= \"40*slope\"\n",
                      "normal"),
                 {{110, 1.3, 0.4, 25}, {40, 0.7, -0.6, 80}, {200, 3.5, 0.1, 1}});
  expect_as_rows(read("family = \"weibull\"\nscale = \"exp(middle + b*x)\"\nshape = \"slope\"\n",
                      "normal", lives, weighted, near),
                 {{4.6, 1.3, 0.4, 0.5}, {4, 0.7, -0.6, 1.6}});
}

// The mirror image collapses for exact and left-censored rows.
TEST_F(FormulaExtremeValue, LargestExtremeValues) {
  const char* table =
      "id,life,x\n1,80,0.2\n1,<140,1.1\n2,200,0.1\n2,90,0.4\n3,<310,1.5\n4,12,0.9\n4,25,0.3\n";
  expect_as_rows(read("family = \"frechet\"\nscale = \"middle*exp(b*x)\"\nshape = \"slope\"\n",
                      "lognormal", table, ""),
                 four);
  expect_as_rows(read("family = \"largest-extreme-value\"\nlocation = \"middle + 30*b*x\"\nscale = "
                      "\"40*slope\"\n",
                      "normal", table, ""),
                 {{110, 1.3, 0.4, 25}, {40, 0.7, -0.6, 80}});
}

// What does not collapse stays with the rows.
TEST_F(FormulaExtremeValue, OthersAreLeftToTheRows) {
  const std::string weibull = "family = \"weibull\"\n";
  EXPECT_FALSE(collapses(*read(weibull + "scale = \"100*exp(b*x)\"\nshape = \"slope*middle\"\n")));
  EXPECT_FALSE(collapses(*read(weibull + "scale = \"middle + b*x + 3\"\nshape = \"slope\"\n")));
  EXPECT_FALSE(
      collapses(*read(weibull + "scale = \"middle*exp(b*x)\"\nshape = \"slope\"\n", "normal")));
  EXPECT_FALSE(
      collapses(*read("family = \"lognormal\"\nmedian = \"middle\"\nlog_sd = \"slope+b^2\"\n")));
  const char* left = "id,life,x\n1,80,0.2\n1,<140,1.1\n2,200,0.1\n";
  EXPECT_FALSE(collapses(
      *read(weibull + "scale = \"middle*exp(b*x)\"\nshape = \"slope\"\n", "lognormal", left, "")));
}

// Rows of one unit whose shapes differ: found at the parameters, and integrated row by row.
TEST_F(FormulaExtremeValue, RowsWithDifferentShapesAreLeftToTheRows) {
  const auto model = read("family = \"weibull\"\nscale = \"middle\"\nshape = \"slope*exp(b*x)\"\n");
  const auto likelihood =
      formula_likelihood(std::make_shared<const FormulaRows>(model, model->data.table.rows));
  for (const std::vector<double>& x : four) {
    std::vector<double> each, expected, gradient(4);
    const double value = by_rows(*model, x, each, expected);
    EXPECT_NEAR(likelihood->value_and_gradient(x, gradient), value, 1e-9 * std::abs(value));
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_NEAR(gradient[i], expected[i], 1e-7 * (1 + std::abs(expected[i])));
  }
}

// Far from all that is sensible: a number or no density, and no exception.
TEST_F(FormulaExtremeValue, ExtremesAreFiniteOrNoDensity) {
  const auto model = read("family = \"weibull\"\nscale = \"middle*exp(b*x)\"\nshape = \"slope\"\n");
  const auto likelihood =
      formula_likelihood(std::make_shared<const FormulaRows>(model, model->data.table.rows));
  for (const double middle : {1e-100, 1e-20, 100.0, 1e20, 1e100}) {
    for (const double slope : {1e-8, 0.3, 40.0, 1e6}) {
      for (const double s : {0.0, 1e-12, 0.5, 40.0, 1e5}) {
        std::vector<double> gradient(4);
        const std::vector<double> x = {middle, slope, 0.5, s};
        const double value = likelihood->value_and_gradient(x, gradient);
        EXPECT_FALSE(std::isnan(value) || value == INFINITY) << middle << " " << slope << " " << s;
        for (const double each : gradient)
          EXPECT_TRUE(value == -INFINITY || std::isfinite(each))
              << middle << " " << slope << " " << s;
      }
    }
  }
}

// Infections of kidney patients against base R (tests/golden/kidney.R).
TEST_F(FormulaExtremeValue, KidneyPatientsAreThoseOfR) {
  std::ifstream file(PROJECT_SOURCE_DIR "/tests/golden/kidney.csv");
  std::stringstream table;
  table << file.rdbuf();
  write("d.csv", table.str());
  const Source source = source_of(write("study.toml", R"toml(
model = "formula"
[data]
file = "d.csv"
[data.columns]
life = "time"
status = { column = "status", failure = 1 }
sex = "sex"
id = "id"
[likelihood.life]
family = "weibull"
scale = "characteristic * exp(b_sex * (sex - 1.74))"
shape = "slope"
[prior]
characteristic = { distribution = "lognormal", median = 1000, log_sd = 2 }
slope = { distribution = "lognormal", median = 1.5, log_sd = 0.7 }
b_sex = { distribution = "normal", mean = 0, sd = 3 }
characteristic_scatter = { distribution = "half-normal", scale = 1 }
[random_effects.id]
characteristic = { distribution = "lognormal", log_sd = "characteristic_scatter" }
)toml"));
  const std::shared_ptr<FormulaModel> model =
      read_formula_model(TomlReader::parse(source.study), source);
  ASSERT_TRUE(collapses(*model));
  const auto likelihood =
      formula_likelihood(std::make_shared<const FormulaRows>(model, model->data.table.rows));
  std::ifstream expected(PROJECT_SOURCE_DIR "/tests/golden/kidney_expected.csv");
  std::string line;
  std::getline(expected, line);
  int points = 0;
  for (; std::getline(expected, line); ++points) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream cells(line);
    std::vector<double> x(4);
    double value = 0;
    for (double& each : x) cells >> each;
    cells >> value;
    ASSERT_FALSE(cells.fail());
    EXPECT_NEAR(likelihood->value(x), value, 1e-8) << line;
  }
  EXPECT_EQ(points, 6);
}

}  // namespace
}  // namespace wearwell::formula_model
