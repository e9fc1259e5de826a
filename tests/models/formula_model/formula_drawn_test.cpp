// Effects that are drawn with the parameters: third ones of the units, and those of a second label. Against what normal laws
// of straight paths come to in closed form, and sums over a grid.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "support/golden.h"
#include "support/posterior_study.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/study/run_study.h"

namespace wearwell {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Paths y = a + b t + c t^2 of four machines.
const char* const three = R"(
model = "formula"
[data]
file = "d.csv"
[data.columns]
y = { column = "y", unit = "um" }
t = { column = "t", unit = "h" }
machine = "machine"
[likelihood.y]
family = "normal"
mean = "a + b*t + c*t^2"
sd = "sigma"
[random_effects.machine]
a = { distribution = "normal", sd = "sa" }
b = { distribution = "normal", sd = "sb" }
c = { distribution = "normal", sd = "sc" }
)";

const char* const wide = R"([prior]
a = { distribution = "normal", mean = "0 um", sd = "3 um" }
b = { distribution = "normal", mean = "0 um/h", sd = "3 um/h" }
c = { distribution = "normal", mean = "0 um/h^2", sd = "1 um/h^2" }
sigma = { distribution = "half-normal", scale = "1 um" }
sa = { distribution = "half-normal", scale = "2 um" }
sb = { distribution = "half-normal", scale = "2 um/h" }
sc = { distribution = "half-normal", scale = "1 um/h^2" }
)";

// As good as known.
const char* const narrow = R"([prior]
a = { distribution = "normal", mean = "1 um", sd = "1e-4 um" }
b = { distribution = "normal", mean = "2 um/h", sd = "1e-4 um/h" }
c = { distribution = "normal", mean = "0.5 um/h^2", sd = "1e-4 um/h^2" }
sigma = { distribution = "normal", mean = "0.4 um", sd = "1e-4 um" }
sa = { distribution = "normal", mean = "0.8 um", sd = "1e-4 um" }
sb = { distribution = "normal", mean = "0.6 um/h", sd = "1e-4 um/h" }
sc = { distribution = "normal", mean = "0.3 um/h^2", sd = "1e-4 um/h^2" }
)";

const std::vector<double> places = {0.5, 1, 1.5, 2.5, 3};
const std::vector<std::vector<double>> readings = {{2.9, 4.1, 6.0, 9.9, 12.8},
                                                   {1.6, 3.0, 3.8, 7.9, 9.1},
                                                   {2.5, 4.4, 7.2, 14.1, 18.6},
                                                   {1.1, 2.3, 2.9, 4.2, 4.9}};

MatrixXd design() {
  MatrixXd x(static_cast<Eigen::Index>(places.size()), 3);
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const double t = places[static_cast<std::size_t>(i)];
    x.row(i) << 1, t, t * t;
  }
  return x;
}

double log_normal(const VectorXd& y, const VectorXd& mean, const MatrixXd& covariance) {
  const Eigen::LLT<MatrixXd> factor(covariance);
  const VectorXd z = factor.matrixL().solve(y - mean);
  return -0.5 * z.squaredNorm() - MatrixXd(factor.matrixL()).diagonal().array().log().sum() -
         0.5 * static_cast<double>(y.size()) * std::log(2 * std::numbers::pi);
}

class FormulaDrawn : public ScratchTest {
 protected:
  void SetUp() override {
    ScratchTest::SetUp();
    std::string text = "machine,t,y\n";
    for (std::size_t u = 0; u < readings.size(); ++u) {
      for (std::size_t i = 0; i < places.size(); ++i) {
        text += fmt::format("M{},{},{}\n", u + 1, places[i], readings[u][i]);
      }
    }
    write("d.csv", text);
    std::filesystem::copy_file(PROJECT_SOURCE_DIR "/tests/golden/formula_crossed.csv",
                               folder() / "formula_crossed.csv");
  }
  std::string refusal(const std::string& text) const {
    return message_of<InputError>(
        [&] { wearwell::read_posterior_study(write("study.toml", text)).description(); });
  }
};

// In um and h: SI is another unit, by a factor that all parameters carry.
struct InSi {
  static constexpr double um = 1e-6, h = 3600;
};

// Parameters in the order of [prior], then z of c of each machine and of a new one.
std::vector<double> point() {
  constexpr double um = InSi::um, h = InSi::h;
  return {1 * um,
          2 * um / h,
          0.5 * um / h / h,
          0.4 * um,
          0.8 * um,
          0.6 * um / h,
          0.3 * um / h / h,
          0.3,
          -0.5,
          1.2,
          -1.1,
          0.7};
}

