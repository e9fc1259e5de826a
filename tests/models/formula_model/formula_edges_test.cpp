// Studies at the edge of what data tell: readings without a range, nothing observed, columns that no key names.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/posterior_study.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/study/answers.h"
#include "wearwell/study/run_study.h"

namespace wearwell {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class FormulaEdges : public ScratchTest {
 protected:
  PosteriorSummary run(const std::string& table, const std::string& study,
                       bool with_plots = false) const {
    write("d.csv", table);
    return run_study(wearwell::read_posterior_study(write("study.toml", study)),
                     {Method::exact, 1, {}, 50, {}}, {}, with_plots);
  }
  std::string refusal(const std::string& table, const std::string& study) const {
    write("d.csv", table);
    return message_of<InputError>(
        [&] { wearwell::read_posterior_study(write("study.toml", study)).description(); });
  }
};

const Check* find(const PosteriorSummary& result, const std::string& name) {
  const auto at = std::find_if(result.checks.begin(), result.checks.end(),
                               [&](const Check& each) { return each.name == name; });
  return at == result.checks.end() ? nullptr : &*at;
}

const char* const lives = R"(
model = "formula"
[data]
file = "d.csv"
[data.columns]
life = { column = "hours", unit = "h" }
[likelihood.life]
family = "weibull"
scale = "eta"
shape = "beta"
[prior]
eta = { distribution = "lognormal", median = "1000 h", log_sd = 1 }
beta = { distribution = "lognormal", median = 2, log_sd = 0.5 }
[predict]
b_lives = [10]
)";

// A normal mean k x under a normal prior is normal: precision 1 + 14, mean 0.
TEST_F(FormulaEdges, ReadingsThatAreAllZeroAreFittedAndDrawn) {
  const PosteriorSummary result = run("x,y\n1,0\n2,0\n3,0\n", R"(
model = "formula"
[data]
file = "d.csv"
[data.columns]
x = "x"
y = "y"
[likelihood.y]
family = "normal"
mean = "k*x"
sd = "1"
[prior]
k = { distribution = "normal", mean = 0, sd = 1 }
)",
                                      true);
  EXPECT_NEAR(result.parameters[0].best().mean, 0, 1e-6);
  EXPECT_NEAR(result.parameters[0].best().sd, 1 / std::sqrt(15), 1e-5);
  const auto paper = result.plots->figures.at("verdict").front().specification;
  bool drawn = false;
  for (const auto& layer : paper["layer"]) {
    if (!layer["encoding"].contains("x")) continue;
    const auto& scale = layer["encoding"]["x"]["scale"];
    EXPECT_LT(scale.at("domainMin").get<double>(), scale.at("domainMax").get<double>());
    drawn = true;
  }
  EXPECT_TRUE(drawn);
}

// Two units under flat priors of their mean and scatter: improper (Gelman 2006).
TEST_F(FormulaEdges, AnImproperPosteriorOfTwoUnitsIsRefusedNotACrash) {
  const PosteriorSummary result =
      run("m,x,y\na,1,1\na,2,2.1\na,3,3.2\nb,1,2\nb,2,4.1\nb,3,5.9\n", R"(
model = "formula"
[data]
file = "d.csv"
[data.columns]
m = "m"
x = "x"
y = "y"
[likelihood.y]
family = "normal"
mean = "k*x"
sd = "0.1"
[random_effects.m]
k = { distribution = "normal", sd = "tau" }
[prior]
k = { distribution = "flat" }
tau = { distribution = "flat" }
)",
          true);
  EXPECT_FALSE(result.trusted);
  ASSERT_NE(find(result, "proper-posterior"), nullptr);
  EXPECT_EQ(find(result, "proper-posterior")->verdict, Verdict::fail);
}

