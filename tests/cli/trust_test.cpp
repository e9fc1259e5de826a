// Data that contradict their law, priors that data exclude, limits that are passed: `wearwell fit`
// must not trust, and must trust what is right.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "support/run_command.h"
#include "support/scratch.h"
#include "wearwell/base/rng.h"

namespace wearwell {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using Pairs = std::vector<std::pair<double, double>>;

class Trust : public ScratchTest {
 protected:
  json fit(const std::string& study) {
    const auto file = write("study.toml", study);
    const CommandResult run = run_wearwell("fit '" + file.string() +
                                           "' --json --no-report --method exact --draws 500 -o '" +
                                           (folder() / "out").string() + "'");
    EXPECT_LE(run.exit_code, 1) << run.err;
    json result = json::parse(run.out);
    EXPECT_EQ(run.exit_code, result["trusted"] ? 0 : 1);
    return result;
  }

  std::string table(const std::string& head, const Pairs& rows) {
    std::string text = head + "\n";
    for (const auto& [x, y] : rows) text += fmt::format("{},{}\n", x, y);
    return write("data.csv", text).filename().string();
  }

  // The joint of the tutorial, by cycles and worn volumes in mm^3.
  json joint(const Pairs& rows, const std::string& rest = "",
             const std::string& k = R"x({ distribution = "flat", lower = "0 mm^3/(N m)" })x",
             const std::string& sigma =
                 R"x({ distribution = "uniform", lower = "0 mm^3", upper = "15 mm^3" })x",
             const std::string& more = "") {
    return fit(fmt::format(R"x(title = "t"
model = "archard-joint"
[data]
file = "{}"
[data.columns]
cycles = "cycles"
volume = {{ column = "volume", unit = "mm^3" }}
[conditions]
work_per_cycle = "5.966 N m"
[likelihood]
family = "normal"
[prior]
k = {}
sigma = {}
{}
{})x",
                           table("cycles,volume", rows), k, sigma, more, rest));
  }

  // Depths in um of one bearing under 1 MPa, by revolutions; `sigma` a prior or empty for a gauge
  // of 2 um.
  json bearing(const Pairs& rows, const std::string& sigma = "") {
    return fit(fmt::format(R"x(title = "t"
model = "bearing-wear"
[data]
file = "{}"
[data.columns]
revolutions = "revolutions"
depth = {{ column = "depth", unit = "um" }}
[conditions]
contact = "stationary"
radius = "10 mm"
clearance = "30 um"
pressure = "1 MPa"
[likelihood]
family = "normal"
{}
[prior]
k = {{ distribution = "lognormal", median = "1e-6 mm^3/(N m)", log_sd = 2.5 }}
{})x",
                           table("revolutions,depth", rows),
                           sigma.empty() ? "depth_error = \"2 um\"" : "",
                           sigma.empty() ? "" : "sigma = " + sigma));
  }

  // Cycles to failure by stress amplitude in MPa.
  json sn(const Pairs& rows) {
    return fit(fmt::format(R"x(title = "t"
model = "sn"
[data]
file = "{}"
[data.columns]
alternating_stress = {{ column = "stress", unit = "MPa" }}
life = {{ column = "life", unit = "cycles" }}
[law]
mean_stress = "none"
[likelihood]
family = "log10-normal"
[prior]
log10_a = {{ distribution = "normal", mean = "3.3 log10(MPa)", sd = 0.5 }}
b = {{ distribution = "normal", mean = -0.1, sd = 0.05 }}
sigma = {{ distribution = "half-normal", scale = 0.5 }}
)x",
                           table("stress,life", rows)));
  }
};

json check(const json& result, const std::string& name) {
  for (const json& each : result["checks"]) {
    if (each["name"] == name) return each;
  }
  return {{"verdict", "none"}, {"detail", ""}};
}
std::string verdict(const json& result, const std::string& name) {
  return check(result, name)["verdict"];
}

const Pairs right = {{1, 0.5},      {1000, 5.2},   {5000, 22.4},
                     {10000, 47.1}, {15000, 68.3}, {20000, 91.6}};

TEST_F(Trust, RightDataAreTrusted) {
  const json result = joint(right);
  EXPECT_EQ(verdict(result, "fit"), "pass") << check(result, "fit");
  EXPECT_TRUE(result["trusted"]);
}

TEST_F(Trust, WearThatFallsIsNot) {
  Pairs rows;
  const std::vector<double> depths = {40, 31, 23, 14, 5};
  for (std::size_t i = 0; i < depths.size(); ++i)
    rows.emplace_back(50000 * (double(i) + 1), depths[i]);
  for (const char* sigma : {"", R"x({ distribution = "half-normal", scale = "2 um" })x",
                            R"x({ distribution = "flat", lower = "0 um" })x"}) {
    const json result = bearing(rows, sigma);
    EXPECT_EQ(verdict(result, "fit"), "fail") << sigma << check(result, "fit");
    EXPECT_FALSE(result["trusted"]);
  }
  std::reverse(rows.begin(), rows.end());  // the order of rows is no order of work
  EXPECT_EQ(verdict(bearing(rows), "fit"), "fail");
}

TEST_F(Trust, AnOutlierOfTypingIsNot) {
  const Pairs rows = {{50000, 17},    {100000, 24}, {150000, 30},
                      {200000, 5000}, {250000, 37}, {300000, 40}};
  for (const char* sigma : {"", R"x({ distribution = "flat", lower = "0 um" })x"}) {
    const json result = bearing(rows, sigma);
    EXPECT_EQ(verdict(result, "fit"), "fail") << sigma << check(result, "fit");
    EXPECT_THAT(std::string(check(result, "fit")["detail"]), HasSubstr("row 4")) << sigma;
  }
  Pairs volumes = right;
  volumes[2].second = 2240;
  EXPECT_EQ(verdict(joint(volumes, "", R"x({ distribution = "flat", lower = "0 mm^3/(N m)" })x",
                          R"x({ distribution = "flat", lower = "0 mm^3" })x"),
                    "fit"),
            "fail");
}

