// `wearwell fatigue ...` as its user meets it.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "support/golden.h"
#include "support/run_command.h"
#include "support/scratch.h"

namespace wearwell {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
namespace fs = std::filesystem;

const std::string example = PROJECT_SOURCE_DIR "/examples/spectrum/";

class FatigueHistory : public ScratchTest {
 protected:
  CommandResult run(const std::string& arguments) {
    return run_command("cd '" + folder().string() + "'; '" WEARWELL_BINARY "' fatigue " +
                       arguments);
  }
  json result(const std::string& arguments) {
    const CommandResult done = run(arguments + " --json");
    EXPECT_EQ(done.exit_code, 0) << done.err;
    return json::parse(done.out);
  }
  /// One line on standard error, exit code 2, no file.
  std::string refused(const std::string& arguments) {
    const auto count = [&] {
      return std::distance(fs::recursive_directory_iterator(folder()), {});
    };
    const auto before = count();
    const CommandResult done = run(arguments);
    EXPECT_EQ(done.exit_code, 2) << arguments << done.out;
    EXPECT_EQ(done.out, "");
    EXPECT_EQ(std::count(done.err.begin(), done.err.end(), '\n'), 1) << done.err;
    EXPECT_EQ(count(), before);
    return done.err;
  }
};

TEST_F(FatigueHistory, CountsAstmsExample) {
  write("astm.csv", "load [N]\n-2\n1\n-3\n5\n-1\n3\n-4\n4\n-2\n");
  const json counted = result("rainflow astm.csv --method three-point --bin-width 1 -o out");
  std::map<double, double> cycles;
  for (const json& row : counted["spectrum"]) cycles[row["from"]] = row["cycles"];
  EXPECT_EQ(cycles, (std::map<double, double>{{3, 0.5}, {4, 1.5}, {6, 0.5}, {8, 1}, {9, 0.5}}));
  EXPECT_EQ(counted["unit"], "N");
  for (const char* file : {"rainflow.json", "report.html", "tables/cycles.csv",
                           "tables/matrix.parquet", "tables/levels.parquet"})
    EXPECT_TRUE(fs::exists(folder() / "out" / file)) << file;
  // What was written is read again: Parquet by the door of every table.
  const json again = result("rainflow out/tables/levels.parquet --column level");
  EXPECT_EQ(again["samples"], counted["levels"].size());
}

TEST_F(FatigueHistory, GoesOnFromAState) {
  std::string whole = "stress [MPa]\n", first = whole, second = whole;
  for (int i = 0; i < 500; ++i) {
    const std::string line = fmt::format("{:.3f}\n", 100 * std::sin(i * 1.7) * std::cos(i * 0.13));
    whole += line;
    (i < 217 ? first : second) += line;
  }
  write("whole.csv", whole);
  write("first.csv", first);
  write("second.csv", second);
  EXPECT_EQ(run("rainflow first.csv --state s.json").exit_code, 0);
  json parts = result("rainflow second.csv --state s.json");
  json all = result("rainflow whole.csv");
  all.erase("file");
  parts.erase("file");
  EXPECT_EQ(parts, all);
  EXPECT_THAT(refused("rainflow second.csv --state s.json --residual repeat"),
              HasSubstr("--residual half"));
  write("force.csv", "force [N]\n1\n2\n1\n");
  EXPECT_THAT(refused("rainflow force.csv --state s.json"), HasSubstr("'MPa'"));
  write("broken.json", R"({"format": "wearwell rainflow state", "version": 1})");
  EXPECT_THAT(refused("rainflow first.csv --state broken.json"), HasSubstr("method"));
}

TEST_F(FatigueHistory, RefusesWhatIsNoSignal) {
  write("gap.csv", "a,b\n1,1\n,2\n3,3\n");
  EXPECT_THAT(refused("rainflow gap.csv --column a"), AllOf(HasSubstr("row 2"), HasSubstr("gap")));
  EXPECT_THAT(refused("rainflow gap.csv"), AllOf(HasSubstr("'a', 'b'"), HasSubstr("--column")));
  EXPECT_THAT(refused("rainflow gap.csv --column c"), HasSubstr("nearest"));
  write("one.csv", "a\n1\n");
  EXPECT_THAT(refused("rainflow one.csv"), HasSubstr("one sample"));
  write("constant.csv", "a\n7\n7\n7\n");
  EXPECT_THAT(refused("rainflow constant.csv"), HasSubstr("7 throughout"));
  write("times.csv", "time [s],a [MPa]\n0,1\n1,2\n2,1\n7,3\n");
  EXPECT_THAT(refused("rainflow times.csv --time time"),
              AllOf(HasSubstr("row 4"), HasSubstr("gap")));
  EXPECT_THAT(refused("rainflow times.csv --unit N"), AllOf(HasSubstr("MPa"), HasSubstr("--unit")));
  EXPECT_THAT(refused("rainflow times.csv --bins 0"), HasSubstr("--bins"));
  EXPECT_THAT(refused("rainflow times.csv --bin-width 1e-15"), HasSubstr("--bin-width"));
}

class FatigueLife : public FatigueHistory {
 protected:
  FatigueLife() {
    const CommandResult fit =
        run_command("'" WEARWELL_BINARY "' fit '" + example +
                    "study.toml' --method exact --quiet -o '" + (folder() / "res").string() + "'");
    EXPECT_EQ(fit.exit_code, 0) << fit.err;
  }
};

// Without a report the tables of the design curves are there all the same.
TEST_F(FatigueHistory, DesignCurvesWithoutAReport) {
  const CommandResult fit =
      run_command("cd '" + folder().string() + "'; '" WEARWELL_BINARY "' fit '" + example +
                  "study.toml' --method exact --no-report --json -o out");
  ASSERT_EQ(fit.exit_code, 0) << fit.err;
  EXPECT_TRUE(fs::exists(folder() / "out/tables/design-curves.csv"));
  const json all = json::parse(fit.out), curves = all["design_curves"];
  // T_N is 10^(2.563 sigma), so its quantiles are those of sigma.
  const json &t = curves["scatter"]["T_N"], &sigma = all["parameters"]["sigma"];
  constexpr double width = 2 * 1.2815515655446004;
  for (const auto& [i, key] : {std::pair{0, "q05"}, {1, "q50"}, {2, "q95"}})
    EXPECT_NEAR(t[i].get<double>() / std::pow(10, width * sigma[key].get<double>()), 1, 1e-6);
  ASSERT_EQ(curves["curves"].size(), 4u);
  for (const json& curve : curves["curves"]) {
    double before = 0;
    for (const json& point : curve["points"]) {  // from the highest stress down lives grow
      EXPECT_GT(point["life"], before);
      before = point["life"];
      // One run-out among 25, weak priors: the standards come near.
      EXPECT_NEAR(point["life"].get<double>() / point["owen"].get<double>(), 1, 0.15);
    }
  }
  EXPECT_EQ(curves["astm_e739"]["left_out"], 1);
}

// A design curve is the lower bound of a B-life: two ways through the quadrature, one by cells and one by what its nodes weigh.
TEST_F(FatigueHistory, DesignCurvesAreBoundsOfBLives) {
  fs::copy_file(example + "tests.csv", folder() / "tests.csv");
  std::ifstream stream(example + "study.toml");
  std::string study{std::istreambuf_iterator<char>(stream), {}};
  study = study.substr(0, study.find("[predict]"));
  // Eleven of 25 tests at a stress ratio of 0.1, the others fully reversed.
  const double mean = (4 * 260 + 4 * 300 + 3 * 350) * 1.1 / 0.9 / 25;
  std::size_t compared = 0;
  for (const double confidence : {0.9, 0.95}) {
    write("study.toml",
          study +
              fmt::format("\n[predict]\nb_lives = [10, 1]\ncredible_level = {}\n[predict.stress]\n"
                          "p = {{ alternating_stress = \"600 MPa\", mean_stress = \"{} MPa\" }}\n",
                          confidence, mean));
    const CommandResult fit =
        run_command("cd '" + folder().string() +
                    "'; rm -rf out; '" WEARWELL_BINARY
                    "' fit study.toml --method exact --no-report --json -o out");
    ASSERT_EQ(fit.exit_code, 0) << fit.err;
    const json all = json::parse(fit.out);
    EXPECT_NEAR(all["design_curves"]["mean_stress"].get<double>(), mean, 1e-9);
    for (const json& curve : all["design_curves"]["curves"]) {
      const json& first = curve["points"][0];
      ASSERT_EQ(first["stress"], 600);
      if (curve["confidence"] != confidence) continue;
      const double reliability = curve["reliability"];
      if (reliability != 0.9 && reliability != 0.99) continue;
      const json& b_life = all["quantities"][reliability == 0.9 ? 1 : 2];
      EXPECT_NEAR(first["life"].get<double>() / b_life["bound"].get<double>(), 1, 3e-3)
          << curve["name"];
      ++compared;
    }
  }
  EXPECT_EQ(compared, 3);  // 90/90, B-basis and A-basis
}

// Life under so many equal cycles is what the study itself says of that stress.
TEST_F(FatigueLife, OfConstantAmplitudeIsTheStudys) {
  write("cycles.csv", "amplitude [MPa],stress_ratio,cycles\n400,-1,1000\n");
  const json life = result("life res cycles.csv --damage-sum 1 --block '1000 h'");
  std::string study;
  {
    std::ifstream stream(example + "study.toml");
    study = {std::istreambuf_iterator<char>(stream), {}};
  }
  study +=
      "\n[predict]\nb_lives = [1, 10, 50]\n[predict.stress]\n\"p\" = { alternating_stress = "
      "\"400 MPa\", stress_ratio = -1 }\n";
  write("study.toml", study);
  fs::copy_file(example + "tests.csv", folder() / "tests.csv");
  const CommandResult fit = run_command(
      "cd '" + folder().string() + "'; '" WEARWELL_BINARY "' fit study.toml --method exact --json");
  const json quantities = json::parse(fit.out)["quantities"];
  for (std::size_t i = 0; i < 3; ++i) {
    const json& expected = quantities[i + 1];
    EXPECT_EQ(life["lives"][i]["percent"], (std::vector{1, 10, 50})[i]);
    // By 4000 draws here, by quadrature there.
    for (const char* key : {"q05", "q50", "q95", "bound", "predictive"})
      EXPECT_NEAR(life["lives"][i][key].get<double>() / expected[key].get<double>(), 1, 0.02)
          << key;
  }
  EXPECT_EQ(life["unit"], "h");
}

// The same of curves with a form of their own, whose results are read back with it.
TEST_F(FatigueHistory, ConstantAmplitudeAlongEveryCurve) {
  write("cycles.csv", "amplitude [MPa],cycles\n400,1000\n");
  fs::copy_file(example + "tests.csv", folder() / "tests.csv");
  for (const std::string law :
       {"curve = \"knee\"",
        "curve = \"knee\"\nsecond_slope = \"infinite\"\nfatigue_limit = \"random\"",
        "curve = \"stromeyer\"", "curve = \"bastenaire\"", "scatter = \"grows\"",
        "fatigue_limit = \"random\""}) {
    write("study.toml",
          "model = \"sn\"\n[data]\nfile = \"tests.csv\"\n[data.columns]\n"
          "alternating_stress = \"amplitude\"\nlife = \"cycles\"\nstatus = \"status\"\n"
          "[law]\nmean_stress = \"none\"\n" +
              law +
              "\n[predict]\nb_lives = [10]\n[predict.stress]\np = { alternating_stress = \"400 "
              "MPa\" }\n");
    const CommandResult fit = run_command(
        "cd '" + folder().string() +
        "'; rm -rf r; '" WEARWELL_BINARY
        "' fit study.toml --method nuts --draws 500 --warmup 500 --no-report --json -o r");
    ASSERT_LE(fit.exit_code, 1) << fit.err;  // so few draws may not be trusted
    const json expected = json::parse(fit.out)["quantities"][1];
    const json life = json::parse(run("life r cycles.csv --damage-sum 1 --json").out);
    const json& b10 = life["lives"][1];
    // Both compute from the nodes of one quadrature, of which `life` gathers those of little weight.
    for (const char* key : {"q05", "q50", "q95", "bound", "predictive"})
      EXPECT_NEAR(1000 * b10[key].get<double>() / expected[key].get<double>(), 1, 0.01)
          << law << " " << key;
  }
}

TEST_F(FatigueLife, OfASignalAndOfItsCyclesAgree) {
  const std::string loads = "'" + example + "loads.csv'";
  const json of_signal = result("life res " + loads + " --column stress --block '350 km'");
  EXPECT_EQ(run("rainflow " + loads + " --column stress -o counted").exit_code, 0);
  const json of_cycles = result("life res counted/tables/cycles.parquet --block '350 km'");
  EXPECT_EQ(of_signal["lives"], of_cycles["lives"]);
  double sum = 0;
  for (const json& each : of_signal["contributions"]) sum += each["share"].get<double>();
  EXPECT_NEAR(sum, 1, 0.01);
  const CommandResult text = run("life res " + loads + " --column stress -o out");
  EXPECT_THAT(text.out, AllOf(HasSubstr("WARN  extrapolation"), HasSubstr("B10 life [blocks]"),
                              HasSubstr("Results are in")));
  for (const char* file : {"life.json", "report.html", "tables/lives.csv"})
    EXPECT_TRUE(fs::exists(folder() / "out" / file)) << file;
}

// 3000 samples of 0.05 s: 1/24 h. Twice as many of half the length, an even signal between them, last as long.
TEST_F(FatigueLife, InTheHoursOfTheSignal) {
  const std::string loads = "'" + example + "loads.csv' --column stress";
  const json timed = result("life res " + loads + " --time 'time [s]'");
  const json said = result("life res " + loads + " --block '0.04166666666666667 h'");
  EXPECT_EQ(timed["unit"], "h");
  for (const char* key : {"q05", "q50", "q95", "bound", "predictive"})
    EXPECT_NEAR(timed["lives"][1][key].get<double>() / said["lives"][1][key].get<double>(), 1,
                1e-12);
  const json named = result("life res " + loads + " --time 'time [s]' --block '350 km'");
  EXPECT_EQ(named["unit"], "km");

  write("minutes.csv", "time [min],stress [MPa]\n0,0\n1,300\n2,0\n3,300\n");
  EXPECT_THAT(run("life res minutes.csv --time 'time [min]'").out,
              HasSubstr("a block is 0.0666667 h"));
  write("gap.csv", "time [s],stress [MPa]\n0,0\n1,300\n2,0\n9,300\n");
  EXPECT_THAT(refused("life res gap.csv --time 'time [s]'"), HasSubstr("a gap"));
  write("unit.csv", "when,stress [MPa]\n0,0\n1,300\n2,0\n");
  EXPECT_THAT(refused("life res unit.csv --column stress --time when"),
              AllOf(HasSubstr("'when' has no unit"), HasSubstr("--block")));
  write("metres.csv", "way [m],stress [MPa]\n0,0\n1,300\n2,0\n");
  EXPECT_THAT(refused("life res metres.csv --column stress --time way"),
              HasSubstr("not a unit of time"));
  write("counted.csv", "range [MPa],mean [MPa],cycles\n300,10,1\n");
  EXPECT_THAT(refused("life res counted.csv --time cycles"), HasSubstr("has no times"));
}

TEST_F(FatigueLife, RefusesWhatMayBeMisread) {
  write("no_kind.csv", "stress [MPa],cycles\n300,10\n");
  EXPECT_THAT(refused("life res no_kind.csv"), AllOf(HasSubstr("range"), HasSubstr("amplitude")));
  write("no_mean.csv", "range [MPa],cycles\n300,10\n");
  EXPECT_THAT(refused("life res no_mean.csv"), HasSubstr("'mean' and 'stress_ratio'"));
  write("no_count.csv", "range [MPa],mean [MPa]\n300,10\n");
  EXPECT_THAT(refused("life res no_count.csv"), HasSubstr("'cycles'"));
  write("both.csv", "range [MPa],amplitude [MPa],mean [MPa],cycles\n300,10,0,1\n");
  EXPECT_THAT(refused("life res both.csv"), HasSubstr("twice an amplitude"));
  write("bad.csv", "range [MPa],mean [MPa],cycles\n300,10,1\n-4,0,1\n");
  EXPECT_THAT(refused("life res bad.csv"), AllOf(HasSubstr("row 2"), HasSubstr("'-4'")));
  write("strain.csv", "strain [um/m]\n100\n900\n100\n");
  EXPECT_THAT(refused("life res strain.csv"), AllOf(HasSubstr("strain"), HasSubstr("--scale")));
  EXPECT_EQ(run("life res strain.csv --scale '206 GPa'").exit_code, 0);
  EXPECT_THAT(refused("life res strain.csv --scale '206 N'"), HasSubstr("not a stress"));
  write("bare.csv", "load\n100\n900\n100\n");
  EXPECT_THAT(refused("life res bare.csv"), HasSubstr("no unit"));
  EXPECT_THAT(refused("life res bare.csv --unit MPa --rule haibach"), HasSubstr("--knee"));
  EXPECT_THAT(refused("life res bare.csv --unit MPa --knee '2e6 cycles'"), HasSubstr("--rule"));
  EXPECT_THAT(refused("life res bare.csv --unit MPa --damage-sum '1 x/ 0.5'"),
              HasSubstr("at least 1"));
  EXPECT_THAT(refused("life res bare.csv --unit MPa --block 350"), HasSubstr("350 km"));
  EXPECT_THAT(refused("life nothing bare.csv"), HasSubstr("no such folder"));
}

// Two corrections of the mean stress of the same tests: each draw counts with its model's weight.
TEST_F(FatigueLife, DesignIsAveragedOverModels) {
  const std::string fit = " && '" WEARWELL_BINARY "' fit gerber.toml --method exact --quiet";
  const auto fitted = [&](const std::string& edit, const std::string& to) {
    return run_command("cd '" + folder().string() + "' && cp '" + example +
                       "tests.csv' . && sed '" + edit + "' '" + example +
                       "study.toml' > gerber.toml" + fit + " -o " + to);
  };
  ASSERT_LE(fitted("s/\"goodman\"/\"gerber\"/", "gerber").exit_code, 1);
  const std::string two = "design res gerber --stress '300 MPa' --stress '400 MPa'";
  const json averaged = result(two + " --stress-ratio -1 -o out");
  double weights = 0;
  for (const json& model : averaged["models"]) weights += model["weight"].get<double>();
  EXPECT_NEAR(weights, 1, 1e-6);
  ASSERT_EQ(averaged["curves"].size(), 4u);
  for (const json& curve : averaged["curves"]) {
    ASSERT_EQ(curve["points"].size(), 2u);
    EXPECT_EQ(curve["points"][0]["stress"], 400);
    EXPECT_LT(curve["points"][0]["life"], curve["points"][1]["life"]);
    for (const json& point : curve["points"]) {
      const auto [least, most] =
          std::minmax({point["models"][0].get<double>(), point["models"][1].get<double>()});
      EXPECT_GE(point["life"], least * (1 - 1e-9));
      EXPECT_LE(point["life"], most * (1 + 1e-9));
    }
  }
  for (const char* file :
       {"design.json", "report.html", "tables/averaged-design.csv", "tables/weights.csv"})
    EXPECT_TRUE(fs::exists(folder() / "out" / file)) << file;
  EXPECT_THAT(run("design res gerber --stress-ratio -1 --stress '5000 MPa'").out,
              HasSubstr("WARN  extrapolation"));
  EXPECT_THAT(refused("design res res"), HasSubstr("given twice"));
  EXPECT_THAT(refused(two + " --stress-ratio 2"), HasSubstr("less than 1"));
  EXPECT_THAT(refused("design res gerber --stress '300 mm' --stress-ratio -1"),
              HasSubstr("--stress"));
  EXPECT_THAT(refused("design res nothing"), HasSubstr("no such folder"));
  ASSERT_LE(fitted("s/^file = .*/&\\nsql = \"select * from data limit 20\"/", "fewer").exit_code,
            1);
  EXPECT_THAT(refused("design res fewer --stress-ratio -1"), HasSubstr("different data"));
}

// tests/golden/staircase.R: the same posterior on a grid in R.
TEST_F(FatigueHistory, StaircaseAsInR) {
  const CommandResult fit = run_command("cd '" + folder().string() +
                                        "'; '" WEARWELL_BINARY "' fit '" PROJECT_SOURCE_DIR
                                        "/examples/staircase/study.toml' --method exact --json");
  EXPECT_LE(fit.exit_code, 1) << fit.err;
  const json summary = json::parse(fit.out);
  std::map<std::string, double> golden;
  for (const auto& row : read_golden("staircase.csv")) golden[row[0]] = std::stod(row[1]);
  const json& limit = summary["parameters"]["log10_limit"];
  const json& sigma = summary["parameters"]["sigma_limit"];
  EXPECT_NEAR(limit["mean"], golden.at("mean_limit"), 2e-5);
  EXPECT_NEAR(limit["sd"], golden.at("sd_limit"), 2e-5);
  EXPECT_NEAR(sigma["mean"], golden.at("mean_sigma"), 4e-5);
  EXPECT_NEAR(sigma["sd"], golden.at("sd_sigma"), 4e-5);
  EXPECT_NEAR(summary["quantities"][1]["bound"], golden.at("limit90_q10"), 0.15);
  const json& classical = summary["staircase"]["dixon_mood"];
  EXPECT_NEAR(classical["mean"], golden.at("dm_mean"), 1e-6);
  EXPECT_NEAR(classical["sd"], golden.at("dm_sd"), 1e-6);
  // One more test never tells less than nothing.
  for (const json& test : summary["staircase"]["next_test"]) EXPECT_LE(test["sd_ratio"], 1 + 1e-9);
}

}  // namespace
}  // namespace wearwell
