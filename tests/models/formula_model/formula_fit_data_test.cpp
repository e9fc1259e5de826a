// Whether the check of fit sees what units that differ cannot be, and lets pass what they are.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/posterior_study.h"
#include "support/scratch.h"
#include "wearwell/base/rng.h"
#include "wearwell/study/run_study.h"

namespace wearwell {
namespace {

struct Truth {
  double scatter = 0.15;
  double power = 1;     // of time
  double wander = 0;    // a random walk about the path, a step
  double outsider = 0;  // how many scatters further out the last unit is
  double noise = 0.1;
};

class FormulaFit : public ScratchTest {
 protected:
  static constexpr int units = 10, readings = 8;

  void simulate(const Truth& truth, std::uint64_t seed) const {
    Rng rng(seed, 0);
    std::string text = "m,t,y\n";
    for (int u = 0; u < units; ++u) {
      const double z = rng.normal() + (u + 1 == units ? truth.outsider : 0);
      const double rate = std::exp(truth.scatter * z);
      double away = 0;
      for (int k = 1; k <= readings; ++k) {
        away += truth.wander * rng.normal();
        const double y = rate * 3 * std::pow(k / 3.0, truth.power) + away;
        text += fmt::format("{},{},{:.6f}\n", u + 1, k, y + truth.noise * rng.normal());
      }
    }
    write("d.csv", text);
  }

  Check fit(const std::string& family = "normal",
            const std::string& family_parameters = "sd = \"sigma\"",
            bool random_effects = true) const {
    std::string text = fmt::format(R"(
model = "formula"
[data]
file = "d.csv"
[data.columns]
y = "y"
t = "t"
m = "m"
[likelihood.y]
family = "{}"
mean = "k*t"
{}
[prior]
k = {{ distribution = "lognormal", median = 1, log_sd = 1 }}
sigma = {{ distribution = "half-normal", scale = 1 }}
[predict]
along = "t"
)",
                                   family, family_parameters);
    if (random_effects) {
      text.replace(text.find("[predict]"), 0,
                   R"(scatter = { distribution = "half-normal", scale = 0.5 }
[random_effects.m]
k = { distribution = "lognormal", log_sd = "scatter" }
)");
    }
    const PosteriorSummary result =
        run_study(wearwell::read_posterior_study(write("study.toml", text)),
                  {Method::exact, 1, {}, 400, {}}, {}, false);
    for (const Check& each : result.checks) {
      if (each.name == "fit") return each;
    }
    ADD_FAILURE() << "no check of fit";
    return {};
  }
};

TEST_F(FormulaFit, UnitsAsTheLawSaysPass) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    simulate({}, seed);
    const Check check = fit();
    EXPECT_EQ(check.verdict, Verdict::pass) << check.detail;
  }
}

TEST_F(FormulaFit, APathThatIsBentFails) {
  simulate({.power = 1.3}, 4);
  const Check check = fit();
  EXPECT_EQ(check.verdict, Verdict::fail);
  EXPECT_NE(check.detail.find("along t"), std::string::npos) << check.detail;
}

TEST_F(FormulaFit, UnitsThatWanderFail) {
  simulate({.wander = 0.3, .noise = 0.02}, 5);
  const Check check = fit();
  EXPECT_EQ(check.verdict, Verdict::fail);
  EXPECT_NE(check.detail.find("neighbours within one unit are correlated"), std::string::npos)
      << check.detail;
}

TEST_F(FormulaFit, AUnitFarOutsideIsNamed) {
  simulate({.outsider = 11}, 6);
  const Check check = fit();
  EXPECT_NE(check.verdict, Verdict::pass);
  EXPECT_NE(check.detail.find("m 10 is an outlier in k"), std::string::npos) << check.detail;
}

// Each step in the light of those before it.
TEST_F(FormulaFit, StepsOfAProcessAreJudged) {
  // Rates that differ, taken for steps alone: what a unit has grown by tells of its next step.
  simulate({.wander = 0.02, .noise = 0}, 7);
  const Check alike = fit("wiener-process", "sd = \"sigma*sqrt(t)\"", false);
  EXPECT_EQ(alike.verdict, Verdict::fail);
  EXPECT_NE(alike.detail.find("neighbours within one unit are correlated"), std::string::npos)
      << alike.detail;
  simulate({.scatter = 0, .wander = 0.2, .noise = 0}, 8);
  const Check right = fit("wiener-process", "sd = \"sigma*sqrt(t)\"", false);
  EXPECT_EQ(right.verdict, Verdict::pass) << right.detail;
}

// Two columns of the same units, of which one is not as the law says.
TEST_F(FormulaFit, AllMeasuredColumnsAreJudged) {
  const auto check = [&](double power) {
    Rng rng(9, 0);
    std::string text = "m,t,y,w\n";
    for (int u = 1; u <= 6; ++u) {
      for (int t = 1; t <= 6; ++t) {
        const std::string w =
            t == 2 ? "" : fmt::format("{:.6f}", 3 * std::pow(t / 3.0, power) + 0.1 * rng.normal());
        text += fmt::format("{},{},{:.6f},{}\n", u, t, t + 0.1 * rng.normal(), w);
      }
    }
    write("d.csv", text);
    const auto file = write("study.toml", R"(
model = "formula"
[data]
file = "d.csv"
[data.columns]
y = "y"
w = "w"
t = "t"
[likelihood.y]
family = "normal"
mean = "k*t"
sd = "sigma"
[likelihood.w]
family = "normal"
mean = "k*t"
sd = "sigma"
[prior]
k = { distribution = "lognormal", median = 1, log_sd = 1 }
sigma = { distribution = "half-normal", scale = 1 }
)");
    const PosteriorSummary result =
        run_study(wearwell::read_posterior_study(file), {Method::exact, 1, {}, 400, {}}, {}, false);
    for (const Check& each : result.checks) {
      if (each.name == "fit") return each;
    }
    ADD_FAILURE() << "no check of fit";
    return Check{};
  };
  const Check right = check(1), bent = check(1.3);
  EXPECT_EQ(right.verdict, Verdict::pass) << right.detail;
  EXPECT_EQ(bent.verdict, Verdict::fail) << bent.detail;
}

}  // namespace
}  // namespace wearwell
