// Lives of three families with run-outs, from study file to B-lives, against brute force (tests/golden/formula_families.R).
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "support/golden.h"
#include "support/run_command.h"
#include "support/scratch.h"

namespace wearwell {
namespace {

using nlohmann::json;

class Families : public ScratchTest {
 protected:
  // Lives beyond `limit` are taken for run-outs there.
  void expect_golden(const std::string& family, const std::string& file, double limit,
                     const std::string& family_parameters, const std::string& priors) {
    std::ifstream lives(PROJECT_SOURCE_DIR "/" + file);
    std::string line, rows = "t,status\n";
    std::getline(lives, line);
    while (std::getline(lives, line)) {
      const double t = std::stod(line);
      rows += fmt::format("{},{}\n", std::min(t, limit), t <= limit ? "failure" : "runout");
    }
    write("data.csv", rows);
    write("study.toml", fmt::format(R"toml(title = "x"
model = "formula"
[data]
file = "data.csv"
[data.columns]
life = {{ column = "t", unit = "1e3 cycles" }}
status = "status"
[likelihood.life]
family = "{}"
{}
[prior]
{}
[predict]
b_lives = [10]
)toml",
                                    family, family_parameters, priors));
    const CommandResult run = run_wearwell(fmt::format(
        "fit '{0}/study.toml' --method exact --warmup 200 --draws 200 --json -o '{0}/out'",
        folder().string()));
    ASSERT_LE(run.exit_code, 1) << run.err;
    const json found = json::parse(run.out);
    int compared = 0;
    for (const auto& row : read_golden("formula_families.csv")) {
      if (row[0] != family) continue;
      const double mean = std::stod(row[2]), sd = std::stod(row[3]), median = std::stod(row[4]);
      ++compared;
      if (row[1] == "b10") {
        const auto& all = found["quantities"];
        const auto b10 = std::find_if(all.begin(), all.end(),
                                      [](const json& each) { return each["name"] == "B10 life"; });
        ASSERT_NE(b10, all.end());
        EXPECT_NEAR((*b10)["q50"].get<double>(), median, 0.02 * sd);
        continue;
      }
      const json& parameter = found["parameters"][row[1]];
      const double scale = parameter["unit"] == "1" ? 1 : 1e3;
      EXPECT_NEAR(parameter["mean"].get<double>() / scale, mean, 0.02 * sd) << row[1];
      EXPECT_NEAR(parameter["sd"].get<double>() / scale, sd, 0.02 * sd) << row[1];
    }
    EXPECT_GE(compared, 3);
  }
};

TEST_F(Families, GeneralizedGammaLives) {
  expect_golden("generalized-gamma", "examples/life/bearings.csv", 100,
                "scale = \"eta\"\nsigma = \"sigma\"\nlambda = \"lambda\"",
                "eta = { distribution = \"lognormal\", median = \"70e3 cycles\", log_sd = 1 }\n"
                "sigma = { distribution = \"lognormal\", median = 0.5, log_sd = 0.7 }\n"
                "lambda = { distribution = \"normal\", mean = 0, sd = 1 }");
}

TEST_F(Families, ExponentiatedWeibullLives) {
  expect_golden("exponentiated-weibull", "examples/life/bearings.csv", 100,
                "scale = \"eta\"\nshape = \"beta\"\nexponent = \"power\"",
                "eta = { distribution = \"lognormal\", median = \"50e3 cycles\", log_sd = 0.7 }\n"
                "beta = { distribution = \"lognormal\", median = 1.5, log_sd = 0.4 }\n"
                "power = { distribution = \"lognormal\", median = 2, log_sd = 1 }");
}

TEST_F(Families, BirnbaumSaundersLives) {
  expect_golden("birnbaum-saunders", "tests/golden/coupons.csv", 160,
                "scale = \"median\"\nshape = \"alpha\"",
                "median = { distribution = \"lognormal\", median = \"130e3 cycles\", log_sd = 1 }\n"
                "alpha = { distribution = \"lognormal\", median = 0.2, log_sd = 0.7 }");
}

}  // namespace
}  // namespace wearwell
