// Units that are read off a table of their sums of squares: against the rows themselves.
#include "wearwell/models/formula_model/formula_tabled.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/scratch.h"
#include "wearwell/models/formula_model/formula_likelihood.h"
#include "wearwell/models/formula_model/formula_reader.h"

namespace wearwell::formula_model {
namespace {

constexpr double steps[] = {0.3, -0.7, 1.1, 0.2, -1.4, 0.6, -0.1, 0.9};  // errors of readings

class FormulaTabled : public ScratchTest {
 protected:
  struct Distribution {
    std::string model, family = "normal", family_parameters = "mean = \"a\"\nsd = \"sigma\"\n";
    std::string priors, random_effects;
  };
  // Cracks by Paris' law with m = 3, of which the length is known: 1/sqrt(a) falls evenly.
  std::string cracks() const {
    std::string text = "plate,n,a_mm\n";
    int k = 0;
    for (const double pace : {0.8, 1.0, 1.35, 1.1}) {
      for (int i = 1; i <= 9; ++i) {
        const double n = 10000 * i / pace;
        const double a = 9 / std::pow(1 - 0.045 * i * (0.9 + 0.1 * pace), 2);
        text += fmt::format("p{},{},{:.4f}\n", pace, n, a + 0.2 * steps[k++ % 8]);
      }
    }
    return text;
  }
  std::shared_ptr<FormulaModel> read(const Distribution& of) const {
    write("d.csv", cracks());
    const Source source = source_of(write(
        "study.toml",
        "model = \"formula\"\n[data]\nfile = \"d.csv\"\n[data.columns]\n"
        "a = { column = \"a_mm\", unit = \"mm\" }\nn = \"n\"\nplate = \"plate\"\n[formula]\n" +
            of.model + "[likelihood.a]\nfamily = \"" + of.family + "\"\n" + of.family_parameters +
            "[prior]\n" + of.priors + "[random_effects.plate]\n" + of.random_effects +
            "[predict]\nalong = \"n\"\n"));
    return read_formula_model(TomlReader::parse(source.study), source);
  }
  static Distribution paris() {
    return {"\"d(a)/d(n)\" = \"C * (a/10 [mm])^(m/2)\"\n\"a(0)\" = \"9 [mm]\"\n", "normal",
            "mean = \"a\"\nsd = \"sigma\"\n",
            "C = { distribution = \"lognormal\", median = \"1e-4 mm\", log_sd = 2 }\n"
            "m = { distribution = \"normal\", mean = 3, sd = 1 }\n"
            "s = { distribution = \"half-normal\", scale = 0.5 }\n"
            "sigma = { distribution = \"half-normal\", scale = \"1 mm\" }\n",
            "C = { distribution = \"lognormal\", log_sd = \"s\" }\n"};
  }
  static bool has_table(const FormulaModel& model) {
    const auto columns = bind_columns(model, model.data.table.rows);
    const auto form = tabled_form(model, columns);
    UnitRows rows(model, columns);
    return form && make_table(rows, *form);
  }
  // By the table and by the rows, values, gradients and units' own.
  static void expect_alike(const std::shared_ptr<FormulaModel>& model,
                           const std::vector<double>& x) {
    const std::size_t all = model->data.table.rows;
    const auto quick = formula_likelihood(std::make_shared<const FormulaRows>(model, all, true)),
               whole = formula_likelihood(std::make_shared<const FormulaRows>(model, all));
    const double value = whole->value(x);
    ASSERT_TRUE(std::isfinite(value));
    EXPECT_NEAR(quick->value(x), value, 2e-7);
    std::vector<double> gradient(x.size()), expected(x.size());
    EXPECT_NEAR(quick->value_and_gradient(x, gradient), value, 2e-7);
    whole->value_and_gradient(x, expected);
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double size = 1 + std::abs(x[i] * expected[i]);
      EXPECT_NEAR(x[i] * gradient[i], x[i] * expected[i], 2e-6 * size) << model->parameters[i].name;
    }
    const std::vector<double> own = quick->pointwise(x), rows = whole->pointwise(x);
    for (std::size_t u = 0; u < rows.size(); ++u) EXPECT_NEAR(own[u], rows[u], 1e-7);
  }
};

TEST_F(FormulaTabled, CracksAreWhatTheRowsSay) {
  const auto model = read(paris());
  ASSERT_TRUE(has_table(*model));
  for (const std::vector<double>& x : std::vector<std::vector<double>>{
           {9.2e-8, 3.0, 0.15, 2.1e-4},
           {8e-8, 3.2, 0.3, 3e-4},
           {1.1e-7, 2.7, 0.05, 2.5e-4},
           {9e-8, 3.05, 1.2, 1.7e-4},
           {9e-8, 2.95, 0.004, 9e-4},
           {4e-8, 3.0, 0.02, 2e-4},    // plates far from their middle
           {9e-8, 3.0, 0.2, 2e-2},     // readings that tell next to nothing: by the rows
           {9e-8, 6.5, 0.2, 2e-3}}) {  // m beyond the table: by the rows
    expect_alike(model, x);
  }
}

TEST_F(FormulaTabled, OtherFormsToo) {
  Distribution form = paris();  // nothing shared
  form.model = "\"d(a)/d(n)\" = \"C * (a/10 [mm])^1.5\"\n\"a(0)\" = \"9 [mm]\"\n";
  form.priors.erase(form.priors.find("m ="), form.priors.find("s =") - form.priors.find("m ="));
  auto model = read(form);
  ASSERT_TRUE(has_table(*model));
  expect_alike(model, {9.2e-8, 0.15, 2.1e-4});

  for (const char* family : {"lognormal", "log10-normal"}) {
    form = paris();
    form.family = family;
    form.family_parameters = form.family == "lognormal" ? "median = \"a\"\nlog_sd = \"2*w\"\n"
                                                        : "median = \"a\"\nlog10_sd = \"w\"\n";
    form.priors.replace(form.priors.find("sigma ="), std::string::npos,
                        "w = { distribution = \"half-normal\", scale = 0.1 }\n");
    model = read(form);
    ASSERT_TRUE(has_table(*model));
    expect_alike(model, {9.2e-8, 3.0, 0.15, 0.01});
  }

  // A curve without a state, its exponent normal about one of all.
  form = paris();
  form.model = "";
  form.family_parameters = "mean = \"9 [mm] + b*(n/1e5)^q\"\nsd = \"sigma\"\n";
  form.priors =
      "b = { distribution = \"normal\", mean = \"15 mm\", sd = \"10 mm\" }\n"
      "q = { distribution = \"normal\", mean = 1.2, sd = 0.5 }\n"
      "s = { distribution = \"half-normal\", scale = 0.5 }\n"
      "sigma = { distribution = \"half-normal\", scale = \"1 mm\" }\n";
  form.random_effects = "q = { distribution = \"normal\", sd = \"s\" }\n";
  model = read(form);
  ASSERT_TRUE(has_table(*model));
  expect_alike(model, {0.009, 1.5, 0.2, 1e-3});
}

TEST_F(FormulaTabled, WhatHasNone) {
  Distribution form = paris();  // two parameters that all share
  form.model = "\"d(a)/d(n)\" = \"C * (a/10 [mm])^(m/2)\"\n\"a(0)\" = \"start\"\n";
  form.priors += "start = { distribution = \"normal\", mean = \"9 mm\", sd = \"0.1 mm\" }\n";
  EXPECT_FALSE(has_table(*read(form)));
  form = paris();  // errors that differ
  form.family_parameters = "mean = \"a\"\nsd = \"sigma*(1 + n/1e5)\"\n";
  EXPECT_FALSE(has_table(*read(form)));
  form = paris();  // a corner
  form.model = "\"d(a)/d(n)\" = \"C * max(a/10 [mm], 1)^(m/2)\"\n\"a(0)\" = \"9 [mm]\"\n";
  EXPECT_FALSE(has_table(*read(form)));
}

}  // namespace
}  // namespace wearwell::formula_model
