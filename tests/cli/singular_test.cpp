// Data without scatter, priors without end: exact integration of these once passed for trusted.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "support/run_command.h"
#include "support/scratch.h"

namespace wearwell {
namespace {

using nlohmann::json;

class SingularStudy : public ScratchTest {
 protected:
  json exact(const std::string& model, const std::string& columns, const std::string& rows,
             const std::string& rest) {
    write("data.csv", columns + "\n" + rows);
    write(
        "study.toml",
        fmt::format("title = \"x\"\nmodel = \"{}\"\n[data]\nfile = \"data.csv\"\n{}", model, rest));
    const CommandResult run = run_wearwell(fmt::format(
        "fit '{0}/study.toml' --method exact --warmup 200 --draws 200 --json -o '{0}/out'",
        folder().string()));
    EXPECT_LE(run.exit_code, 1) << run.err;
    return json::parse(run.out);
  }

  json joint(const std::string& rows, const std::string& priors) {
    return exact("archard-joint", "cycles,volume", rows, R"toml([data.columns]
cycles = "cycles"
volume = { column = "volume", unit = "mm^3" }
[conditions]
work_per_cycle = "5.966 N m"
[likelihood]
family = "normal"
[prior]
k = { distribution = "flat", lower = "0 mm^3/(N m)" }
sigma = { distribution = "flat", lower = "0 mm^3" }
)toml" + priors);
  }

  // log10 of life = (log10 of stress - 3.3)/-0.1, and as much as `deviation` beside it.
  json line(double deviation) {
    const double stress[] = {400, 350, 300, 280, 260, 240},
                 beside[] = {1, -1, 0.5, -0.2, 0.7, -1.3};
    std::string rows;
    for (int i = 0; i < 6; ++i) {
      const double log_life = (std::log10(stress[i]) - 3.3) / -0.1 + deviation * beside[i];
      rows += fmt::format("{},{:.17g},failure\n", stress[i], std::pow(10, log_life));
    }
    return exact("sn", "stress,life,status", rows, R"toml([data.columns]
alternating_stress = { column = "stress", unit = "MPa" }
life = "life"
status = "status"
[conditions]
mean_stress = "0 MPa"
[law]
mean_stress = "none"
[prior]
log10_a = { distribution = "flat", unit = "log10(MPa)" }
b = { distribution = "uniform", lower = -0.3, upper = -0.02 }
sigma = { distribution = "flat" }
)toml");
  }
};

TEST_F(SingularStudy, NothingWornIsNotTrusted) {
  EXPECT_FALSE(joint("1,0\n100,0\n1000,0\n5000,0\n10000,0\n", "")["trusted"]);
}

TEST_F(SingularStudy, WearExactlyInProportionIsNotTrusted) {
  EXPECT_FALSE(joint("1,0.0046\n100,0.46\n1000,4.6\n5000,23\n10000,46\n", "")["trusted"]);
}

TEST_F(SingularStudy, ConstantAndSlopeThatTheDataDoNotTellApart) {
  EXPECT_FALSE(joint("1000,4\n1000,5\n1000,4.5\n1000,5.2\n1000,4.1\n1000,4.7\n",
                     "V0 = { distribution = \"flat\", unit = \"mm^3\" }\n")["trusted"]);
}

TEST_F(SingularStudy, LivesExactlyOnALineAreNotTrusted) {
  EXPECT_FALSE(line(0)["trusted"]);
}

// One failure: the density of the shape has no end, that of the scale neither, and a search for the mode leaves for the
// largest numbers of the machine.
TEST_F(SingularStudy, OneFailureDoesNotDetermineAWeibull) {
  const json summary =
      exact("formula", "hours,status", "100,failure\n50,runout\n", R"toml([data.columns]
life = { column = "hours", unit = "h" }
status = "status"
[likelihood.life]
family = "weibull"
scale = "m"
shape = "b"
[prior]
m = { distribution = "flat", lower = "0 h" }
b = { distribution = "flat", lower = 0 }
)toml");
  EXPECT_FALSE(summary["trusted"]);
  EXPECT_THAT(summary.dump(), testing::HasSubstr("may be improper"));
}

// Six lives, two parameters of the line: sigma has density sigma^-4 exp(-S/2 sigma^2) with S the sum of squares beside
// the best line, b so well known that its factor 1/b is a constant.
TEST_F(SingularStudy, LivesTenMillionthsBesideALineAreIntegrated) {
  const double stress[] = {400, 350, 300, 280, 260, 240}, beside[] = {1, -1, 0.5, -0.2, 0.7, -1.3};
  double sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0;
  for (int i = 0; i < 6; ++i) {
    const double x = std::log10(stress[i]), y = beside[i];
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
    syy += y * y;
  }
  const double rss = syy - sy * sy / 6 - std::pow(sxy - sx * sy / 6, 2) / (sxx - sx * sx / 6);
  const double mean = std::sqrt(rss / 2) * std::exp(std::lgamma(1.0) - std::lgamma(1.5));
  const json summary = line(1e-7);
  const double found = summary["parameters"]["sigma"]["mean"];
  EXPECT_NEAR(found / (1e-7 * mean), 1, 1e-3);
}

}  // namespace
}  // namespace wearwell
