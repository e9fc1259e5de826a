// Classical estimates (predict.classical) from the file of a study: maximum likelihood with both kinds of bounds against R's survival package
// (tests/golden/classical_estimates.R) and closed forms; what does not exist is said.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

#include "support/golden.h"
#include "support/posterior_study.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/math/view.h"
#include "wearwell/models/registry.h"
#include "wearwell/study/run_study.h"

namespace wearwell {
namespace {

using Json = nlohmann::ordered_json;
using testing::HasSubstr;

constexpr const char* weibull = "family = \"weibull\"\nscale = \"eta\"\nshape = \"beta\"\n";
constexpr const char* lognormal = "family = \"lognormal\"\nmedian = \"eta\"\nlog_sd = \"beta\"\n";
constexpr const char* vague =
    "eta = { distribution = \"lognormal\", median = \"100 h\", log_sd = 3 }\n"
    "beta = { distribution = \"lognormal\", median = 1, log_sd = 1 }\n";

class ClassicalEstimatesTest : public ScratchTest {
 protected:
  std::string study(const std::string& columns, const std::string& likelihood,
                    const std::string& priors, const std::string& predict) const {
    return "model = \"formula\"\n[data]\nfile = \"d.csv\"\n[data.columns]\n" + columns +
           "[likelihood.life]\n" + likelihood + "[prior]\n" + priors +
           "[predict]\nclassical = true\n" + predict;
  }
  PosteriorSummary run(const std::string& text) const {
    return run_study(read_posterior_study(write("study.toml", text)),
                     {Method::exact, 1, {}, 50, {}}, {}, false);
  }
  // The estimates do not depend on the draws, from which their searches start: any points will do.
  Json classical(const std::string& text) const {
    const PosteriorStudy study = read_posterior_study(write("study.toml", text));
    const Posterior posterior(study.parameters, study.likelihood(study.data_rows));
    constexpr Eigen::Index points = 9;
    const Eigen::Index n = posterior.dimension();
    Fit fit;
    fit.pooled.values.resize(points, n);
    fit.pooled.weights = Eigen::VectorXd::Constant(points, 1.0 / points);
    for (Eigen::Index i = 0; i < points; ++i) {
      Eigen::VectorXd z = posterior.start(), x(n);
      for (Eigen::Index j = 0; j < n; ++j) z[j] += 0.1 * static_cast<double>(i * (j + 2) % 5 - 2);
      posterior.to_natural(view(z), view(x));
      fit.pooled.values.row(i) = x;
    }
    return study.addition(fit).body.at("classical");
  }
  std::string refusal(const std::string& text) const {
    return message_of<InputError>([&] { read_posterior_study(write("study.toml", text)); });
  }
};

const Json& named(const Json& list, const std::string& name) {
  for (const Json& each : list) {
    if (each.at("name") == name) return each;
  }
  throw std::logic_error("no " + name);
}

// Estimate and bounds of R on a scale, converted; a decreasing conversion exchanges the bounds.
template <class F>
void expect_bounds(const Json& found, const std::string& name, const std::string& what,
                   const F& converted, bool decreasing = false) {
  for (const auto& row : read_golden("classical_estimates.csv")) {
    if (row[0] != name || row[1] != what) continue;
    const auto at = [&](int i) { return converted(std::stod(row[static_cast<std::size_t>(i)])); };
    const int low = decreasing ? 1 : 0;
    const auto expect = [&](const Json& value, double number, double tolerance) {
      EXPECT_NEAR(value.get<double>(), number, tolerance * std::abs(number)) << name << " " << what;
    };
    expect(found.at("value"), at(2), 1e-5);
    expect(found.at("normal").at("lower"), at(4 + low), 1e-5);
    expect(found.at("normal").at("upper"), at(5 - low), 1e-5);
    expect(found.at("likelihood_ratio").at("lower"), at(6 + low), 1e-5);
    expect(found.at("likelihood_ratio").at("upper"), at(7 - low), 1e-5);
    return;
  }
  FAIL() << name << " " << what;
}

void expect_weibull(const Json& found, const std::string& name, const std::string& survival) {
  const Json& ml = found.at("maximum_likelihood");
  const auto exponential = [](double y) { return std::exp(y); };
  expect_bounds(named(ml.at("parameters"), "eta"), name, "location", exponential);
  expect_bounds(
      named(ml.at("parameters"), "beta"), name, "log scale", [](double y) { return std::exp(-y); },
      true);
  expect_bounds(named(ml.at("quantities"), "B10 life"), name, "log B10", exponential);
  expect_bounds(
      named(ml.at("quantities"), survival), name, "survival deviate",
      [](double u) { return 100 * std::exp(-std::exp(u)); }, true);
}

const std::string two_sided = "b_lives = 10\ncredible_level = 0.9\nsides = \"two\"\n";

std::string table_of_shocks() {
  std::ifstream file(PROJECT_SOURCE_DIR "/examples/life/shock_absorbers.csv");
  std::string out = "life,status\n", line;
  for (std::getline(file, line); std::getline(file, line);) {
    const auto comma = line.find(',');
    out +=
        line.substr(0, comma) + (line.find("censored") == line.npos ? ",failure\n" : ",runout\n");
  }
  return out;
}

// 81.88 and 2.102, log-likelihood -113.69 (Lawless 2003).
TEST_F(ClassicalEstimatesTest, BallBearingsAreThoseOfR) {
  std::filesystem::copy_file(PROJECT_SOURCE_DIR "/examples/life/bearings.csv", folder() / "d.csv");
  const std::string columns = "life = { column = \"million_revolutions\", unit = \"h\" }\n";
  const Json found =
      classical(study(columns, weibull, vague, two_sided + "survival_to = \"20 h\"\n"));
  expect_weibull(found, "bearings weibull", "survival to 20 h");
  const Json& ml = found.at("maximum_likelihood");
  EXPECT_NEAR(named(ml.at("parameters"), "eta").at("value").get<double>(), 81.88, 5e-3);
  EXPECT_NEAR(named(ml.at("parameters"), "beta").at("value").get<double>(), 2.102, 5e-4);
  EXPECT_NEAR(ml.at("log_likelihood").get<double>(), -113.6912909, 1e-6);
  EXPECT_EQ(ml.at("density_unit"), "h");
  // Standard errors by the delta method: of eta, eta times that of its logarithm.
  EXPECT_NEAR(named(ml.at("parameters"), "eta").at("standard_error").get<double>(),
              std::exp(4.405234414) * 0.1050393346, 1e-4);

  const Json log_normal =
      classical(study(columns, lognormal, vague, two_sided + "survival_to = \"20 h\"\n"));
  const Json& other = log_normal.at("maximum_likelihood");
  expect_bounds(named(other.at("quantities"), "B10 life"), "bearings lognormal", "log B10",
                [](double y) { return std::exp(y); });
  expect_bounds(
      named(other.at("quantities"), "survival to 20 h"), "bearings lognormal", "survival deviate",
      [](double u) { return 50 * std::erfc(u / std::sqrt(2)); }, true);
}

// Normal bounds of location and scale of log life that weibulltools 2.1 has in its tests: 10.0491099 to 10.4106162 and 0.2163041 to 0.4628426.
TEST_F(ClassicalEstimatesTest, ShockAbsorbersAreThoseOfRAndWeibulltools) {
  write("d.csv", table_of_shocks());
  const Json found =
      classical(study("life = { column = \"life\", unit = \"h\" }\nstatus = \"status\"\n", weibull,
                      vague, two_sided + "survival_to = \"10000 h\"\n"));
  expect_weibull(found, "shocks weibull", "survival to 10000 h");
  const Json& parameters = found.at("maximum_likelihood").at("parameters");
  const Json& eta = named(parameters, "eta").at("normal");
  EXPECT_NEAR(std::log(eta.at("lower").get<double>()), 10.0491099, 2e-6);
  EXPECT_NEAR(std::log(eta.at("upper").get<double>()), 10.4106162, 2e-6);
  const Json& beta = named(parameters, "beta").at("normal");
  EXPECT_NEAR(1 / beta.at("upper").get<double>(), 0.2163041, 1e-6);
  EXPECT_NEAR(1 / beta.at("lower").get<double>(), 0.4628426, 1e-6);
  const Json& group = found.at("groups").at(0);
  ASSERT_EQ(group.at("rank_regression").size(), 2u);
  EXPECT_EQ(group.at("rank_regression").at(1).at("median_ranks"), "benard");
  EXPECT_NEAR(group.at("rank_regression").at(1).at("parameters").at("scale").get<double>(),
              std::exp(10.2595802), 1e-2);
  EXPECT_NEAR(group.at("rank_regression").at(1).at("parameters").at("shape").get<double>(),
              1 / 0.3632051, 1e-5);
  std::size_t i = 0;
  for (const auto& row : read_golden("survival_bands.csv")) {
    if (row[0] != "shocks") continue;
    const Json& step = group.at("survival").at("steps").at(i++);
    EXPECT_NEAR(step.at("survival").get<double>(), std::stod(row[4]), 1e-10);
    EXPECT_NEAR(step.at("lower").get<double>(), std::stod(row[6]), 1e-10);
    EXPECT_NEAR(step.at("upper").get<double>(), std::stod(row[7]), 1e-10);
  }
}

TEST_F(ClassicalEstimatesTest, EveryCensoringAndCountsAreThoseOfR) {
  write("d.csv",
        "life,lower,upper,status,n\n,0,100,interval,2\n,100,200,interval,3\n,200,300,interval,4\n"
        "260,,,failure,1\n300,,,runout,5\n500,,,runout,3\n");
  const Json found = classical(
      study("life = { column = \"life\", unit = \"h\" }\nstatus = \"status\"\nlower = { column = "
            "\"lower\", unit = \"h\" }\nupper = { column = \"upper\", unit = \"h\" }\ncount = "
            "\"n\"\n",
            weibull, vague, two_sided + "survival_to = \"150 h\"\n"));
  expect_weibull(found, "mixed weibull", "survival to 150 h");
  EXPECT_EQ(found.at("groups").at(0).at("survival").at("method"), "turnbull");
  EXPECT_TRUE(found.at("groups").at(0).at("rank_regression").empty());
  EXPECT_THAT(found.at("notes").dump(), HasSubstr("Rank regression needs at least two failures"));
}

TEST_F(ClassicalEstimatesTest, PriorsHaveNoPart) {
  write("d.csv", "life\n31\n54\n70\n82\n90\n");
  const auto of = [&](const std::string& priors) {
    return classical(study("life = { column = \"life\", unit = \"h\" }\n", weibull, priors, ""))
        .at("maximum_likelihood");
  };
  const Json wide = of(vague);
  const Json elsewhere =
      of("eta = { distribution = \"uniform\", lower = \"200 h\", upper = \"300 h\" }\nbeta = { "
         "distribution = \"lognormal\", median = 0.7, log_sd = 0.1 }\n");
  for (const std::string list : {"parameters", "quantities"}) {
    ASSERT_EQ(wide.at(list).size(), elsewhere.at(list).size());
    for (std::size_t i = 0; i < wide.at(list).size(); ++i) {
      for (const std::string kind : {"normal", "likelihood_ratio"}) {
        for (const std::string end : {"lower", "upper"}) {
          const double a = wide.at(list).at(i).at(kind).at(end).get<double>();
          EXPECT_NEAR(elsewhere.at(list).at(i).at(kind).at(end).get<double>(), a,
                      1e-6 * std::abs(a));
        }
      }
    }
  }
}

// At any level, of parameters and quantities: 5 and 95 % are those of the other tables.
TEST_F(ClassicalEstimatesTest, PosteriorBoundsAreItsQuantiles) {
  write("d.csv", "life\n31\n54\n70\n82\n90\n");
  const PosteriorSummary result = run(study("life = { column = \"life\", unit = \"h\" }\n", weibull,
                                            vague, two_sided + "survival_to = \"40 h\"\n"));
  const Json& ml = result.added.body.at("classical").at("maximum_likelihood");
  const ExactSummary eta = result.parameters.front().best();
  const Json& bounds = named(ml.at("parameters"), "eta").at("posterior");
  EXPECT_NEAR(bounds.at("lower").get<double>(), eta.q05, 1e-9 * eta.q05);
  EXPECT_NEAR(bounds.at("upper").get<double>(), eta.q95, 1e-9 * eta.q95);
  int seen = 0;
  for (const QuantitySummary& each : result.quantities) {
    if (each.name != "B10 life" && each.name != "survival to 40 h") continue;
    const Json& own = named(ml.at("quantities"), each.name).at("posterior");
    EXPECT_NEAR(own.at("lower").get<double>(), each.best().q05, 1e-9 * each.best().q05);
    EXPECT_NEAR(own.at("upper").get<double>(), each.best().q95, 1e-9 * each.best().q95);
    ++seen;
  }
  EXPECT_EQ(seen, 2);
}

// One-sided bounds of a level are the two-sided ones of 2 level - 1.
TEST_F(ClassicalEstimatesTest, SidesAndLevelsAgree) {
  write("d.csv", "life\n31\n54\n70\n82\n90\n");
  const auto eta = [&](const std::string& predict) {
    const Json found =
        classical(study("life = { column = \"life\", unit = \"h\" }\n", weibull, vague, predict));
    return named(found.at("maximum_likelihood").at("parameters"), "eta");
  };
  const Json one = eta("credible_level = 0.95\n");
  const Json two = eta("credible_level = 0.9\nsides = \"two\"\n");
  EXPECT_EQ(one.at("normal"), two.at("normal"));
  EXPECT_NEAR(one.at("likelihood_ratio").at("lower").get<double>(),
              two.at("likelihood_ratio").at("lower").get<double>(), 1e-9);
  const std::string columns = "life = { column = \"life\", unit = \"h\" }\n";
  EXPECT_THAT(refusal(study(columns, weibull, vague, "sides = \"each\"\n")),
              HasSubstr("predict.sides"));
  EXPECT_THAT(refusal(study(columns, weibull, vague, "credible_level = 0.4\n")),
              HasSubstr("must exceed 50 %"));
}

// The mean of an exponential distribution: likelihood-ratio bounds solve r (T/m - 1 - log(T/m)) = chi-square/2.
TEST_F(ClassicalEstimatesTest, OneFailureOfAnExponentialDistribution) {
  write("d.csv", "life,status\n40,failure\n100,runout\n100,runout\n");
  const Json found = classical(
      study("life = { column = \"life\", unit = \"h\" }\nstatus = \"status\"\n",
            "family = \"exponential\"\nmean = \"m\"\n",
            "m = { distribution = \"lognormal\", median = \"100 h\", log_sd = 2 }\n", two_sided));
  const Json& m = named(found.at("maximum_likelihood").at("parameters"), "m");
  EXPECT_NEAR(m.at("value").get<double>(), 240, 1e-5);
  EXPECT_NEAR(m.at("normal").at("lower").get<double>(), 240 * std::exp(-1.6448536), 1e-4);
  const double half = 0.5 * boost::math::quantile(boost::math::chi_squared(1), 0.9);
  for (const std::string end : {"lower", "upper"}) {
    const double ratio = 240 / m.at("likelihood_ratio").at(end).get<double>();
    EXPECT_NEAR(ratio - 1 - std::log(ratio), half, 1e-6);
  }
}

TEST_F(ClassicalEstimatesTest, WhatDoesNotExistIsSaid) {
  const std::string columns = "life = { column = \"life\", unit = \"h\" }\nstatus = \"status\"\n";
  const auto problem = [&](const std::string& rows) {
    write("d.csv", "life,status\n" + rows);
    const Json found = classical(study(columns, weibull, vague, ""));
    EXPECT_TRUE(found.at("groups").at(0).at("rank_regression").empty()) << rows;
    return found.at("maximum_likelihood").value("problem", "");
  };
  EXPECT_THAT(problem("40,runout\n70,runout\n"), HasSubstr("no failure was observed"));
  EXPECT_THAT(problem("40,failure\n"), HasSubstr("rises without end along beta"));
  EXPECT_THAT(problem("40,failure\n40,failure\n40,failure\n"),
              HasSubstr("rises without end along beta"));
  // The last item failed: no shape is too large.
  EXPECT_THAT(problem("30,runout\n40,failure\n"), HasSubstr("rises without end along beta"));
  write("d.csv", "life,status\n40,failure\n70,runout\n");
  const Json one = classical(study(columns, weibull, vague, ""));
  EXPECT_FALSE(one.at("maximum_likelihood").contains("problem"));
}

// Late entries: exponential lives have their exposure only from then on.
TEST_F(ClassicalEstimatesTest, LateEntriesCount) {
  write("d.csv", "life,since\n40,10\n60,20\n90,0\n");
  const Json found = classical(study(
      "life = { column = \"life\", unit = \"h\" }\nentry = { column = \"since\", unit = \"h\" }\n",
      "family = \"exponential\"\nmean = \"m\"\n",
      "m = { distribution = \"lognormal\", median = \"100 h\", log_sd = 2 }\n", two_sided));
  EXPECT_NEAR(named(found.at("maximum_likelihood").at("parameters"), "m").at("value").get<double>(),
              160.0 / 3, 1e-5);
}

// The local maximum of the ball bearings: 63.880047, 1.594299, 14.875916 (tests/golden/formula_model.R).
TEST_F(ClassicalEstimatesTest, ThresholdsHaveTheirLocalMaximum) {
  std::filesystem::copy_file(PROJECT_SOURCE_DIR "/examples/life/bearings.csv", folder() / "d.csv");
  const Json found = classical(
      study("life = { column = \"million_revolutions\", unit = \"h\" }\n",
            std::string(weibull) + "threshold = \"t0\"\n",
            "eta = { distribution = \"lognormal\", median = \"80 h\", log_sd = 1 }\nbeta = { "
            "distribution = \"lognormal\", median = 2, log_sd = 0.5 }\nt0 = { distribution = "
            "\"uniform\", lower = \"0 h\", upper = \"17.8 h\" }\n",
            two_sided));
  const Json& parameters = found.at("maximum_likelihood").at("parameters");
  EXPECT_NEAR(named(parameters, "eta").at("value").get<double>(), 63.880047, 2e-3);
  EXPECT_NEAR(named(parameters, "beta").at("value").get<double>(), 1.594299, 5e-5);
  EXPECT_NEAR(named(parameters, "t0").at("value").get<double>(), 14.875916, 1e-3);
  EXPECT_EQ(named(parameters, "t0").at("normal_scale"), "natural");
  EXPECT_TRUE(found.at("groups").at(0).at("rank_regression").empty());
}

// Modes alone have the estimates of their failures with all others as run-outs.
TEST_F(ClassicalEstimatesTest, ModesFactor) {
  std::filesystem::copy_file(PROJECT_SOURCE_DIR "/examples/life/shock_absorbers.csv",
                             folder() / "d.csv");
  const Json found = classical(
      "model = \"formula\"\n[data]\nfile = \"d.csv\"\n[data.columns]\nlife = { column = \"km\", "
      "unit = \"km\" }\nmode = \"failure mode\"\n[failure_modes]\ncolumn = "
      "\"mode\"\n[likelihood.life]\nfamily = \"weibull\"\nscale = \"eta[mode]\"\nshape = "
      "\"beta[mode]\"\n[prior]\neta = { distribution = \"lognormal\", median = \"50000 km\", "
      "log_sd = 2 }\nbeta = { distribution = \"lognormal\", median = 1.5, log_sd = 0.7 "
      "}\n[predict]\nclassical = true\nb_lives = 10\n");
  const Json& ml = found.at("maximum_likelihood");
  const std::string text = table_of_shocks();
  std::ifstream file(PROJECT_SOURCE_DIR "/examples/life/shock_absorbers.csv");
  std::string rows = "life,status\n", line;
  for (std::getline(file, line); std::getline(file, line);)
    rows += line.substr(0, line.find(',')) +
            (line.find("mode 1") == line.npos ? ",runout\n" : ",failure\n");
  write("d.csv", rows);
  const Json alone =
      classical(study("life = { column = \"life\", unit = \"km\" }\nstatus = \"status\"\n", weibull,
                      "eta = { distribution = \"lognormal\", median = \"50000 km\", log_sd = 2 "
                      "}\nbeta = { distribution = \"lognormal\", median = 1.5, log_sd = 0.7 }\n",
                      "b_lives = 10\n"));
  const auto close = [](const Json& a, const Json& b) {
    for (const std::string kind : {"normal", "likelihood_ratio"}) {
      for (const std::string end : {"lower", "upper"})
        EXPECT_NEAR(a.at(kind).at(end).get<double>() / b.at(kind).at(end).get<double>(), 1, 1e-5);
    }
  };
  close(ml.at("parameters").at(0), alone.at("maximum_likelihood").at("parameters").at(0));
  bool seen = false;
  for (const Json& each : ml.at("quantities")) {
    if (each.at("of") != "unit with mode 1 alone") continue;
    close(each, alone.at("maximum_likelihood").at("quantities").at(0));
    seen = true;
  }
  EXPECT_TRUE(seen);
  ASSERT_EQ(found.at("groups").size(), 3u);
  EXPECT_EQ(found.at("groups").at(1).at("rank_regression"),
            alone.at("groups").at(0).at("rank_regression"));
}

// A drug on life: maximum likelihood of the formula, rank regression of each condition.
TEST_F(ClassicalEstimatesTest, DriversHaveOneLikelihoodAndALineEach) {
  write("d.csv", "life,stress\n100,1\n140,1\n190,1\n30,2\n41,2\n60,2\n");
  const Json found = classical(
      "model = \"formula\"\n[data]\nfile = \"d.csv\"\n[data.columns]\nlife = { column = \"life\", "
      "unit = \"h\" }\nstress = \"stress\"\n[likelihood.life]\nfamily = \"lognormal\"\nmedian = "
      "\"a * stress^-n\"\nlog_sd = \"s\"\n[prior]\na = { distribution = \"lognormal\", median = "
      "\"100 h\", log_sd = 2 }\nn = { distribution = \"normal\", mean = 1, sd = 3 }\ns = { "
      "distribution = \"lognormal\", median = 0.5, log_sd = 1 }\n[predict]\nclassical = true\n"
      "given = { stress = 1.5 }\nb_lives = 50\n");
  const Json& ml = found.at("maximum_likelihood");
  // Least squares of log life, with the residuals' mean square.
  double mean[2] = {}, squares = 0;
  const double lives[2][3] = {{100, 140, 190}, {30, 41, 60}};
  for (int g = 0; g < 2; ++g) {
    for (const double life : lives[g]) mean[g] += std::log(life) / 3;
    for (const double life : lives[g]) squares += std::pow(std::log(life) - mean[g], 2);
  }
  const double n = (mean[0] - mean[1]) / std::log(2), s = std::sqrt(squares / 6);
  EXPECT_NEAR(named(ml.at("parameters"), "n").at("value").get<double>(), n, 1e-6);
  EXPECT_NEAR(named(ml.at("parameters"), "s").at("value").get<double>(), s, 1e-6);
  EXPECT_EQ(named(ml.at("parameters"), "n").at("normal_scale"), "natural");
  const Json& half = named(ml.at("quantities"), "B50 life");
  const double median = std::exp(mean[0] - n * std::log(1.5));
  EXPECT_NEAR(half.at("value").get<double>(), median, 1e-4);
  // Profile of a mean of log life: 6 log(1 + d^2/(v squares)), v its variance factor.
  const double share = std::log(1.5) / std::log(2);
  const double v = ((1 - share) * (1 - share) + share * share) / 3;
  const double upper = half.at("likelihood_ratio").at("upper").get<double>();
  const double d = std::log(upper / median);
  EXPECT_NEAR(6 * std::log1p(d * d / (v * squares)),
              boost::math::quantile(boost::math::chi_squared(1), 0.8), 1e-5);
  EXPECT_EQ(found.at("groups").size(), 2u);
  EXPECT_EQ(found.at("groups").at(0).at("condition"), "stress = 1");
}

TEST_F(ClassicalEstimatesTest, RandomEffectsAndCountsAreRefused) {
  write("d.csv", "life,batch\n100,a\n140,a\n190,b\n30,b\n");
  EXPECT_THAT(
      refusal("model = \"formula\"\n[data]\nfile = \"d.csv\"\n[data.columns]\nlife = { column = "
              "\"life\", unit = \"h\" }\nbatch = \"batch\"\n[likelihood.life]\nfamily = "
              "\"weibull\"\nscale = \"eta\"\nshape = \"beta\"\n[random_effects.batch]\neta = { "
              "distribution = \"lognormal\", log_sd = \"tau\" }\n[prior]\n" +
              std::string(vague) +
              "tau = { distribution = \"half-normal\", scale = 1 }\n[predict]\nclassical = "
              "true\n"),
      HasSubstr("without random effects"));
}

// ---- Weibayes: a given shape.

// With r failures and a nearly flat prior of the failure rate eta^-shape the lower bound is the classical one: (2 sum(t^shape)/chi-square(2r + 2))^(1/shape)
// (Abernethy 2006, ch. 6).
TEST_F(ClassicalEstimatesTest, WeibayesIsThePosteriorOfAFlatRate) {
  const std::string columns = "life = { column = \"life\", unit = \"h\" }\nstatus = \"status\"\n";
  for (const int failures : {0, 2}) {
    std::string rows = "life,status\n";
    double sum = 0;
    for (int i = 0; i < 5; ++i) {
      const double life = 300 + 100 * i;
      rows += std::to_string(life) + (i < failures ? ",failure\n" : ",runout\n");
      sum += std::pow(life, 2.5);
    }
    write("d.csv", rows);
    const PosteriorSummary result = run(
        "model = \"formula\"\n[data]\nfile = \"d.csv\"\n[data.columns]\n" + columns +
        "[constants]\nunit_life = \"1000 h\"\n[formula]\neta = \"unit_life * rate^(-1/2.5)\"\n"
        "[likelihood.life]\nfamily = \"weibull\"\nscale = \"eta\"\nshape = 2.5\n[prior]\nrate = { "
        "distribution = \"exponential\", mean = 1e4 }\n[predict]\nb_lives = [10]\ncredible_level = "
        "0.9\n"
        "quantities = { eta = \"eta\" }\n");
    const double chi2 = boost::math::quantile(boost::math::chi_squared(2 * failures + 2), 0.9);
    const double eta = std::pow(2 * sum / chi2, 1 / 2.5);
    bool seen = false;
    for (const QuantitySummary& each : result.quantities) {
      if (each.name != "B10 life") continue;
      EXPECT_NEAR(*each.best().bound, eta * std::pow(-std::log(0.9), 1 / 2.5), 1e-3 * eta);
      seen = true;
    }
    EXPECT_TRUE(seen);
  }
}

}  // namespace
}  // namespace wearwell