TEST_F(FormulaDrawn, TwoOfThreeEffectsAreIntegratedOutAndTheThirdIsGiven) {
  const PosteriorStudy study =
      wearwell::read_posterior_study(write("study.toml", std::string(three) + wide));
  ASSERT_EQ(study.parameters.size(), 12U);
  EXPECT_EQ(study.parameters[7].name, "c_machine_z[M1]");
  EXPECT_EQ(study.parameters[11].name, "c_machine_z[new machine]");
  const auto likelihood = study.likelihood(study.data_rows);
  const std::vector<double> x = point();
  const MatrixXd all = design();
  const MatrixXd two = all.leftCols(2);
  MatrixXd scatter = MatrixXd::Zero(2, 2);
  scatter.diagonal() << 0.8 * 0.8, 0.6 * 0.6;
  const MatrixXd covariance =
      two * scatter * two.transpose() + 0.4 * 0.4 * MatrixXd::Identity(5, 5);
  double expected = 0;
  for (std::size_t u = 0; u < 4; ++u) {
    const VectorXd y = VectorXd::Map(readings[u].data(), 5);
    const VectorXd mean = all * Eigen::Vector3d(1, 2, 0.5 + 0.3 * x[7 + u]);
    expected += log_normal(y, mean, covariance) - 5 * std::log(InSi::um);
  }
  EXPECT_NEAR(likelihood->value(x), expected, 1e-8);
  std::vector<double> gradient(x.size());
  EXPECT_NEAR(likelihood->value_and_gradient(x, gradient), expected, 1e-8);
  for (std::size_t i = 0; i < x.size(); ++i) {
    std::vector<double> low = x, high = x;
    const double step = 1e-5 * std::abs(x[i]);
    low[i] -= step;
    high[i] += step;
    const double slope = (likelihood->value(high) - likelihood->value(low)) / (2 * step);
    EXPECT_NEAR(gradient[i] / std::max(1e-6 / std::abs(x[i]), std::abs(slope)),
                slope / std::max(1e-6 / std::abs(x[i]), std::abs(slope)), 2e-5)
        << study.parameters[i].name;
  }
}

// A unit that is left out has no effects of its own any more.
TEST_F(FormulaDrawn, ALeftOutUnitIsJudgedByItsPopulationAlone) {
  const PosteriorStudy study =
      wearwell::read_posterior_study(write("study.toml", std::string(three) + wide));
  const std::vector<double> each = study.likelihood(study.data_rows)->pointwise(point());
  ASSERT_EQ(each.size(), 4U);
  MatrixXd scatter = MatrixXd::Zero(3, 3);
  scatter.diagonal() << 0.8 * 0.8, 0.6 * 0.6, 0.3 * 0.3;
  const MatrixXd covariance =
      design() * scatter * design().transpose() + 0.4 * 0.4 * MatrixXd::Identity(5, 5);
  for (std::size_t u = 0; u < 4; ++u) {
    const VectorXd y = VectorXd::Map(readings[u].data(), 5);
    const VectorXd mean = design() * Eigen::Vector3d(1, 2, 0.5);
    EXPECT_NEAR(each[u], log_normal(y, mean, covariance) - 5 * std::log(InSi::um), 2e-6);
  }
}

// Of a population that is as good as known a unit's path is normal, given its readings.
TEST_F(FormulaDrawn, PathsOfUnitsAreTheirConjugateOnes) {
  const std::string predict =
      "[predict]\nalong = \"t\"\nat = \"5 h\"\nlimit = { path = \"40 um\" }\n";
  std::string text = std::string(three) + narrow + predict;
  text.replace(text.find("[likelihood.y]"), 0, "[formula]\npath = \"a + b*t + c*t^2\"\n");
  const PosteriorSummary result =
      run_study(wearwell::read_posterior_study(write("study.toml", text)),
                {Method::nuts, 4, 500, 4000, 1}, {}, false);
  MatrixXd scatter = MatrixXd::Zero(3, 3);
  scatter.diagonal() << 0.8 * 0.8, 0.6 * 0.6, 0.3 * 0.3;
  const Eigen::RowVector3d there(1, 5, 25);
  std::size_t seen = 0;
  for (const QuantitySummary& each : result.quantities) {
    if (each.name != "y") continue;
    MatrixXd covariance = scatter;
    VectorXd mean = Eigen::Vector3d(1, 2, 0.5);
    if (each.of != "new machine") {
      const std::size_t u = static_cast<std::size_t>(each.of.back() - '1');
      const VectorXd y = VectorXd::Map(readings[u].data(), 5);
      const MatrixXd precision = scatter.inverse() + design().transpose() * design() / (0.4 * 0.4);
      covariance = precision.inverse();
      mean = covariance * (scatter.inverse() * mean + design().transpose() * y / (0.4 * 0.4));
    }
    const double middle = there * mean, sd = std::sqrt((there * covariance * there.transpose())(0));
    // Over 500 of the draws that are read as points.
    EXPECT_NEAR(each.best().q50, middle, 0.25 * sd) << each.of;
    EXPECT_NEAR((each.best().q95 - each.best().q05) / (2 * 1.6448536), sd, 0.15 * sd) << each.of;
    ++seen;
  }
  EXPECT_EQ(seen, 5U);
}

