// Curves, load histories and staircases of what is no stress: forces, strains, plain numbers.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/algorithm/string/replace.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "support/run_command.h"
#include "support/scratch.h"

namespace wearwell {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

const std::string examples = PROJECT_SOURCE_DIR "/examples/";

std::string text_of(const std::string& path) {
  std::ifstream stream(path);
  return {std::istreambuf_iterator<char>(stream), {}};
}

class FatigueDriver : public ScratchTest {
 protected:
  CommandResult run(const std::string& arguments) {
    return run_command("cd '" + folder().string() + "'; '" WEARWELL_BINARY "' " + arguments);
  }
  json result(const std::string& arguments) {
    const CommandResult done = run(arguments + " --json");
    EXPECT_LE(done.exit_code, 1) << done.err;
    return json::parse(done.out);
  }
  std::string refused(const std::string& arguments) {
    const CommandResult done = run("fatigue life " + arguments);
    EXPECT_EQ(done.exit_code, 2) << arguments << done.out;
    return done.err;
  }
  /// The spectrum's study as if its tests had been told in such a unit, a number for a number.
  void fit(const std::string& name, const std::string& unit, double factor = 1) {
    write("tests.csv",
          boost::replace_first_copy(text_of(examples + "spectrum/tests.csv"), "MPa", unit));
    const std::string mean = unit.find('N') == unit.npos
                                 ? fmt::format("{:.17g}", 3.3 + std::log10(factor))
                                 : fmt::format("\"3.3 log10({})\"", unit);
    write("study.toml",
          fmt::format("model = \"sn\"\n[data]\nfile = \"tests.csv\"\n[data.columns]\n"
                      "alternating_stress = \"amplitude\"\nlife = \"cycles\"\nstatus = \"status\"\n"
                      "[law]\nmean_stress = \"none\"\n[prior]\n"
                      "log10_a = {{ distribution = \"normal\", mean = {}, sd = 0.3 }}\n"
                      "b = {{ distribution = \"normal\", mean = -0.1, sd = 0.04 }}\n"
                      "sigma = {{ distribution = \"half-normal\", scale = 0.3 }}\n",
                      unit == "MPa" ? "\"3.3 log10(MPa)\"" : mean));
    const CommandResult done = run("fit study.toml --method exact --quiet --no-report -o " + name);
    ASSERT_LE(done.exit_code, 1) << done.err;
  }
  /// The spectrum's history with its numbers told as another thing.
  void history(const std::string& name, const std::string& heading, double factor) {
    std::string text = heading + "\n";
    std::istringstream lines(text_of(examples + "spectrum/loads.csv"));
    std::string line;
    std::getline(lines, line);
    while (std::getline(lines, line))
      text += fmt::format("{:.12g}\n", factor * std::stod(line.substr(line.find(',') + 1)));
    write(name, text);
  }
};

void expect_same_lives(const json& one, const json& other, double room) {
  ASSERT_EQ(one["lives"].size(), other["lives"].size());
  for (std::size_t i = 0; i < one["lives"].size(); ++i) {
    for (const char* key : {"q05", "q50", "q95", "bound", "predictive"})
      EXPECT_NEAR(one["lives"][i][key].get<double>() / other["lives"][i][key].get<double>(), 1,
                  room)
          << key;
  }
}

// Two posteriors that are one have draws of their own.
constexpr double drawn = 0.01;

// One posterior, the history in four words for one and the same stress.
TEST_F(FatigueDriver, HistoriesThatAScaleMakesStressesOf) {
  fit("res", "MPa");
  history("stress.csv", "stress [MPa]", 1);
  history("force.csv", "force [kN]", 0.5);
  history("newton.csv", "force (N)", -500);
  history("strain.csv", "strain (um/m)", 1e6 / 206e3);
  const json expected = result("fatigue life res stress.csv");
  EXPECT_THAT(expected["history"].get<std::string>(), Not(HasSubstr("times")));
  const json force = result("fatigue life res force.csv --scale '2 MPa/kN'");
  expect_same_lives(force, expected, 1e-9);
  EXPECT_THAT(force["history"].get<std::string>(),
              HasSubstr("column 'force [kN]', times 2 MPa/kN"));
  // Where the mean does not matter, neither does which way the force is counted positive.
  expect_same_lives(result("fatigue life res newton.csv --scale '0.002 MPa/N'"), expected, 1e-9);
  expect_same_lives(result("fatigue life res strain.csv --scale '206 GPa'"), expected, 1e-9);
  EXPECT_THAT(run("fatigue life res stress.csv").out, HasSubstr("means up to"));
  // Counted cycles have one scale for range and mean.
  EXPECT_EQ(run("fatigue rainflow force.csv -o counted").exit_code, 0);
  const json counted = result("fatigue life res counted/tables/cycles.csv --scale '2 MPa/kN'");
  expect_same_lives(counted, expected, 1e-9);
  EXPECT_THAT(counted["history"].get<std::string>(),
              AllOf(HasSubstr("times 2 MPa/kN"), HasSubstr("'mean [kN]' is ignored")));
}

TEST_F(FatigueDriver, CurvesOfForcesAndStrainsTakeTheirLikeOnly) {
  fit("stress", "MPa");
  fit("force", "kN");
  fit("strain", "um/m", 1e-6);
  history("stress.csv", "stress [MPa]", 1);
  history("force.csv", "force [N]", 1000);
  history("strain.csv", "strain [%]", 1e-4);
  const json expected = result("fatigue life stress stress.csv");
  const json force = result("fatigue life force force.csv");
  expect_same_lives(force, expected, drawn);
  EXPECT_EQ(force["stress_unit"], "kN");
  expect_same_lives(result("fatigue life strain strain.csv"), expected, drawn);
  EXPECT_THAT(refused("force stress.csv"),
              AllOf(HasSubstr("MPa"), HasSubstr("dimension of N"), HasSubstr("--scale")));
  EXPECT_THAT(refused("strain stress.csv"), AllOf(HasSubstr("MPa"), HasSubstr("as a strain")));
  EXPECT_THAT(refused("stress force.csv"),
              AllOf(HasSubstr("not a stress"), HasSubstr("0.35 MPa/N")));
  EXPECT_THAT(refused("force stress.csv --scale '2 MPa/kN'"), HasSubstr("not a load in N"));
  // The other way about: a measured stress makes the force that the study knows.
  expect_same_lives(result("fatigue life force stress.csv --scale '1 kN/MPa'"), expected, drawn);
}

TEST_F(FatigueDriver, SharesOfTheStrengthHaveNoUnitBehindThem) {
  fit("share", "1");
  EXPECT_THAT(run("check study.toml").out, HasSubstr("alternating stress 260 to 600\n"));
  EXPECT_THAT(run("fit study.toml --method exact --no-report -o again").out,
              AllOf(HasSubstr(" × N^("), Not(HasSubstr(" 1 × N^("))));
}

TEST_F(FatigueDriver, RefusesLoadsThatReadTwoWays) {
  fit("res", "MPa");
  write("bare.csv", "strain\n100\n900\n100\n");
  EXPECT_THAT(refused("res bare.csv --scale '206 GPa'"),
              AllOf(HasSubstr("um/m"), HasSubstr("plain number")));
  EXPECT_THAT(run("fatigue life res bare.csv --scale '206 GPa' --unit um/m").out,
              HasSubstr("'strain' in um/m, times 206 GPa"));
  write("counted.csv", "force_range [kN],cycles\n300,10\n");
  EXPECT_THAT(refused("res counted.csv --unit MPa"),
              AllOf(HasSubstr("kN"), HasSubstr("--unit has MPa")));
  EXPECT_THAT(refused("res counted.csv"), HasSubstr("not a stress"));
  EXPECT_LE(run("fatigue life res counted.csv --scale '2 MPa/kN'").exit_code, 1);
  write("stress.csv", "stress [MPa]\n-300\n300\n-300\n");
  EXPECT_THAT(refused("res stress.csv --rule haibach --knee 150"),
              AllOf(HasSubstr("'150 cycles'"), HasSubstr("'150 MPa'")));
  fit("strain", "um/m", 1e-6);
  write("strain.csv", "strain [um/m]\n-400\n400\n-400\n");
  EXPECT_THAT(refused("strain strain.csv --rule haibach --knee 0.0002"), HasSubstr("'0.0002 %'"));
  // A knee in strain is no number of cycles.
  const json knee = result("fatigue life strain strain.csv --rule haibach --knee '200 um/m'");
  EXPECT_NEAR(knee["knee_stress"].get<double>(), 200, 1e-9);
  EXPECT_EQ(knee.count("knee_life"), 0);
}

// The example's staircase in forces and in shares of the strength: one number for another, the same posterior.
TEST_F(FatigueDriver, StaircasesOfAnyDriver) {
  const std::string tests = text_of(examples + "staircase/tests.csv");
  const auto study = [&](const std::string& unit, const std::string& prior) {
    write("tests.csv", boost::replace_first_copy(tests, "MPa", unit));
    write("study.toml",
          "model = \"staircase\"\n[data]\nfile = \"tests.csv\"\n[data.columns]\n"
          "alternating_stress = \"amplitude\"\nstatus = \"status\"\n" +
              (prior.empty() ? ""
                             : "[prior]\nlog10_limit = { distribution = \"normal\", mean = " +
                                   prior + ", sd = 0.2 }\n"));
    return "fit study.toml --method exact --no-report";
  };
  const json stress = result(study("MPa", "\"2.5 log10(MPa)\""));
  const json force = result(study("kN", "\"2.5 log10(kN)\""));
  const json share = result(study("%", "0.5"));
  const auto limit = [](const json& summary) -> json { return summary["quantities"][1]; };
  for (const char* key : {"q05", "q50", "bound", "predictive"}) {
    const double expected = limit(stress)[key].get<double>();
    EXPECT_NEAR(limit(force)[key].get<double>() / expected, 1, 1e-6) << key;
    EXPECT_NEAR(limit(share)[key].get<double>() / expected, 1, 1e-6) << key;
  }
  EXPECT_EQ(force["staircase"]["dixon_mood"]["unit"], "kN");
  EXPECT_NEAR(force["staircase"]["dixon_mood"]["mean"].get<double>() /
                  stress["staircase"]["dixon_mood"]["mean"].get<double>(),
              1, 1e-12);
  // Without a prior too, which then lies about the stresses.
  const json by_default = result(study("MPa", ""));
  EXPECT_NEAR(by_default["quantities"][0]["q50"].get<double>(), 300, 15);
  EXPECT_NEAR(
      limit(result(study("%", "")))["q50"].get<double>() / limit(by_default)["q50"].get<double>(),
      1, 1e-6);
  const CommandResult mixed = run(study("kN", "\"2.5 log10(MPa)\""));
  EXPECT_EQ(mixed.exit_code, 2);
  EXPECT_THAT(mixed.err, AllOf(HasSubstr("log10_limit"), HasSubstr("'kN'")));
}

}  // namespace
}  // namespace wearwell
