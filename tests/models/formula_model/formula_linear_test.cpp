// Units whose log likelihoods are quadratic in what differs: against the rows themselves.
#include "wearwell/models/formula_model/formula_linear.h"
#include "wearwell/models/formula_model/linear_form.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "support/scratch.h"
#include "wearwell/math/constants.h"
#include "wearwell/models/formula_model/formula_likelihood.h"
#include "wearwell/models/formula_model/formula_reader.h"

namespace wearwell::formula_model {
namespace {

constexpr double errors[] = {0.3, -0.7, 1.1, 0.2, -1.4, 0.6, -0.1, 0.9};

class FormulaLinear : public ScratchTest {
 protected:
  // Parts that wear in and then steadily, under forces on both sides of 20.
  std::shared_ptr<FormulaModel> read(const std::string& mean, const std::string& priors,
                                     const std::string& random_effects) const {
    std::string text = "part,F,s,y\n";
    int k = 0;
    for (const double pace : {0.8, 1.0, 1.4}) {
      for (const double s : {0.3, 1.0, 2.5, 6.0, 12.0}) {
        const double F = 12 + 7 * (k % 5);
        const double y = 3 * pace * (1 - std::exp(-s)) + 0.02 / pace * F * s;
        text += fmt::format("p{},{},{},{:.4f}\n", pace, F, s, y + 0.3 * errors[k++ % 8]);
      }
    }
    write("d.csv", text);
    const Source source = source_of(write("study.toml", R"(
model = "formula"
[data]
file = "d.csv"
[data.columns]
y = "y"
F = "F"
s = "s"
part = "part"
[likelihood.y]
family = "normal"
sd = "sigma"
mean = ")" + mean + R"("
[prior]
)" + priors + "[random_effects.part]\n" + random_effects + "[predict]\nalong = \"s\"\n"));
    return read_formula_model(TomlReader::parse(source.study), source);
  }

  // Each unit's log integral over all effects, and the sum's gradient: rows at every node of a fine product rule.
  static std::vector<double> by_product_rule(const FormulaModel& model, UnitRows& rows,
                                             std::span<double> gradient) {
    constexpr double step = 0.05, far = 8;
    constexpr int most = static_cast<int>(far / step);
    const std::size_t units = model.units.size(), d = model.effects.size();
    const std::vector<std::uint8_t> all(units, 1);
    std::vector<double> z(units * d), value(units), log_sum(units, -INFINITY), weight(units);
    for (const bool sloped : {false, true}) {
      std::vector<double> sums(units), highest(units, -INFINITY);
      for (int i = -most; i <= most; ++i) {
        for (int j = d > 1 ? -most : 0; j <= (d > 1 ? most : 0); ++j) {
          double log_prior = 0;
          for (std::size_t u = 0; u < units; ++u) {
            z[u * d] = i * step;
            if (d > 1) z[u * d + 1] = j * step;
          }
          for (std::size_t e = 0; e < d; ++e)
            log_prior += std::log(step) - 0.5 * z[e] * z[e] - half_log_two_pi;
          rows.evaluate(z, all, value, {});
          bool any = false;
          for (std::size_t u = 0; u < units; ++u) {
            const double f = value[u] + log_prior;
            weight[u] = sloped && f > log_sum[u] - 30 ? std::exp(f - log_sum[u]) : 0;
            any |= weight[u] > 0;
            if (sloped || !(f > -INFINITY)) continue;
            if (f > highest[u]) {
              sums[u] *= std::exp(highest[u] - f);
              highest[u] = f;
            }
            sums[u] += std::exp(f - highest[u]);
          }
          if (any) rows.add_gradient(z, weight, gradient);
        }
      }
      for (std::size_t u = 0; u < units && !sloped; ++u)
        log_sum[u] = highest[u] + std::log(sums[u]);
    }
    return log_sum;
  }

