// What the checks say of S-N studies whose priors leave the posterior open.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "support/posterior_study.h"
#include "support/scratch.h"
#include "wearwell/study/run_study.h"

namespace wearwell {
namespace {

using testing::HasSubstr;

// All nine tests of Heo et al. (2011).
constexpr const char* data = R"(type,mean,alternating,life
A,1005.5,271.1,0.700
B,1049.0,279.8,1.153
C,1025.8,285.9,0.855
D,1048.7,276.8,0.820
E,1070.4,265.4,1.020
F,1116.5,242.0,0.849
G,1150.7,259.7,1.279
G,1150.7,259.7,1.153
G,1150.7,259.7,1.172
)";

class SnTrust : public ScratchTest {
 protected:
  PosteriorSummary run(const std::string& family, const std::string& prior) {
    write("lives.csv", data);
    const auto study = write("study.toml", R"(
model = "sn"
[data]
file = "lives.csv"
[data.columns]
label              = "type"
mean_stress        = { column = "mean", unit = "MPa" }
alternating_stress = { column = "alternating", unit = "MPa" }
life               = { column = "life", unit = "1e5" }
[law]
mean_stress = "goodman"
[likelihood]
family = ")" + family + "\"\n[prior]\n" + prior);
    return run_study(read_posterior_study(study), {}, {.threads = 2});
  }
};

Check check(const PosteriorSummary& result, const std::string& name) {
  for (const Check& each : result.checks) {
    if (each.name == name) return each;
  }
  ADD_FAILURE() << "no check " << name;
  return {};
}

// The paper's likelihood as printed: normal on the life itself. As a falls the predicted life goes
// to zero and the likelihood stops falling, at any sigma that is allowed.
TEST_F(SnTrust, NormalScatterOfLifeAsPrintedIsImproperUnderFlatPriors) {
  const PosteriorSummary bounded_sigma = run("normal", R"toml(
log10_a   = { distribution = "flat", unit = "log10(MPa)" }
b         = { distribution = "uniform", lower = -0.1, upper = -0.06 }
log10_Sut = { distribution = "uniform", lower = "3.1 log10(MPa)", upper = "5.2 log10(MPa)" }
sigma     = { distribution = "uniform", lower = "0.01e5", upper = "6e5" }
)toml");
  const Check improper = check(bounded_sigma, "proper-posterior");
  EXPECT_EQ(improper.verdict, Verdict::fail);
  EXPECT_THAT(improper.detail, HasSubstr("the posterior is improper: log10_a towards minus "
                                         "infinity"));
  EXPECT_THAT(improper.detail, HasSubstr("whose integral is infinite; every number depends on "
                                         "where it is truncated"));
  EXPECT_THAT(improper.advice, HasSubstr("The data alone do not determine log10_a"));
  EXPECT_THAT(
      improper.advice,
      HasSubstr("log10_a = { distribution = \"normal\", mean = \"... log10(MPa)\", sd = ... }"));
  EXPECT_FALSE(bounded_sigma.trusted);
  EXPECT_FALSE(bounded_sigma.loo);

  const PosteriorSummary all_flat = run("normal", R"toml(
log10_a   = { distribution = "flat", unit = "log10(MPa)" }
b         = { distribution = "flat" }
log10_Sut = { distribution = "flat", lower = "3.1 log10(MPa)", unit = "log10(MPa)" }
sigma     = { distribution = "flat" }
)toml");
  EXPECT_EQ(check(all_flat, "proper-posterior").verdict, Verdict::fail);
  EXPECT_THAT(check(all_flat, "proper-posterior").detail, HasSubstr("improper"));
  EXPECT_FALSE(all_flat.trusted);
}

// Doubling the bound of S_ut is examined, not given up: the wider posterior starts far from its
// mode, where a search along the gradient fails.
TEST_F(SnTrust, TheCutOfEveryBoundIsExamined) {
  const PosteriorSummary result = run("log10-normal", R"toml(
log10_a   = { distribution = "uniform", lower = "2 log10(MPa)", upper = "4 log10(MPa)" }
b         = { distribution = "uniform", lower = -0.1, upper = -0.06 }
log10_Sut = { distribution = "uniform", lower = "3.1 log10(MPa)", upper = "5.2 log10(MPa)" }
sigma     = { distribution = "uniform", lower = 0.01, upper = 0.6 }
)toml");
  const Check cut = check(result, "prior-bounds");
  EXPECT_EQ(cut.verdict, Verdict::warn);
  EXPECT_THAT(
      cut.detail,
      HasSubstr("with the bounds of log10_Sut at twice the distance from its mean, the mean "
                "of log10_Sut goes from 4.145"));
  EXPECT_THAT(cut.detail, testing::Not(HasSubstr("cannot be integrated")));
  ASSERT_TRUE(result.mode);
  EXPECT_EQ(result.mode->parameters[1].at, "lower bound");
  EXPECT_EQ(result.mode->parameters[1].value, -0.1);
  EXPECT_TRUE(result.mode->maximum_likelihood);
  EXPECT_EQ(result.mode->observations, 9);
}

// All fail at 350 MPa and above, none below: a limit of no scatter between is as likely as any, and where it lies there no
// likelihood tells. Rounding decides whether the search for a mode in the parameters' own units converges; draws and what follows from
// them are right (StageDiagnostics.ASearchThatFellShort).
TEST_F(SnTrust, APlateauOfTheModeIsNoFault) {
  std::string rows = "stress,life,status\n";
  for (const char* life : {"466403", "565114", "563498", "1430162", "1182787"})
    rows += fmt::format("400,{},F\n", life);
  for (const char* life : {"9942583", "17605251", "8492652", "4853881", "7291320"})
    rows += fmt::format("350,{},F\n", life);
  for (const char* stress : {"320", "320", "320", "320", "320", "320", "300", "300", "300", "280"})
    rows += fmt::format("{},2e7,S\n", stress);
  write("lives.csv", rows);
  const auto study = write("study.toml", R"toml(
model = "sn"
[data]
file = "lives.csv"
[data.columns]
alternating_stress = { column = "stress", unit = "MPa" }
life = "life"
status = "status"
[law]
mean_stress = "none"
fatigue_limit = "random"
[likelihood]
family = "log10-normal"
[prior]
log10_a       = { distribution = "normal", mean = "3 log10(MPa)", sd = 0.5 }
b             = { distribution = "normal", mean = -0.15, sd = 0.1 }
sigma         = { distribution = "half-normal", scale = 0.5 }
log10_limit   = { distribution = "normal", mean = "2.4 log10(MPa)", sd = 0.1 }
sigma_limit   = { distribution = "half-normal", scale = 0.1 }
)toml");
  const PosteriorSummary result = run_study(read_posterior_study(study), {}, {.threads = 2});
  ASSERT_TRUE(result.mode);
  const Check computation = check(result, "computation");
  EXPECT_NE(computation.verdict, Verdict::fail) << computation.detail;
  if (!result.mode->problem.empty()) {
    EXPECT_THAT(computation.detail, HasSubstr("the draws do not miss mass"));
  }
  EXPECT_TRUE(result.trusted);
}

}  // namespace
}  // namespace wearwell
