// Studies without a word of statistics: defaults stand in, and everything says so.
#include <gmock/gmock.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "support/run_command.h"
#include "support/scratch.h"

namespace wearwell {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class Defaults : public ScratchTest {
 protected:
  std::string command(const std::string& words, const std::string& study) {
    return words + " '" + write("study.toml", study).string() + "'";
  }
  std::string check(const std::string& study) {
    const CommandResult run = run_wearwell(command("check", study));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return run.out;
  }
  json fit(const std::string& study) {
    const CommandResult run = run_wearwell(command("fit", study) + " --method exact --json -o '" +
                                           (folder() / "out").string() + "'");
    EXPECT_LE(run.exit_code, 1) << run.err;
    return json::parse(run.out);
  }
  std::string example(const std::string& file) { return PROJECT_SOURCE_DIR "/examples/" + file; }
  // A study of examples/ without its [prior], its data named from here.
  std::string without_priors(const std::string& preset, const std::string& data) {
    std::string text = content_of(example(preset + "/study.toml"));
    const std::size_t begin = text.find("[prior]"), end = text.find("\n[", begin);
    text.erase(begin, end - begin);
    const std::size_t file = text.find("\"" + data + "\"");
    return text.replace(file, data.size() + 2, "\"" + example(preset + "/" + data) + "\"");
  }
  static std::string content_of(const std::string& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
  }
};

TEST_F(Defaults, CheckShowsThem) {
  const std::string joint = check(without_priors("joint", "joint_wear.csv"));
  EXPECT_THAT(joint, HasSubstr("prior: lognormal, median 10^-5, sd of the logarithm 4.2, above 0 "
                               "mm^3/(N m) (default"));
  EXPECT_THAT(joint, HasSubstr("prior: half-normal, scale 50, above 0 mm^3 (default"));
  const std::string bearing = check(without_priors("bearing", "inspections.csv"));
  EXPECT_THAT(bearing,
              HasSubstr("median 10^-5, sd of the logarithm 4.2, above 0 mm^3/(N m) (default"));
  const std::string fatigue = check(without_priors("fatigue", "tests.csv"));
  EXPECT_THAT(
      fatigue,
      HasSubstr("Student t, 4 degrees of freedom, location -0.12, scale 0.06, below 0 (default"));
  EXPECT_THAT(fatigue, HasSubstr("half-normal, scale 0.5, above 0 (default"));
  EXPECT_THAT(check(content_of(example("joint/study.toml"))
                        .replace(content_of(example("joint/study.toml")).find("joint_wear.csv"), 14,
                                 example("joint/joint_wear.csv"))),
              testing::Not(HasSubstr("(default")));
}

// They are weak: the known truth behind the simulated data lies in the intervals, as with the priors of
// the examples.
TEST_F(Defaults, AFirstFitFindsTheTruthAndNamesThem) {
  const json fatigue = fit(without_priors("fatigue", "tests.csv"));
  const std::map<std::string, double> truth = {{"log10_a", 3.30103}, {"b", -0.12}, {"sigma", 0.15}};
  for (const auto& [name, value] : truth) {
    const json& p = fatigue["parameters"][name];
    EXPECT_LT(double(p["mean"]) - 3 * double(p["sd"]), value) << name;
    EXPECT_GT(double(p["mean"]) + 3 * double(p["sd"]), value) << name;
  }
  for (const auto& [name, p] : fatigue["parameters"].items()) {
    EXPECT_EQ(p["prior"]["default"], true) << name;
    EXPECT_NE(p["prior"]["words"], "") << name;
  }
  for (const json& each : fatigue["checks"]) {
    if (each["name"] == "prior-data-conflict") {
      EXPECT_NE(each["verdict"], "fail") << each;
    }
  }
  const std::string report = content_of((folder() / "out" / "report.html").string());
  EXPECT_THAT(report, HasSubstr("These priors are weak defaults: log10_a, b, log10_Sut, sigma"));

  const json joint = fit(without_priors("joint", "joint_wear.csv"));
  EXPECT_NEAR(joint["parameters"]["k"]["mean"], 7.76e-4, 0.4e-4);
  EXPECT_EQ(joint["trusted"], true) << joint["checks"];
}

// Few tests pull away from a default, and contradict nobody: a warning, which asks for what is known.
TEST_F(Defaults, FewDataAgainstADefaultAreAWarning) {
  write("lives.csv",
        "stress,cycles,status\n400,41000,F\n400,52000,F\n350,120000,F\n350,160000,F\n300,500000,F\n"
        "300,2000000,S\n300,2000000,S\n300,2000000,S\n280,2000000,S\n280,2000000,S\n");
  const json result =
      fit("title = \"t\"\nmodel = \"sn\"\n[data]\nfile = \"lives.csv\"\n[data.columns]\n"
          "alternating_stress = { column = \"stress\", unit = \"MPa\" }\nlife = \"cycles\"\n"
          "status = \"status\"\n[law]\nmean_stress = \"none\"\n");
  for (const json& each : result["checks"]) {
    if (each["name"] != "prior-data-conflict") continue;
    EXPECT_EQ(each["verdict"], "warn") << each;
    EXPECT_THAT(std::string(each["advice"]), HasSubstr("state your own prior"));
  }
  EXPECT_EQ(result["trusted"], true) << result["checks"];
}

// A default is of the size of units and data, whatever they are told in.
TEST_F(Defaults, DoNotDependOnTheUnit) {
  const std::string here = without_priors("joint", "joint_wear.csv");
  std::string there = here;
  for (const auto& [from, to] : {std::pair{"avg(volume_mm3)", "avg(volume_mm3) * 0.001"},
                                 {"unit = \"mm^3\"", "unit = \"cm^3\""}})
    there.replace(there.find(from), std::string(from).size(), to);
  const json a = fit(here)["parameters"]["k"], b = fit(there)["parameters"]["k"];
  EXPECT_NEAR(double(a["mean"]) / (double(b["mean"]) * 1e3), 1, 1e-3);
}

TEST_F(Defaults, AMisspeltParameterIsRefusedAllTheSame) {
  std::string study = without_priors("joint", "joint_wear.csv") +
                      "\n[prior]\nsgma = { distribution = \"flat\", unit = \"mm^3\" }\n";
  const CommandResult run = run_wearwell(command("check", study));
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("sgma"));
  EXPECT_THAT(run.err, HasSubstr("sigma"));
}

}  // namespace
}  // namespace wearwell
