// The likelihood of a law in the user's own words.
#include "wearwell/models/formula_model/formula_likelihood.h"

#include <gmock/gmock.h>

#include <cmath>

#include "support/scratch.h"
#include "wearwell/models/formula_model/formula_reader.h"

namespace wearwell::formula_model {
namespace {

class FormulaLikelihoodTest : public ScratchTest {
 protected:
  std::shared_ptr<const LogDensity> likelihood(const std::string& mean,
                                               const std::string& random_effects) const {
    return formula_likelihood(rows(mean, random_effects));
  }

  std::shared_ptr<const FormulaRows> rows(const std::string& mean,
                                          const std::string& random_effects) const {
    write(
        "d.csv",
        "m,t,y\na,1,1.2\na,2,2.6\na,3,3.4\nb,1,0.7\nb,2,1.1\nc,1,2.1\nc,2,4.4\nc,3,6.0\nc,4,8.8\n");
    const auto file = write("study.toml", R"(
model = "formula"
[data]
file = "d.csv"
[data.columns]
y = { column = "y", unit = "um" }
t = { column = "t", unit = "h" }
m = "m"
[likelihood.y]
family = "normal"
mean = ")" + mean + R"("
sd = "sigma"
[prior]
a = { distribution = "flat", unit = "um" }
b = { distribution = "flat", unit = "um/h" }
sigma = { distribution = "flat", unit = "um" }
s = { distribution = "flat" }
r = { distribution = "flat", unit = "um" }
rho = { distribution = "flat" }
[random_effects.m]
)" + random_effects);
    const Source source = source_of(file);
    const TomlReader root = TomlReader::parse(source.study);
    return std::make_shared<const FormulaRows>(read_formula_model(root, source), 9);
  }
};

constexpr double um = 1e-6, h = 3600;

// Values of their own beside intervals, run-outs and what failed before it was looked at: empty cells of the
// value's column are no rows without an observation.
class ObservedLives : public ScratchTest {
 protected:
  std::shared_ptr<const FormulaModel> model(const std::string& rows) const {
    write("lives.csv", "bearing,life,lower,upper\n" + rows);
    const auto file = write("study.toml", R"(
model = "formula"
[data]
file = "lives.csv"
[data.columns]
life = { column = "life", unit = "h" }
lower = { column = "lower", unit = "h" }
upper = { column = "upper", unit = "h" }
[likelihood.life]
family = "lognormal"
median = "m"
log_sd = "s"
[prior]
m = { distribution = "flat", unit = "h" }
s = { distribution = "flat" }
)");
    const Source source = source_of(file);
    return read_formula_model(TomlReader::parse(source.study), source);
  }
};

TEST_F(ObservedLives, CountWhetherTheyAreExactOrNot) {
  const Observed seen =
      model("1,100,,\n2,,50,150\n3,,200,\n4,,,80\n5,90,,\n")->measured.front().observed;
  ASSERT_EQ(seen.responses.size(), 5u);
  const Censoring expected[] = {Censoring::none, Censoring::interval, Censoring::right,
                                Censoring::left, Censoring::none};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(seen.responses[i].seen, expected[i]) << i;
  EXPECT_DOUBLE_EQ(seen.responses[1].until, 150 * h);
  EXPECT_EQ(seen.failures, 4u);
}

TEST_F(ObservedLives, AreRefusedWhereARowSaysNothing) {
  EXPECT_THROW(model("1,100,,\n2,,,\n3,90,,\n"), InputError);
  // From 0 on, a life says nothing.
  EXPECT_THAT(message_of<InputError>([&] { model("1,100,,\n2,,0,\n3,90,,\n"); }),
              testing::AllOf(testing::HasSubstr("row 2, column 'lower'"),
                             testing::HasSubstr("contains every possible value")));
}

// A midpoint beside its interval would be read as exact.
TEST_F(ObservedLives, AreRefusedWhereARowSaysTwoThings) {
  for (const char* row : {"2,100,50,150\n", "2,100,50,\n", "2,100,100,150\n"})
    EXPECT_THAT(message_of<InputError>([&] { model(std::string("1,90,,\n") + row + "3,90,,\n"); }),
                testing::AllOf(testing::HasSubstr("row 2, column"),
                               testing::HasSubstr("empty if there is a measured value")))
        << row;
  EXPECT_EQ(model("1,90,90,90\n2,100,,\n")->measured.front().observed.failures, 2u);
}

void expect_gradient(const LogDensity& density, std::vector<double> x) {
  std::vector<double> gradient(x.size());
  const double value = density.value_and_gradient(x, gradient);
  EXPECT_NEAR(value, density.value(x), 1e-8 * std::abs(value));
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double at = x[i], step = 1e-5 * std::abs(at);
    x[i] = at + step;
    const double above = density.value(x);
    x[i] = at - step;
    const double slope = (above - density.value(x)) / (2 * step);
    x[i] = at;
    EXPECT_NEAR(gradient[i], slope, 1e-5 * std::abs(slope) + 1e-6 / std::abs(at)) << i;
  }
}

// One lognormal effect: as a parabola, and where a case that is never met hides that, row by row.
TEST_F(FormulaLikelihoodTest, AParabolaIsTheSameAsRowByRow) {
  const std::string effect =
      "b = { distribution = \"lognormal\", log_sd = \"s + 0*rho + 0*r/a\" }\n";
  const auto parabola = likelihood("a + b * t", effect);
  const auto by_rows = likelihood("where(t > 0, a + b * t, a)", effect);
  for (const double scatter : {0.05, 0.6, 2.5}) {
    const std::vector<double> x = {0.3 * um, 1.4 * um / h, 0.2 * um, scatter, 1 * um, 0.1};
    EXPECT_NEAR(parabola->value(x), by_rows->value(x), 1e-7);
    expect_gradient(*parabola, x);
    expect_gradient(*by_rows, x);
  }
}

// The mean and the square of each unit's effect under its own posterior, by the nodes.
std::vector<double> moments(const FormulaRows& rows, const std::vector<double>& x) {
  std::vector<double> result;
  const latent::UnitIntegrals& integrals = rows.integrate(x.data());
  for (std::size_t u = 0; u < 3; ++u) {
    double all = 0, first = 0, second = 0;
    for (const latent::Sweep& sweep : integrals.sweeps) {
      all += sweep.weight[u];
      first += sweep.weight[u] * sweep.z[u];
      second += sweep.weight[u] * sweep.z[u] * sweep.z[u];
    }
    EXPECT_NEAR(all, 1, 1e-9);
    result.insert(result.end(), {integrals.log_likelihood[u], first, second});
  }
  return result;
}

// Units one by one, and what is known of each one's effect, without a look at rows for each node.
TEST_F(FormulaLikelihoodTest, UnitsAsParabolasHaveTheNodesOfRowByRow) {
  const std::string lognormal =
      "b = { distribution = \"lognormal\", log_sd = \"s + 0*rho + 0*r/a\" }\n";
  const std::string normal =
      "b = { distribution = \"normal\", sd = \"s*b + 0*rho*b + 0*r/a*b\" }\n";
  for (const std::string& effect : {lognormal, normal}) {
    const auto parabola = rows("a + b * t", effect);
    const auto by_rows = rows("where(t > 0, a + b * t, a)", effect);
    const auto density = formula_likelihood(parabola);
    // The last: an effect that the readings hardly know, then one that they know to 1e-4.
    for (const auto& [scatter, sigma] :
         {std::pair(0.05, 0.2), {0.6, 0.2}, {2.5, 0.2}, {1.0, 50.0}, {0.3, 1e-3}}) {
      const std::vector<double> x = {0.3 * um, 1.4 * um / h, sigma * um, scatter, 1 * um, 0.1};
      const std::vector<double> one = moments(*parabola, x), other = moments(*by_rows, x);
      const std::vector<double> each = density->pointwise(x);
      double sum = 0;
      for (std::size_t i = 0; i < one.size(); ++i) {
        EXPECT_NEAR(one[i], other[i], 1e-6 * (1 + std::abs(other[i]))) << i << " " << scatter;
      }
      for (std::size_t u = 0; u < each.size(); ++u) {
        sum += each[u];
        EXPECT_NEAR(each[u], one[3 * u], 1e-7 * (1 + std::abs(each[u])));
      }
      EXPECT_NEAR(sum, density->value(x), 1e-9 * (1 + std::abs(sum)));
    }
  }
}

// A path that jumps where the effect does: its integral is known to the width of a step only, and that is said.
TEST_F(FormulaLikelihoodTest, AnIntegralThatDoesNotSettleIsSaid) {
  const std::string effect =
      "b = { distribution = \"lognormal\", log_sd = \"s + 0*rho + 0*r/a\" }\n";
  const std::vector<double> x = {0.3 * um, 1.4 * um / h, 0.8 * um, 0.6, 1 * um, 0.1};
  EXPECT_EQ(likelihood("a + b * t", effect)->unsettled(x), 0);
  EXPECT_EQ(likelihood("where(t > 0, a + b * t, a)", effect)->unsettled(x), 0);
  const double open =
      likelihood("where(b > 1.5 [um/h], a + b * t, 2 * a + b * t)", effect)->unsettled(x);
  EXPECT_GT(open, 1e-6);
  EXPECT_LT(open, 0.5);
}

// Normal effects: the rows of a unit are jointly normal (dense covariance, by hand).
TEST_F(FormulaLikelihoodTest, TwoCorrelatedEffectsAreAJointNormalLaw) {
  const auto density = likelihood("a + b * t",
                                  "a = { distribution = \"normal\", sd = \"r\" }\n"
                                  "b = { distribution = \"normal\", sd = \"s * b\" }\n"
                                  "correlation = \"rho\"\n");
  const double a = 0.3, b = 1.4, sigma = 0.2, s = 0.5, r = 0.4, rho = -0.6;
  const std::vector<std::vector<double>> units = {
      {1.2, 2.6, 3.4}, {0.7, 1.1}, {2.1, 4.4, 6.0, 8.8}};
  double expected = 0;
  for (const auto& y : units) {
    const auto n = static_cast<Eigen::Index>(y.size());
    Eigen::MatrixXd z(n, 2);
    Eigen::VectorXd off(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      z(i, 0) = 1;
      z(i, 1) = static_cast<double>(i + 1);
      off[i] = y[static_cast<std::size_t>(i)] - a - b * z(i, 1);
    }
    Eigen::Matrix2d population;
    population << r * r, rho * r * s * b, rho * r * s * b, s * b * s * b;
    const Eigen::MatrixXd covariance =
        sigma * sigma * Eigen::MatrixXd::Identity(n, n) + z * population * z.transpose();
    expected -= 0.5 * (static_cast<double>(n) * std::log(2 * M_PI) +
                       std::log(covariance.determinant()) + off.dot(covariance.ldlt().solve(off)));
    expected -= static_cast<double>(n) * std::log(um);
  }
  const std::vector<double> x = {a * um, b * um / h, sigma * um, s, r * um, rho};
  EXPECT_NEAR(density->value(x), expected, 1e-6);
  expect_gradient(*density, x);
}

}  // namespace
}  // namespace wearwell::formula_model