TEST_F(Trust, NegativeWearIsNot) {
  Pairs rows = right;
  for (auto& [cycles, volume] : rows) volume = -volume;
  const json result = joint(rows, "[predict]\nlimit = \"100 mm^3\"\n");
  EXPECT_EQ(verdict(result, "fit"), "fail") << check(result, "fit");
}

TEST_F(Trust, LivesThatGrowWithStressAreNot) {
  const Pairs rows = {{200, 2e4},   {200, 3e4}, {250, 8e4}, {250, 9e4},
                      {300, 2.5e5}, {300, 3e5}, {350, 9e5}, {350, 1.1e6}};
  const json result = sn(rows);
  EXPECT_EQ(verdict(result, "fit"), "fail") << check(result, "fit");
  Pairs turned = rows;
  for (auto& [stress, life] : turned) stress = 550 - stress;
  EXPECT_EQ(verdict(sn(turned), "fit"), "pass") << check(sn(turned), "fit");
}

// A prior far from the data: the data win where they can, the prior where the scatter is wide.
TEST_F(Trust, PriorsThatDataExcludeAreNot) {
  for (const char* prior :
       {R"x({ distribution = "normal", mean = "1e-5 mm^3/(N m)", sd = "7.5e-9 mm^3/(N m)" })x",
        R"x({ distribution = "normal", mean = "0.1 mm^3/(N m)", sd = "8e-5 mm^3/(N m)" })x",
        R"x({ distribution = "lognormal", median = "0.1 mm^3/(N m)", log_sd = 0.1 })x"}) {
    const json result = joint(right, "", prior);
    EXPECT_FALSE(result["trusted"])
        << prior << check(result, "prior-data-conflict") << check(result, "fit");
  }
  // The scatter that a gauge is said to have.
  const json result = joint({{1, 9}, {1000, -8}, {5000, 34}, {10000, 30}, {15000, 81}, {20000, 79}},
                            "", R"x({ distribution = "flat", lower = "0 mm^3/(N m)" })x",
                            R"x({ distribution = "half-normal", scale = "0.5 mm^3" })x");
  EXPECT_EQ(verdict(result, "prior-data-conflict"), "fail") << check(result, "prior-data-conflict");
  EXPECT_THAT(std::string(check(result, "prior-data-conflict")["detail"]), HasSubstr("sigma"));
}

// The life of a joint whose exponent is known to 0.3: by Monte Carlo over the grid of the posterior
// in R the quantiles are 15038, 18325 and 24856.
TEST_F(Trust, ALifeThatFewNodesMakeInfiniteIsANumber) {
  const json result =
      joint({{1, 4.44}, {100, 5.105}, {1000, 8.825}, {5000, 24.175}, {10000, 45.31}},
            "[predict]\nlimit = \"100 mm^3\"\nrisk = \"1 %\"\n",
            R"x({ distribution = "flat", lower = "0 mm^3/(N m)" })x",
            R"x({ distribution = "uniform", lower = "0 mm^3", upper = "15 mm^3" })x",
            R"x(exponent = { distribution = "normal", mean = 1, sd = 0.3 })x");
  const json& life = result["life"];
  EXPECT_NEAR(life["b1"].get<double>(), 15038, 100);
  EXPECT_NEAR(life["b10"].get<double>(), 18325, 100);
  EXPECT_NEAR(life["b50"].get<double>(), 24856, 150);
  EXPECT_GT(life["inspect_within"].get<double>(), 3000);
}

// 45.31 mm^3 were measured, and 40 are the limit.
TEST_F(Trust, ALimitThatIsPassedFails) {
  const Pairs rows = {{1, 4.44}, {100, 5.105}, {1000, 8.825}, {5000, 24.175}, {10000, 45.31}};
  const json result = joint(rows, "[predict]\nlimit = \"40 mm^3\"\n");
  EXPECT_NEAR(result["life"]["passed"].get<double>(), 0.9, 0.02);
  EXPECT_EQ(verdict(result, "limit"), "fail");
  EXPECT_FALSE(result["trusted"]);
  EXPECT_EQ(verdict(joint(rows, "[predict]\nlimit = \"100 mm^3\"\n"), "limit"), "pass");
}

TEST_F(Trust, FarPredictionsAndWideIntervalsAreWarnedOf) {
  const json far = joint(right, "[predict]\ncycles = [20000, 70000]\nlimit = \"150 mm^3\"\n");
  EXPECT_EQ(verdict(far, "extrapolation"), "warn");
  EXPECT_THAT(std::string(check(far, "extrapolation")["detail"]),
              HasSubstr("the prediction at 70000 cycles is 3.5 times as far as the data reach"));
  const json near = joint(right, "[predict]\ncycles = [20000, 40000]\nlimit = \"150 mm^3\"\n");
  EXPECT_EQ(verdict(near, "extrapolation"), "pass");
  EXPECT_EQ(verdict(near, "sense"), "pass");
  // Wear within the noise of the gauge says hardly anything of a life.
  const json wide =
      joint({{1, 0.1}, {100, -0.2}, {200, 0.15}}, "[predict]\nlimit = \"100 mm^3\"\n",
            R"x({ distribution = "lognormal", median = "1e-6 mm^3/(N m)", log_sd = 3 })x");
  EXPECT_EQ(verdict(wide, "sense"), "warn") << check(wide, "sense");
  EXPECT_THAT(std::string(check(wide, "sense")["detail"]), HasSubstr("decades"));
}

}  // namespace
}  // namespace wearwell
