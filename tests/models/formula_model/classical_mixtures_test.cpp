// Classical estimates of lives of which a share can fail, and of subpopulations, against optim and numDeriv in R (tests/golden/classical_mixtures.R).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/golden.h"
#include "support/posterior_study.h"
#include "support/scratch.h"
#include "wearwell/models/registry.h"

namespace wearwell {
namespace {

using Json = nlohmann::ordered_json;
using testing::Contains;
using testing::HasSubstr;

class ClassicalMixturesTest : public ScratchTest {
 protected:
  static std::string study(const std::string& file, const std::string& columns,
                           const std::string& likelihood, const std::string& priors,
                           const std::string& predict) {
    return "model = \"formula\"\n[data]\nfile = \"" + file + "\"\n[data.columns]\n" + columns +
           likelihood + "[prior]\n" + priors + "[predict]\nclassical = true\nsides = \"two\"\n" +
           "credible_level = 0.9\n" + predict;
  }
  // With searches from points around these parameters, as from draws of a posterior.
  Json classical(const std::string& text, const std::vector<double>& about) const {
    const PosteriorStudy study = read_posterior_study(write("study.toml", text));
    constexpr Eigen::Index points = 16;
    const auto n = static_cast<Eigen::Index>(about.size());
    Fit fit;
    fit.pooled.values.resize(points, n);
    fit.pooled.weights = Eigen::VectorXd::Constant(points, 1.0 / points);
    for (Eigen::Index i = 0; i < points; ++i) {
      for (Eigen::Index j = 0; j < n; ++j)
        fit.pooled.values(i, j) = about[static_cast<std::size_t>(j)] *
                                  std::exp(0.1 * static_cast<double>(i * (j + 2) % 5 - 2));
    }
    return study.addition(fit).body.at("classical");
  }
  // Copies a table of the examples; its name.
  std::string example(const std::string& name) const {
    std::filesystem::copy_file(PROJECT_SOURCE_DIR "/examples/life/" + name, folder() / name);
    return name;
  }
};

const Json& named(const Json& list, const std::string& name, const std::string& of = "") {
  for (const Json& each : list) {
    if (each.at("name") == name && each.value("of", "") == of) return each;
  }
  throw std::logic_error("no " + name);
}

double exponential(double y) {
  return std::exp(y);
}
double share(double y) {
  return 1 / (1 + std::exp(-y));
}
double percent_left(double y) {
  return 100 * std::exp(-std::exp(y));
}

// Estimate and bounds of R on the scale of the normal approximation; an end that R does not find is open. `branches`: below
// the estimate the profile has a further branch, which a search outward from the maximum need not find.
template <class F>
void expect_bounds(const Json& found, const std::string& name, const std::string& what,
                   const F& converted, double close = 1e-4, bool decreasing = false,
                   bool branches = false) {
  for (const auto& row : read_golden("classical_mixtures.csv")) {
    if (row[0] != name || row[1] != what) continue;
    const std::size_t low = decreasing ? 1 : 0;
    const auto expect = [&](const Json& value, std::size_t column) {
      if (row[column] == "NA") {
        EXPECT_TRUE(std::isnan(value.get<double>())) << name << " " << what;
        return;
      }
      const double number = converted(std::stod(row[column]));
      ASSERT_TRUE(value.is_number()) << name << " " << what << " " << column;
      EXPECT_NEAR(value.get<double>() / number, 1, close) << name << " " << what << " " << column;
    };
    expect(found.at("value"), 2);
    expect(found.at("normal").at("lower"), 4 + low);
    expect(found.at("normal").at("upper"), 5 - low);
    if (!branches)
      expect(found.at("likelihood_ratio").at("lower"), 6 + low);
    else
      EXPECT_GE(found.at("likelihood_ratio").at("lower").get<double>(),
                (1 - close) * converted(std::stod(row[6 + low])));
    expect(found.at("likelihood_ratio").at("upper"), 7 - low);
    return;
  }
  FAIL() << name << " " << what;
}

const std::string rows_of_hours =
    "life = { column = \"hours\", unit = \"h\" }\nstatus = \"status\"\n";
const std::string limited =
    "[likelihood.life]\nfamily = \"weibull\"\nscale = \"eta\"\nshape = \"beta\"\n"
    "share_defective = \"p\"\n";
const std::string priors_of_limited =
    "eta = { distribution = \"lognormal\", median = \"100 h\", log_sd = 3 }\n"
    "beta = { distribution = \"lognormal\", median = 1, log_sd = 1 }\n"
    "p = { distribution = \"uniform\", lower = 0, upper = 1 }\n";

// Meeker and Escobar (1998), sec. 11.5.2: p 0.00674, location 3.34 and scale 2.02 of log life.
TEST_F(ClassicalMixturesTest, IntegratedCircuits) {
  const std::string file = example("circuits.csv");
  const Json found =
      classical(study(file, rows_of_hours + "count = \"count\"\n", limited, priors_of_limited,
                      "b_lives = [0.5, 10]\nsurvival_to = \"100 h\"\n"),
                {40, 0.6, 0.008});
  const Json& ml = found.at("maximum_likelihood");
  const Json& p = named(ml.at("parameters"), "p");
  EXPECT_NEAR(p.at("value").get<double>(), 0.00674, 5e-6);
  EXPECT_EQ(p.at("normal_scale"), "logit");
  EXPECT_NEAR(p.at("standard_error").get<double>(), 0.00674445 * (1 - 0.00674445) * 0.1896368,
              1e-7);
  EXPECT_NEAR(ml.at("log_likelihood").get<double>(), -293.032888, 1e-5);
  expect_bounds(p, "circuits", "p", share);
  expect_bounds(named(ml.at("parameters"), "eta"), "circuits", "eta", exponential);
  expect_bounds(named(ml.at("parameters"), "beta"), "circuits", "beta", exponential);
  expect_bounds(named(ml.at("quantities"), "B0.5 life", "unit"), "circuits", "log B0.5",
                exponential);
  expect_bounds(named(ml.at("quantities"), "survival to 100 h", "unit"), "circuits",
                "survival to 100", percent_left, 1e-4, true);
  // Fewer than 10 % fail: the life has no estimate, and the result says so.
  EXPECT_THROW(named(ml.at("quantities"), "B10 life", "unit"), std::logic_error);
  EXPECT_THAT(found.at("notes"), Contains(HasSubstr("0.6744 % fail at all: B10 life")));
  EXPECT_TRUE(found.at("groups").at(0).at("rank_regression").empty());
  EXPECT_THAT(found.at("notes"), Contains(HasSubstr("Rank regression is for one distribution")));
}

TEST_F(ClassicalMixturesTest, TwoSubpopulations) {
  const std::string file = example("controllers.csv");
  const Json found = classical(
      study(file, rows_of_hours,
            "[subpopulations]\nnames = [\"early\", \"late\"]\nshare = { early = \"w\" }\n"
            "[likelihood.life]\nfamily = \"weibull\"\nscale = \"eta[subpopulation]\"\nshape = "
            "\"beta[subpopulation]\"\n",
            "eta = { distribution = \"lognormal\", median = \"10000 h\", log_sd = 2 }\n"
            "beta = { distribution = \"lognormal\", median = 1.5, log_sd = 0.7 }\n"
            "w = { distribution = \"uniform\", lower = 0, upper = 1 }\n",
            "b_lives = 10\nsurvival_to = \"10000 h\"\n"),
      {700, 24000, 0.7, 3.3, 0.1});
  const Json& ml = found.at("maximum_likelihood");
  const Json& parameters = ml.at("parameters");
  EXPECT_NEAR(ml.at("log_likelihood").get<double>(), -726.191231, 1e-5);
  expect_bounds(named(parameters, "w"), "controllers", "w", share, 1e-3);
  for (const std::string name : {"eta[early]", "beta[early]", "eta[late]", "beta[late]"})
    expect_bounds(named(parameters, name), "controllers", name, exponential, 1e-3, false,
                  name == "eta[late]");
  const Json& quantities = ml.at("quantities");
  expect_bounds(named(quantities, "B10 life", "unit"), "controllers", "log B10", exponential, 1e-3,
                false, true);
  expect_bounds(named(quantities, "survival to 10000 h", "unit"), "controllers",
                "survival to 10000", percent_left, 1e-3, true);
  // Of each alone: its own Weibull distribution.
  EXPECT_NEAR(named(quantities, "B10 life", "unit of late").at("value").get<double>(),
              24446.9141 * std::pow(-std::log(0.9), 1 / 3.34130482), 1);
  EXPECT_NEAR(named(quantities, "B10 life", "unit of early").at("value").get<double>(),
              669.260449 * std::pow(-std::log(0.9), 1 / 0.688110516), 0.05);
  EXPECT_THAT(found.at("notes"), Contains(HasSubstr("shrinks to a single life")));
  EXPECT_THAT(found.at("notes"), Contains(HasSubstr("can be too narrow")));
}

// All items failed, so that the likelihood rises until the share is 1; with one run-out long after the failures its upper bound is 1.
TEST_F(ClassicalMixturesTest, SharesAtTheirBound) {
  std::string rows = "hours,status\n";
  for (const int life : {120, 210, 340, 390, 470, 520, 610, 780})
    rows += std::to_string(life) + ",failure\n";
  write("d.csv", rows);
  const Json at_bound = classical(
      study("d.csv", rows_of_hours, limited, priors_of_limited, "b_lives = 10\n"), {500, 2, 0.8});
  EXPECT_THAT(at_bound.at("maximum_likelihood").value("problem", ""),
              HasSubstr("rises until the share p is 1"));
  write("d.csv", rows + "900,runout\n");
  const Json near = classical(
      study("d.csv", rows_of_hours, limited, priors_of_limited, "b_lives = 10\n"), {500, 2, 0.8});
  const Json& ml = near.at("maximum_likelihood");
  ASSERT_FALSE(ml.contains("problem")) << ml.dump();
  const Json& ratio = named(ml.at("parameters"), "p").at("likelihood_ratio");
  EXPECT_TRUE(std::isnan(ratio.at("upper").get<double>()));
  EXPECT_THAT(ratio.at("upper_open").get<std::string>(), HasSubstr("to the bound 1 of a share"));
  EXPECT_THAT(near.at("notes"), Contains(HasSubstr("p: the likelihood-ratio interval has no end")));
}

// The maximum of the share of dead parts is their fraction, and the others have the estimates of a table without them.
TEST_F(ClassicalMixturesTest, DeadOnArrivalFactors) {
  const std::string rows = "hours,status\n120,failure\n210,failure\n340,failure\n400,runout\n";
  const std::string family = "[likelihood.life]\nfamily = \"exponential\"\nmean = \"m\"\n";
  const std::string prior =
      "m = { distribution = \"lognormal\", median = \"300 h\", log_sd = 2 }\n";
  write("d.csv", rows);
  const Json without =
      classical(study("d.csv", rows_of_hours, family, prior, "b_lives = 10\n"), {300});
  write("d.csv", rows + "0,failure\n");
  const Json with =
      classical(study("d.csv", rows_of_hours, family + "share_dead_on_arrival = \"d\"\n",
                      prior + "d = { distribution = \"uniform\", lower = 0, upper = 1 }\n",
                      "b_lives = [10, 50]\n"),
                {300, 0.2});
  const Json& parameters = with.at("maximum_likelihood").at("parameters");
  const Json& m = named(parameters, "m");
  const Json& alone = named(without.at("maximum_likelihood").at("parameters"), "m");
  EXPECT_NEAR(named(parameters, "d").at("value").get<double>(), 0.2, 1e-6);
  EXPECT_NEAR(m.at("value").get<double>(), 1070.0 / 3, 1e-3);
  for (const char* const end : {"lower", "upper"})
    EXPECT_NEAR(m.at("likelihood_ratio").at(end).get<double>() /
                    alone.at("likelihood_ratio").at(end).get<double>(),
                1, 1e-5);
}

}  // namespace
}  // namespace wearwell