TEST_F(FormulaEdges, WithoutAFailureTheAnswersAndAChecksSayThatThePriorCarriesTheLives) {
  std::string study = lives;
  study.replace(study.find("[likelihood"), 0, "status = \"status\"\n");
  const PosteriorSummary result = run("hours,status\n500,runout\n700,runout\n900,S\n", study);
  const Check* check = find(result, "no-failures");
  ASSERT_NE(check, nullptr);
  EXPECT_EQ(check->verdict, Verdict::warn);
  EXPECT_THAT(check->detail, HasSubstr("no failure was observed among 3"));
  EXPECT_THAT(check->detail, HasSubstr("rests on the prior"));
  EXPECT_THAT(answers(result, Script::terminal).front(), HasSubstr("no failure was observed"));
  // One failure, and it is not said.
  const PosteriorSummary one = run("hours,status\n500,runout\n700,F\n900,S\n", study);
  EXPECT_EQ(find(one, "no-failures"), nullptr);
  EXPECT_THAT(answers(one, Script::terminal).front(), Not(HasSubstr("was observed")));
}

TEST_F(FormulaEdges, WithoutWearTheAnswersSaySo) {
  const std::string study = R"(
model = "formula"
[data]
file = "d.csv"
[data.columns]
time = { column = "t", unit = "h" }
depth = { column = "w", unit = "um" }
[formula]
wear = "k*time"
[likelihood.depth]
family = "normal"
mean = "wear"
sd = "1 [um]"
[prior]
k = { distribution = "lognormal", median = "0.01 um/h", log_sd = 1 }
[predict]
along = "time"
limit = { wear = "80 um" }
)";
  EXPECT_NE(find(run("t,w\n10,0\n20,0\n40,0\n", study), "no-wear"), nullptr);
  EXPECT_EQ(find(run("t,w\n10,0\n20,0\n40,0.4\n", study), "no-wear"), nullptr);
}

TEST_F(FormulaEdges, AColumnThatLooksLikeAStatusIsRefusedUntilTheStudySaysWhichItIs) {
  const std::string table = "hours,event\n500,0\n700,1\n900,0\n";
  EXPECT_THAT(refusal(table, lives), AllOf(HasSubstr("'event'"), HasSubstr("status = \"event\""),
                                           HasSubstr("unused = [\"event\"]")));
  std::string as_status = lives, unused = lives;
  as_status.replace(as_status.find("[likelihood"), 0, "status = \"event\"\n");
  unused.replace(unused.find("[data.columns]"), 0, "unused = [\"event\"]\n");
  // Of one failure and two run-outs lives are longer.
  const double longer = run(table, as_status).parameters[0].best().mean;
  EXPECT_GT(longer, 1.2 * run(table, unused).parameters[0].best().mean);
}

// A study of lives under flat priors, which nobody cut.
std::string flat_study(const std::string& family, const std::string& columns) {
  return R"(
model = "formula"
[data]
file = "d.csv"
[data.columns]
)" + columns +
         (family == "weibull"
              ? "[likelihood.life]\nfamily = \"weibull\"\nscale = \"a\"\nshape = \"b\"\n"
              : "[likelihood.life]\nfamily = \"lognormal\"\nmedian = \"a\"\nlog_sd = \"b\"\n") +
         "[prior]\na = { distribution = \"flat\", unit = \"h\" }\nb = { distribution = \"flat\" "
         "}\n";
}

struct FlatLives {
  const char *family, *table;
  double a, b, log_likelihood, a_low, a_high, b_low, b_high;
};

