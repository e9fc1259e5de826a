// Units of a process whose mean is in proportion to what differs: against the rows themselves.
#include "wearwell/models/formula_model/formula_steps.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/scratch.h"
#include "wearwell/math/constants.h"
#include "wearwell/models/formula_model/formula_likelihood.h"
#include "wearwell/models/formula_model/formula_reader.h"

namespace wearwell::formula_model {
namespace {

class FormulaSteps : public ScratchTest {
 protected:
  // Steps that are alike (unit a) and not (unit b). Readings have errors `e` where the slots say so.
  std::shared_ptr<FormulaModel> read(const std::string& family,
                                     const std::string& family_parameters, const std::string& mean,
                                     bool lognormal) const {
    write("d.csv", "m,t,y\na,1,1.1\na,2,1.9\na,3,3.3\na,4,4.2\nb,0.5,0.8\nb,2,1.7\nb,2.7,2.1\n");
    const Source source = source_of(write(
        "study.toml", R"(
model = "formula"
[data]
file = "d.csv"
[data.columns]
y = "y"
t = "t"
m = "m"
[likelihood.y]
family = ")" + family + "\"\nmean = \"" +
                          mean + "\"\n" + family_parameters + R"(
[prior]
k = { distribution = "lognormal", median = 1, log_sd = 1 }
p = { distribution = "lognormal", median = 1, log_sd = 0.5 }
u = { distribution = "half-normal", scale = 1 }
s = { distribution = "half-normal", scale = 1 }
)" +
                          (family_parameters.find("noise") < family_parameters.size()
                               ? "e = { distribution = \"half-normal\", scale = 1 }\n"
                               : "") +
                          "[random_effects.m]\n" +
                          (lognormal ? "k = { distribution = \"lognormal\", log_sd = \"s\" }\n"
                                     : "k = { distribution = \"normal\", sd = \"s\" }\n") +
                          "[predict]\nalong = \"t\"\n"));
    return read_formula_model(TomlReader::parse(source.study), source);
  }
};

// Units far out in a wide population: searches and tails go there.
TEST_F(FormulaSteps, ExtremesAreFiniteOrNoDensity) {
  for (const std::string family : {"gamma-process", "inverse-gaussian-process", "wiener-process"}) {
    const auto model = read(family, "scale = \"u\"\n", "k*t^p", true);
    const auto columns = bind_columns(*model, model->data.table.rows);
    ASSERT_TRUE(is_proportional(*model, columns)) << family;
    const auto likelihood = formula_likelihood(std::make_shared<const FormulaRows>(model, 7));
    UnitRows rows(*model, columns);
    StepUnits steps(rows);
    for (const double k : {1e-300, 1e-150, 1e-8, 1.0, 1e8, 1e150, 1e300}) {
      for (const double u : {1e-300, 1e-100, 1e-8, 1.0, 1e8, 1e300}) {
        for (const double s : {1e-300, 0.4, 30.0, 300.0, 1e5}) {
          const std::vector<double> x = {k, 1.1, u, s};
          std::vector<double> gradient(4, 0.0);
          double value = 0;
          ASSERT_NO_THROW(value = likelihood->value_and_gradient(x, gradient))
              << family << " " << k << " " << u << " " << s;
          EXPECT_FALSE(std::isnan(value) || value == infinity)
              << family << " " << k << " " << u << " " << s;
          rows.move_to(x.data());
          steps.move();
          for (const double z : {-30.0, -8.0, -1.0, 0.0, 8.0, 30.0}) {
            const std::vector<double> at = {z, -z};
            const std::vector<std::uint8_t> all = {1, 1};
            std::vector<double> each(2), slope(2);
            ASSERT_NO_THROW(steps.evaluate(at, all, each, slope));
            for (int unit = 0; unit < 2; ++unit) {
              EXPECT_TRUE(each[unit] == -infinity ||
                          (std::isfinite(each[unit]) && std::isfinite(slope[unit])))
                  << family << " " << k << " " << u << " " << s << " " << z;
            }
          }
        }
      }
    }
  }
}

TEST_F(FormulaSteps, AreWhatTheRowsSay) {
  const std::vector<std::pair<std::string, std::string>> processes = {
      {"gamma-process", "scale = \"u\"\n"},
      {"inverse-gaussian-process", "scale = \"u\"\n"},
      {"wiener-process", "scale = \"u\"\n"},
      {"wiener-process", "sd = \"u*t^p\"\n"},
      {"wiener-process", "scale = \"u\"\nnoise = \"e\"\n"},
      {"wiener-process", "scale = \"u\"\nnoise = \"e*t\"\n"},
      {"wiener-process", "sd = \"u*t^p\"\nnoise = \"e\"\n"}};
  for (const auto& [family, family_parameters] : processes) {
    std::vector<double> x = {1.2, 1.1, 0.13, 0.4};
    if (family_parameters.find("noise") < family_parameters.size()) x.push_back(0.2);
    for (const bool lognormal : {true, false}) {
      const auto model = read(family, family_parameters, "k*t^p", lognormal);
      const auto columns = bind_columns(*model, model->data.table.rows);
      ASSERT_TRUE(is_proportional(*model, columns)) << family << family_parameters;
      UnitRows rows(*model, columns);
      rows.move_to(x.data());
      StepUnits steps(rows);
      steps.move();
      for (const double z : {-1.3, 0.0, 0.8, 2.0}) {
        const std::vector<double> at = {z, -0.4 * z};
        const std::vector<std::uint8_t> all = {1, 1};
        std::vector<double> value(2), slope(2), expected(2), expected_slope(2);
        steps.evaluate(at, all, value, slope);
        rows.evaluate(at, all, expected, expected_slope);
        for (int u = 0; u < 2; ++u) {
          EXPECT_NEAR(value[u], expected[u], 1e-10 * (1 + std::abs(expected[u])))
              << family << family_parameters << lognormal << z;
          EXPECT_NEAR(slope[u], expected_slope[u], 1e-8 * (1 + std::abs(expected_slope[u])))
              << family << family_parameters << lognormal << z;
        }
      }
      const auto likelihood = formula_likelihood(std::make_shared<const FormulaRows>(model, 7));
      std::vector<double> gradient(x.size()), expected(x.size()), moved = x;
      const double sum = likelihood->value_and_gradient(x, gradient);
      // By the rows of every node.
      rows.move_to(x.data());
      latent::UnitIntegrals whole;
      latent::integrate(rows, whole);
      for (const latent::Sweep& sweep : whole.sweeps) {
        rows.add_gradient(sweep.z, sweep.weight, expected);
      }
      EXPECT_NEAR(sum, whole.sum(), 1e-6) << family << family_parameters << lognormal;
      const FormulaRows own(model, 7);
      const latent::UnitIntegrals& nodes = own.integrate(x.data());
      EXPECT_NEAR(nodes.sum(), whole.sum(), 1e-6) << family << family_parameters << lognormal;
      for (std::size_t i = 0; i < x.size(); ++i) {
        EXPECT_NEAR(gradient[i], expected[i], 2e-6 * (1 + std::abs(expected[i])))
            << family << family_parameters << lognormal << i;
        const double h = 1e-4 * x[i];
        moved[i] = x[i] + h;
        const double above = likelihood->value(moved);
        moved[i] = x[i] - h;
        EXPECT_NEAR(gradient[i], (above - likelihood->value(moved)) / (2 * h),
                    1e-4 * (1 + std::abs(gradient[i])))
            << family << family_parameters << lognormal << i;
        moved[i] = x[i];
      }
    }
  }
}

TEST_F(FormulaSteps, AreNoneWhereTheMeanIsNotInProportion) {
  const auto model = read("wiener-process", "scale = \"u\"\n", "k^2*t^p", true);
  EXPECT_FALSE(is_proportional(*model, bind_columns(*model, model->data.table.rows)));
  const auto noise = read("wiener-process", "scale = \"u\"\nnoise = \"e*k\"\n", "k*t^p", true);
  EXPECT_FALSE(is_proportional(*noise, bind_columns(*noise, noise->data.table.rows)));
  const auto hidden = read("gamma-process", "scale = \"u\"\nnoise = \"e\"\n", "k*t^p", true);
  EXPECT_FALSE(is_proportional(*hidden, bind_columns(*hidden, hidden->data.table.rows)));
  const auto other = read("wiener-process", "sd = \"u*k*t^p\"\n", "k*t^p", true);
  EXPECT_FALSE(is_proportional(*other, bind_columns(*other, other->data.table.rows)));
}

}  // namespace
}  // namespace wearwell::formula_model
