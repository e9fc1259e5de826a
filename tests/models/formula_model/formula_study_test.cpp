// Studies of laws in the user's own words, from file to answer.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/posterior_study.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/study/run_study.h"

namespace wearwell {
namespace {

using testing::HasSubstr;

const std::string examples = PROJECT_SOURCE_DIR "/examples/";

class FormulaStudy : public ScratchTest {
 protected:
  PosteriorSummary run(const std::string& text) const {
    return run_study(wearwell::read_posterior_study(write("study.toml", text)),
                     {Method::exact, 1, {}, 50, {}}, {}, false);
  }
  std::string refusal(const std::string& text) const {
    return message_of<InputError>(
        [&] { wearwell::read_posterior_study(write("study.toml", text)).description(); });
  }
  void copy(const std::string& file) const {
    std::filesystem::copy_file(examples + file, folder() / std::filesystem::path(file).filename());
  }
};

const char* const bearings = R"(
model = "formula"
[data]
file = "bearings.csv"
[data.columns]
life = "million_revolutions"
[likelihood.life]
family = "weibull"
scale = "eta"
shape = "beta"
)";

// Where the key stands, and once: whether it is the measured column's or the law's.
TEST_F(FormulaStudy, WhatIsWrongWithATextIsToldAtItsKey) {
  copy("life/bearings.csv");
  const std::string prior =
      "[prior]\neta = { distribution = \"flat\" }\nbeta = { distribution = \"flat\" }\n";
  std::string wrong = std::string(bearings) + prior;
  wrong.replace(wrong.find("\"eta\""), 5, "\"eta + wurk\"");
  EXPECT_THAT(refusal(wrong), HasSubstr("study.toml:9:9: likelihood.life.scale: 'wurk' is no"));
  wrong.replace(wrong.find("\"eta + wurk\""), 12, "\"twice\"");
  EXPECT_THAT(refusal(wrong + "[formula]\ntwice = \"eta + wurk\"\n"),
              HasSubstr("study.toml:15:9: formula.twice: 'wurk' is no"));
}

// Lieblein and Zelen (1956); Lawless (2003), Statistical Models and Methods for Lifetime Data: 2.1021,
// 81.88, -113.691. R's survreg gives 2.102059, 81.878334, -113.6913 (tests/golden/formula_model.R).
TEST_F(FormulaStudy, WeibullLivesOfBallBearingsAreThePublishedOnes) {
  copy("life/bearings.csv");
  const PosteriorSummary result =
      run(std::string(bearings) +
          "[prior]\neta = { distribution = \"flat\" }\nbeta = { distribution = \"flat\" }\n");
  ASSERT_EQ(result.mode->problem, "");
  EXPECT_NEAR(result.mode->parameters[0].value, 81.878334, 2e-6);
  EXPECT_NEAR(result.mode->parameters[1].value, 2.102059, 1e-6);
  EXPECT_NEAR(result.mode->log_likelihood, -113.6913, 5e-5);
  EXPECT_TRUE(result.mode->maximum_likelihood);
}

// Meeker and Escobar (1998), table C.2 and chapter 8: 27,719 km, shape 3.16, -123.995 with lives in km. A unit of the column
// moves a log density by its logarithm for each failure, and for nothing that is censored.
TEST_F(FormulaStudy, LogDensitiesAreOfDataInTheUnitOfTheTable) {
  const std::vector<std::pair<int, bool>> lives = {
      {6700, 1},  {6950, 0},  {7820, 0},  {8790, 0},  {9120, 1},  {9660, 0},  {9820, 0},
      {11310, 0}, {11690, 0}, {11850, 0}, {11880, 0}, {12140, 0}, {12200, 1}, {12870, 0},
      {13150, 1}, {13330, 0}, {13470, 0}, {14040, 0}, {14300, 1}, {17520, 1}, {17540, 0},
      {17890, 0}, {18450, 0}, {18960, 0}, {18980, 0}, {19410, 0}, {20100, 1}, {20100, 0},
      {20150, 0}, {20320, 0}, {20900, 1}, {22700, 1}, {23490, 0}, {26510, 1}, {27410, 0},
      {27490, 1}, {27890, 0}, {28100, 0}};
  const auto study = [&](const std::string& unit, double scale) {
    std::string csv = "life [" + unit + "],status\n";
    for (const auto& [life, failed] : lives)
      csv += fmt::format("{},{}\n", scale * life, failed ? "failure" : "runout");
    write("lives.csv", csv);
    return run(fmt::format(R"toml(
model = "formula"
[data]
file = "lives.csv"
[data.columns]
life = "life"
status = "status"
[likelihood.life]
family = "weibull"
scale = "eta"
shape = "beta"
[prior]
eta = {{ distribution = "uniform", lower = "1e3 km", upper = "1e6 km" }}
beta = {{ distribution = "uniform", lower = 0.1, upper = 20 }}
)toml"));
  };
  const PosteriorSummary km = study("km", 1), mega = study("Mm", 1e-3);
  ASSERT_EQ(km.mode->problem, "");
  EXPECT_EQ(km.mode->density_unit, "km");
  EXPECT_NEAR(km.mode->log_likelihood, -123.995361, 2e-6);
  EXPECT_NEAR(km.mode->aic, 4 + 2 * 123.995361, 4e-6);
  EXPECT_NEAR(km.mode->bic, 2 * std::log(38.0) + 2 * 123.995361, 4e-6);
  const double moved = 11 * std::log(1e3);
  EXPECT_NEAR(mega.mode->log_likelihood, km.mode->log_likelihood + moved, 1e-6);
  EXPECT_NEAR(mega.loo->loo.elpd(), km.loo->loo.elpd() + moved, 1e-3);
  EXPECT_NEAR(*mega.log_evidence, *km.log_evidence + moved, 1e-3);
  EXPECT_NEAR(mega.loo->loo.p_loo(), km.loo->loo.p_loo(), 1e-3);
  for (std::size_t i = 0; i < lives.size(); ++i)
    EXPECT_NEAR(mega.loo->loo.terms[i].elpd - km.loo->loo.terms[i].elpd,
                lives[i].second ? std::log(1e3) : 0, 1e-3)
        << i;
}

// Rows that stand for many, under a posterior that is improper, so that nothing is left out.
TEST_F(FormulaStudy, BicCountsObservationsNotRows) {
  write("tubes.csv", "from,to,count\n0,1,5\n1,2,16\n2,3,12\n3,,267\n");
  const PosteriorSummary result = run(R"toml(
model = "formula"
[data]
file = "tubes.csv"
[data.columns]
lower = "from"
upper = "to"
count = "count"
[likelihood.life]
family = "weibull"
scale = "eta"
shape = "beta"
[prior]
eta = { distribution = "flat" }
beta = { distribution = "flat" }
)toml");
  ASSERT_EQ(result.mode->problem, "");
  EXPECT_EQ(result.mode->observations, 300);
  EXPECT_NEAR(result.mode->bic, -2 * result.mode->log_likelihood + 2 * std::log(300.0), 1e-9);
}

// Meeker and Escobar (1998), table 19.1: -13.469 (2.887), 0.6279 (0.08287), 0.9778 (0.1326), -321.7.
TEST_F(FormulaStudy, ArrheniusLivesWithManyRunoutsAreThePublishedOnes) {
  copy("accelerated/device_a.csv");
  const PosteriorSummary result = run(R"toml(
model = "formula"
[data]
file = "device_a.csv"
[data.columns]
life = "hours"
temperature = { column = "temperature_C", unit = "degC" }
status = "status"
count = "count"
[formula]
mu = "b0 + b1 * 11605 [K] / temperature"
[likelihood.life]
family = "lognormal"
median = "exp(mu)"
log_sd = "sigma"
[prior]
b0 = { distribution = "flat" }
b1 = { distribution = "flat" }
sigma = { distribution = "flat" }
)toml");
  ASSERT_EQ(result.mode->problem, "");
  EXPECT_NEAR(result.mode->parameters[0].value, -13.4686, 5e-4);
  EXPECT_NEAR(result.mode->parameters[0].standard_error, 2.8872, 5e-3);
  EXPECT_NEAR(result.mode->parameters[1].value, 0.6279, 5e-5);
  EXPECT_NEAR(result.mode->parameters[2].value, 0.978, 5e-4);
  EXPECT_NEAR(result.mode->log_likelihood, -321.7, 0.05);
}

const char* const product = R"(
model = "formula"
[data]
file = "d.csv"
[data.columns]
y = { column = "y", unit = "um" }
x = { column = "x", unit = "km" }
[likelihood.y]
family = "normal"
mean = "k1 * k2 * x"
sd = "sigma"
[prior]
k1 = { distribution = "lognormal", median = "1 um/km", log_sd = 1 }
k2 = { distribution = "lognormal", median = 1, log_sd = 1 }
sigma = { distribution = "half-normal", scale = "2 um" }
)";

TEST_F(FormulaStudy, WhatTheDataCannotTellApartIsNamedAndNotTrusted) {
  write("d.csv", "x,y\n1,2.1\n2,3.9\n3,6.2\n4,8.0\n5,9.8\n");
  const PosteriorSummary result = run(product);
  EXPECT_FALSE(result.trusted);
  const auto check = std::find_if(result.checks.begin(), result.checks.end(),
                                  [](const Check& each) { return each.name == "identified"; });
  ASSERT_NE(check, result.checks.end());
  EXPECT_EQ(check->verdict, Verdict::fail);
  EXPECT_NE(check->detail.find("k1 and k2 separately: with k1 up by 1 % and k2 down by 1 %"),
            std::string::npos)
      << check->detail;
}

// The example of the documentation: lives of a new machine and of each one seen. Of a straight path the
// life is limit * area / (k force); by the posterior's draws of k and k_scatter it can be had otherwise.
TEST_F(FormulaStudy, LivesOfMachinesThatDiffer) {
  const PosteriorStudy study = wearwell::read_posterior_study(examples + "formula/study.toml");
  const PosteriorSummary result = run_study(study, {Method::exact, 1, {}, 4000, {}}, {}, false);
  ASSERT_EQ(result.quantities.size(), 22u);  // of them 8 paths ahead of machines at 50 km
  EXPECT_EQ(result.quantities[0].name, "mean_over_median");
  const QuantitySummary& life = result.quantities[1];
  EXPECT_EQ(life.name, "life");
  EXPECT_EQ(life.of, "new machine");
  EXPECT_EQ(life.unit, "km");
  EXPECT_EQ(result.quantities[2].name, "remaining useful life");
  EXPECT_EQ(result.quantities[2].of, "machine 1");
  // P(life <= q) over the exact posterior, with the normal law of log life written out.
  const Chain& chain = result.posterior_draws.front();
  for (const auto& [q, p] : {std::pair(life.best().q05, 0.05), std::pair(life.best().q50, 0.5),
                             std::pair(life.best().q95, 0.95)}) {
    double sum = 0;
    for (Eigen::Index i = 0; i < chain.values.rows(); ++i) {
      // 100 um * 50 mm^2 / (k * 20 N), k in mm^3/(N m): 0.25 m / k -> km.
      const double middle = 0.25e-3 / chain.values(i, 0), scatter = chain.values(i, 2);
      sum += 0.5 * std::erfc(-std::log(q / middle) / (scatter * std::sqrt(2.0)));
    }
    EXPECT_NEAR(sum / static_cast<double>(chain.values.rows()), p, 0.012);
  }
}

// A unit in the heading is that of the column, as in every other trade; a plain column has none.
// A car's shock absorber lives through 28,000 km, and a wear depth of 28 m is of no machine.
TEST_F(FormulaStudy, ALifeMayBeAWayAndADepthIsASize) {
  write("lives.csv", "way [km]\n6700\n9120\n28100\n");
  const std::string life =
      "[data.columns]\nlife = \"way\"\n[likelihood.life]\nfamily = \"exponential\"\nmean = \"m\"\n";
  const std::string prior =
      "[prior]\nm = { distribution = \"lognormal\", median = \"1e4 km\", log_sd = 1 }\n";
  const auto units = [](const PosteriorSummary& summary) {
    return std::any_of(summary.checks.begin(), summary.checks.end(),
                       [](const Check& check) { return check.name == "units"; });
  };
  EXPECT_FALSE(units(run("model = \"formula\"\n[data]\nfile = \"lives.csv\"\n" + life + prior)));
  write("depths.csv", "way [km],depth [m]\n10,9\n20,17\n30,28\n");
  EXPECT_TRUE(units(run(R"(model = "formula"
[data]
file = "depths.csv"
[data.columns]
way = "way"
depth = "depth"
[likelihood.depth]
family = "normal"
mean = "k * way"
sd = "0.2 [m]"
[prior]
k = { distribution = "lognormal", median = 1e-3, log_sd = 1 }
[predict]
along = "way"
at = ["40 km"]
)")));
}

TEST_F(FormulaStudy, UnitsStandInHeadingsToo) {
  write("wear.csv", "d [um],s [km],corrected [yes]\n1.1,1,1\n1.9,2,1\n3.2,3,2\n");
  const char* const named_flag = "{ column = \"corrected [yes]\", unit = \"1\" }";
  const auto study = [&](const char* depth, const char* path, const char* flag) {
    return fmt::format(R"toml(
model = "formula"
[data]
file = "wear.csv"
[data.columns]
depth = {}
path = {}
flag = {}
[likelihood.depth]
family = "normal"
mean = "k*path*flag^0"
sd = "sigma"
[prior]
k = {{ distribution = "half-normal", scale = "1 um/km" }}
sigma = {{ distribution = "half-normal", scale = "1 um" }}
)toml",
                       depth, path, flag);
  };
  const char* const named_depth = "{ column = \"d [um]\", unit = \"um\" }";
  const char* const named_path = "{ column = \"s [km]\", unit = \"km\" }";
  const PosteriorSummary said = run(study(named_depth, named_path, named_flag));
  const PosteriorSummary read = run(study("\"d [um]\"", "\"s\"", named_flag));
  EXPECT_EQ(said.parameters[0].exact->mean, read.parameters[0].exact->mean);
  EXPECT_EQ(said.data_fingerprint, read.data_fingerprint);
  EXPECT_NEAR(read.parameters[0].exact->mean, 1.02, 0.1);
  const std::string refused =
      refusal(study(named_depth, "{ column = \"s [km]\", unit = \"m\" }", named_flag));
  EXPECT_NE(refused.find("'s [km]' is in km by its heading, and m is given"), std::string::npos)
      << refused;
  // What stands in brackets is a unit, unless the study states it.
  const std::string remark = refusal(study(named_depth, named_path, "\"corrected [yes]\""));
  EXPECT_NE(remark.find("column 'corrected [yes]': 'yes' is not a unit"), std::string::npos)
      << remark;
  EXPECT_NE(remark.find("flag = { column = \"corrected [yes]\", unit = \"1\" }"), std::string::npos)
      << remark;
}

// Lasers of Meeker and Escobar (1998), straight paths: what is known of a path ahead is what is known of
// the remaining useful life, seen along the other axis.
TEST_F(FormulaStudy, PathsAheadAndRemainingLivesAreOneThing) {
  const PosteriorStudy study = wearwell::read_posterior_study(examples + "degradation/lines.toml");
  // With fewer draws each laser would be left out in earnest.
  const PosteriorSummary result = run_study(study, {Method::exact, 1, {}, 2000, {}}, {}, true);
  const auto found = [&](const std::string& name, const std::string& of) {
    for (const QuantitySummary& each : result.quantities) {
      if (each.name == name && each.of == of) return each.best();
    }
    ADD_FAILURE() << name << " of " << of;
    return QuantityQuantiles();
  };
  for (const char* laser : {"laser 3", "laser 7", "laser 13"}) {
    const QuantityQuantiles path = found("increase", laser);
    const QuantityQuantiles life = found("remaining useful life", laser);
    EXPECT_NEAR(path.q05, 10 * 5000 / (4000 + life.q95), 5e-3) << laser;
    EXPECT_NEAR(path.q50, 10 * 5000 / (4000 + life.q50), 5e-3) << laser;
    EXPECT_NEAR(path.q95, 10 * 5000 / (4000 + life.q05), 5e-3) << laser;
  }
  EXPECT_EQ(found("remaining useful life", "laser 10").q95, 0);  // 12.21 % at 4000 h
  // A figure of a new laser and one of each, with its readings and the limit.
  const auto& figures = result.plots->figures.at("predictions");
  ASSERT_EQ(figures.size(), 15u);
  EXPECT_EQ(figures[14].title, "Laser 15");
  EXPECT_EQ(result.plots->figures.at("verdict").back().title, "New laser");
  const std::string text = figures[14].specification.dump();
  EXPECT_NE(text.find("6.62"), std::string::npos);
  // The limit: a rule at 10 %.
  EXPECT_NE(text.find(R"("values":"y\n10")"), std::string::npos);
}

TEST_F(FormulaStudy, WrongStudiesAreRefusedWithTheirPlace) {
  write("d.csv", "x,y\n1,2.1\n2,3.9\n");
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = product;
    text.replace(text.find(from), from.size(), to);
    return refusal(text);
  };
  EXPECT_NE(changed("k1 * k2 * x\"", "k1 * k2\"").find("mean"), std::string::npos);
  EXPECT_NE(changed("[likelihood.y]", "[likelihood.z]").find("nearest: "), std::string::npos);
  EXPECT_NE(changed("sd = \"sigma\"", "").find("normal needs mean and sd"), std::string::npos);
  EXPECT_NE(changed("k2 * x", "k3 * x").find("k3"), std::string::npos);
  EXPECT_NE(changed("mean = \"k1 * k2 * x\"", "mean = \"k1 * x\"").find("k2"), std::string::npos);
}

}  // namespace
}  // namespace wearwell