// Maximum likelihood and 90 % profile intervals by R (tests/golden/interval_lives.R); the tubes are those of Meeker and Escobar (1998),
// example 1.5. Under flat priors of both the posterior is improper: its density falls like a power of log a.
TEST_F(FormulaEdges, IntervalsUnderFlatPriorsHaveTheirMaximumAndItsProfileAndAreImproper) {
  const char* const few = "lo,hi,n\n0,10,1\n10,20,3\n20,30,2\n30,40,1\n40,,1\n";
  const char* const tubes = "lo,hi,n\n,1,5\n1,2,7\n2,3,9\n3,,279\n";
  const FlatLives all[] = {
      {"weibull", few, 25.93614, 1.856201, -12.09852, 17.44935, 38.99749, 0.9769653, 3.07338},
      {"weibull", tubes, 20.75807, 1.356271, -98.60312, 10.71235, 65.66223, 0.8687059, 2.006379},
      {"lognormal", few, 19.9963, 0.6023926, -11.95341, 13.06718, 30.32637, 0.3808795, 1.1129},
      {"lognormal", tubes, 33.49342, 1.633881, -98.67809, 15.15188, 131.913, 1.144944, 2.478041}};
  for (const FlatLives& each : all) {
    const PosteriorSummary result =
        run(each.table, flat_study(each.family,
                                   "lower = { column = \"lo\", unit = \"h\" }\nupper = { "
                                   "column = \"hi\", unit = \"h\" }\ncount = \"n\"\n"));
    const std::string where = std::string(each.family) + " " + each.table;
    ASSERT_EQ(result.mode->problem, "") << where;
    const auto& mode = result.mode->parameters;
    EXPECT_NEAR(mode[0].value / each.a, 1, 1e-5) << where;
    EXPECT_NEAR(mode[1].value / each.b, 1, 1e-5) << where;
    EXPECT_NEAR(result.mode->log_likelihood, each.log_likelihood, 1e-5) << where;
    ASSERT_TRUE(mode[0].profile && mode[1].profile) << where;
    EXPECT_NEAR(mode[0].profile->lower / each.a_low, 1, 1e-4) << where;
    EXPECT_NEAR(mode[0].profile->upper / each.a_high, 1, 1e-4) << where;
    EXPECT_NEAR(mode[1].profile->lower / each.b_low, 1, 1e-4) << where;
    EXPECT_NEAR(mode[1].profile->upper / each.b_high, 1, 1e-4) << where;
    ASSERT_NE(find(result, "proper-posterior"), nullptr);
    EXPECT_EQ(find(result, "proper-posterior")->verdict, Verdict::fail) << where;
    EXPECT_THAT(find(result, "proper-posterior")->detail, HasSubstr("improper")) << where;
    EXPECT_FALSE(result.trusted);
  }
}

// Controls of locomotives: Nelson (1982); Lawless (2003), table 5.1: lognormal mu 5.117, sigma 0.705.
TEST_F(FormulaEdges, LocomotiveControlsHaveOneMode) {
  std::string table = "hours,status,n\n";
  for (const char* each :
       {"22.5", "37.5",  "46",  "48.5",  "51.5",  "53",    "54.5", "57.5", "66.5",  "68",
        "69.5", "76.5",  "77",  "78.5",  "80",    "81.5",  "82",   "83",   "84",    "91.5",
        "93.5", "102.5", "107", "108.5", "112.5", "113.5", "116",  "117",  "118.5", "119",
        "120",  "122.5", "123", "127.5", "131",   "132.5", "134"})
    table += std::string(each) + ",F,1\n";
  table += "135,S,59\n";
  for (const char* family : {"weibull", "lognormal"}) {
    const PosteriorSummary result =
        run(table, flat_study(family,
                              "life = { column = \"hours\", unit = \"h\" }\nstatus = "
                              "\"status\"\ncount = \"n\"\n"));
    ASSERT_EQ(result.mode->problem, "");
    if (family == std::string("lognormal")) {
      EXPECT_NEAR(std::log(result.mode->parameters[0].value), 5.117, 5e-4);
      EXPECT_NEAR(result.mode->parameters[1].value, 0.705, 1e-3);
    }
    EXPECT_EQ(find(result, "computation")->detail.find("exists between the nodes"),
              std::string::npos)
        << family;
    EXPECT_THAT(find(result, "computation")->advice, Not(HasSubstr("more than one mode")));
  }
}

}  // namespace
}  // namespace wearwell