const char* const crossed = R"toml(
model = "formula"
[data]
file = "formula_crossed.csv"
rows_of = "machine"
[data.columns]
h = { column = "h", unit = "um" }
F = { column = "F", unit = "N" }
s = { column = "s", unit = "km" }
machine = "machine"
operator = "operator"
[likelihood.h]
family = "normal"
mean = "k * F * s / 50 [mm^2]"
sd = "sigma"
[random_effects.machine]
k = { distribution = "lognormal", log_sd = "k_scatter" }
[random_effects.operator]
k = { distribution = "lognormal", log_sd = "o_scatter" }
[prior]
k = { distribution = "lognormal", median = "1e-6 mm^3/(N m)", log_sd = 2 }
sigma = { distribution = "half-normal", scale = "5 um" }
k_scatter = { distribution = "half-normal", scale = 1 }
o_scatter = { distribution = "half-normal", scale = 0.5 }
)toml";

// Every machine by a sum over 4,000 places of its own effect.
TEST_F(FormulaDrawn, TwoLabelsThatCrossAreASumOverAGrid) {
  const PosteriorStudy study = wearwell::read_posterior_study(write("study.toml", crossed));
  ASSERT_EQ(study.parameters.size(), 4U + 7U);
  std::vector<double> x = {1.1e-15, 0.6e-6, 0.35, 0.2, 0.5, -0.8, 1.4, 0.1, -0.3, 0.9, 2};
  double log_product = 0;
  const auto rows = read_golden("formula_crossed.csv");
  const std::vector<std::string> operators = {"Ada", "Cleo", "Eva", "Ben", "Dirk", "Finn"};
  for (std::size_t u = 1; u <= 8; ++u) {
    double sum = 0;
    constexpr double step = 0.004;
    for (int i = -2000; i <= 2000; ++i) {
      const double z = i * step;
      double log_f = -0.5 * z * z - 0.5 * std::log(2 * std::numbers::pi);
      for (const auto& row : rows) {
        if (row[0] != std::to_string(u)) continue;
        const auto at = std::find(operators.begin(), operators.end(), row[1]) - operators.begin();
        const double k = x[0] * std::exp(0.35 * z + 0.2 * x[4 + static_cast<std::size_t>(at)]);
        const double mean = k * std::stod(row[2]) * std::stod(row[3]) * 1000 / 50e-6;
        const double d = (std::stod(row[4]) * 1e-6 - mean) / 0.6e-6;
        log_f += -0.5 * d * d - std::log(0.6e-6) - 0.5 * std::log(2 * std::numbers::pi);
      }
      sum += step * std::exp(log_f - 60);
    }
    log_product += std::log(sum) + 60;
  }
  EXPECT_NEAR(study.likelihood(study.data_rows)->value(x), log_product, 1e-7);
}

TEST_F(FormulaDrawn, RefusalsNameThePlace) {
  const auto without = [](std::string text, const std::string& what, const std::string& by = "") {
    return text.replace(text.find(what), what.size(), by);
  };
  const std::string open = refusal(without(crossed, "rows_of = \"machine\"\n"));
  EXPECT_NE(open.find("random_effects.operator"), std::string::npos) << open;
  EXPECT_NE(
      open.find("identifies the units, machine or operator? No label is nested in the others. "
                "Add rows_of = \"machine\" under [data]"),
      std::string::npos)
      << open;
  const std::string wrong = refusal(without(crossed, "rows_of = \"machine\"", "rows_of = \"F\""));
  EXPECT_NE(wrong.find("data.rows_of"), std::string::npos) << wrong;
  EXPECT_NE(wrong.find("(machine, operator)"), std::string::npos) << wrong;
  const std::string both =
      refusal(without(crossed, "\"k * F", "\"k * m[operator] * F") +
              "m = { distribution = \"lognormal\", median = 1, log_sd = 1 }\n");
  EXPECT_NE(both.find("prior.m"), std::string::npos) << both;
  const std::string unknown =
      refusal(without(crossed, "[random_effects.operator]\nk =", "[random_effects.operator]\nq ="));
  EXPECT_NE(unknown.find("random_effects.operator.q"), std::string::npos) << unknown;
  const std::string unit =
      refusal(without(crossed, "log_sd = \"o_scatter\"", "log_sd = \"sigma\""));
  EXPECT_NE(unit.find("random_effects.operator.k.log_sd"), std::string::npos) << unit;
}

}  // namespace
}  // namespace wearwell