  // By sums and by the rows, values, gradients and units' own.
  static void expect_alike(const std::shared_ptr<FormulaModel>& model,
                           const std::vector<double>& x) {
    const auto columns = bind_columns(*model, model->data.table.rows);
    ASSERT_TRUE(is_linear(*model, columns));
    const auto quick =
        formula_likelihood(std::make_shared<const FormulaRows>(model, model->data.table.rows));
    UnitRows rows(*model, columns);
    rows.move_to(x.data());
    std::vector<double> gradient(x.size()), expected(x.size());
    const std::vector<double> log_likelihood = by_product_rule(*model, rows, expected);
    const double sum = std::accumulate(log_likelihood.begin(), log_likelihood.end(), 0.0);
    EXPECT_NEAR(quick->value(x), sum, 1e-6);
    EXPECT_NEAR(quick->value_and_gradient(x, gradient), sum, 1e-6);
    for (std::size_t i = 0; i < x.size(); ++i) {
      EXPECT_NEAR(gradient[i], expected[i], 1e-6 * (1 + std::abs(expected[i]))) << i;
    }
    const std::vector<double> each = quick->pointwise(x);
    for (std::size_t u = 0; u < each.size(); ++u) EXPECT_NEAR(each[u], log_likelihood[u], 1e-6);

    // The nodes that lives are mixed over have the moments of the rows' own, whose rule is less close.
    latent::UnitIntegrals whole;
    latent::integrate(rows, whole);
    const FormulaRows own(model, model->data.table.rows);
    const auto moment = [&](const latent::UnitIntegrals& of, std::size_t u, int power) {
      double total = 0;
      for (const latent::Sweep& sweep : of.sweeps) {
        if (sweep.weight[u] > 0)
          total += sweep.weight[u] * std::pow(sweep.z[u * model->effects.size()], power);
      }
      return total;
    };
    for (std::size_t u = 0; u < model->units.size(); ++u) {
      for (const int power : {0, 1, 2}) {
        EXPECT_NEAR(moment(own.integrate(x.data()), u, power), moment(whole, u, power), 1e-5);
      }
    }
  }
};

const std::string priors = R"(
a = { distribution = "lognormal", median = 2, log_sd = 1 }
rate = { distribution = "lognormal", median = 0.02, log_sd = 1 }
s0 = { distribution = "lognormal", median = 1, log_sd = 1 }
sigma = { distribution = "half-normal", scale = 1 }
u = { distribution = "half-normal", scale = 0.5 }
v = { distribution = "half-normal", scale = 0.5 }
r = { distribution = "uniform", lower = -1, upper = 1 }
)";
const std::string running_in = "a*(1 - exp(-s/s0)) + rate*F*s";

TEST_F(FormulaLinear, TwoEffectsAreWhatTheRowsSay) {
  for (const std::string a : {R"(a = { distribution = "lognormal", log_sd = "u" })",
                              R"(a = { distribution = "normal", sd = "u" })"}) {
    for (const std::string rate : {R"(rate = { distribution = "lognormal", log_sd = "v" })",
                                   R"(rate = { distribution = "normal", sd = "0.02*v" })"}) {
      SCOPED_TRACE(a + rate);
      const auto model = read(running_in, priors, a + "\n" + rate + "\ncorrelation = \"r\"\n");
      expect_alike(model, {2.7, 0.021, 1.1, 0.31, 0.3, 0.25, 0.4});
      expect_alike(model, {2.7, 0.021, 1.1, 0.2, 0.3, 0.25, -0.7});
      expect_alike(model, {1.0, 0.05, 0.4, 2.0, 0.9, 0.02, 0});
    }
  }
}

// A threshold is a case, but not one of what differs.
TEST_F(FormulaLinear, ThresholdsOfWhatDoesNotDifferAreCases) {
  const std::string some = R"(
k = { distribution = "lognormal", median = 0.01, log_sd = 1 }
F0 = { distribution = "uniform", lower = 0, upper = 60 }
sigma = { distribution = "half-normal", scale = 1 }
u = { distribution = "half-normal", scale = 0.5 }
)";
  const std::string lognormal = R"(k = { distribution = "lognormal", log_sd = "u" })";
  for (const char* mean : {"k*max(F - F0, 0)*s", "where(F > F0, k*(F - F0)*s, 0)"}) {
    const auto model = read(mean, some, lognormal + "\n");
    expect_alike(model, {0.013, 15, 0.4, 0.3});
    expect_alike(model, {0.013, 27, 0.4, 0.3});
    expect_alike(model, {0.013, 50, 0.4, 0.3});  // no row wears
  }
  const auto inside = read("max(k*F - F0, 0)*s", some, lognormal + "\n");
  EXPECT_FALSE(is_linear(*inside, bind_columns(*inside, inside->data.table.rows)));
}

// Where the form does not say it, values do.
TEST_F(FormulaLinear, ALineThatIsWrittenInAnotherWayIsTried) {
  const std::string some = R"(
k = { distribution = "lognormal", median = 0.01, log_sd = 1 }
sigma = { distribution = "half-normal", scale = 1 }
u = { distribution = "half-normal", scale = 0.5 }
)";
  const std::string lognormal = R"(k = { distribution = "lognormal", log_sd = "u" })";
  const auto model = read("exp(log(k) + log(F*s))", some, lognormal + "\n");
  EXPECT_TRUE(is_linear(*model, bind_columns(*model, model->data.table.rows)));
  const auto square = read("k^2*F*s", some, lognormal + "\n");
  EXPECT_FALSE(is_linear(*square, bind_columns(*square, square->data.table.rows)));
}

}  // namespace
}  // namespace wearwell::formula_model
