// `wearwell fit` as its users run it: the paper's numbers, the traps, wrong input, the files it
// leaves.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>

#include "support/messages.h"
#include "support/run_command.h"
#include "support/scratch.h"

namespace wearwell {
namespace {

using nlohmann::json;
using testing::HasSubstr;
namespace fs = std::filesystem;

const std::string examples = PROJECT_SOURCE_DIR "/examples/joint/";

std::string slurp(const fs::path& file) {
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

class FitCommand : public ScratchTest {
 protected:
  CommandResult fit(const std::string& arguments) {
    return run_wearwell("fit " + arguments + " -o '" + results().string() + "'");
  }
  json fit_json(const std::string& arguments, int expected_exit_code) {
    const CommandResult run = fit(arguments + " --json");
    EXPECT_EQ(run.exit_code, expected_exit_code) << run.err;
    return json::parse(run.out);
  }
  fs::path results() const { return folder() / "results"; }
};

const json& check(const json& summary, const std::string& name) {
  for (const json& each : summary["checks"]) {
    if (each["name"] == name) return each;
  }
  throw std::runtime_error("no check " + name);
}

// Table 5 of An et al. (2011): normal, first 5 sets, flat prior: exact mean k 7.76e-4, sd 0.92e-4,
// sigma 5.63 +- 2.51.
TEST_F(FitCommand, StudyReproducesTable5) {
  const json summary = fit_json(examples + "study.toml", 0);
  const json& k = summary["parameters"]["k"];
  const json& sigma = summary["parameters"]["sigma"];
  EXPECT_EQ(k["unit"], "mm^3/(N m)");
  EXPECT_NEAR(k["mean"], 7.76e-4, 0.005e-4);
  EXPECT_NEAR(k["sd"], 0.92e-4, 0.005e-4);
  EXPECT_NEAR(sigma["mean"], 5.63, 0.005);
  EXPECT_NEAR(sigma["sd"], 2.51, 0.005);
  EXPECT_NEAR(k["draws"]["mean"], k["mean"], 4 * k["draws"]["mcse"].get<double>());
  EXPECT_NEAR(sigma["draws"]["mean"], sigma["mean"], 4 * sigma["draws"]["mcse"].get<double>());
  EXPECT_TRUE(summary["trusted"]);

  const json& prediction = summary["predictions"][0];
  EXPECT_EQ(prediction["cycles"], 20585);
  EXPECT_NEAR(prediction["pi05"], 74.83, 0.1);
  EXPECT_NEAR(prediction["pi95"], 115.71, 0.1);
  EXPECT_NEAR(prediction["ci05"], 77.33, 0.1);
  EXPECT_NEAR(prediction["ci95"], 113.18, 0.1);
  EXPECT_LT(prediction["pi05"], 92.73);
  EXPECT_GT(prediction["pi95"], 92.73);
  EXPECT_EQ(summary["stages"].size(), 5u);
  EXPECT_LT(summary["life"]["b1"], summary["life"]["b10"]);
}

TEST_F(FitCommand, MethodsAgree) {
  const json exact = fit_json(examples + "study.toml --method exact", 0);
  const json metropolis = fit_json(examples + "study.toml --method metropolis", 0);
  for (const char* name : {"k", "sigma"}) {
    const json& e = exact["parameters"][name];
    const json& m = metropolis["parameters"][name];
    EXPECT_NEAR(e["draws"]["mean"], e["mean"], 4 * e["draws"]["mcse"].get<double>());
    EXPECT_NEAR(m["draws"]["mean"], e["mean"], 4 * m["draws"]["mcse"].get<double>());
  }
  EXPECT_EQ(metropolis["sampler"]["draws"], 6000);
  EXPECT_EQ(metropolis["sampler"]["warmup"], 4000);
}

// Tables 6 and 7: every stage of the four examples against the grid of tests/golden/joint_grid.R.
TEST_F(FitCommand, ExamplesMeetTheGridOfTables6And7) {
  std::ifstream golden(PROJECT_SOURCE_DIR "/tests/golden/joint_grid.csv");
  std::string line, family, prior, cell;
  std::getline(golden, line);
  json summary;
  std::string loaded;
  int compared = 0;
  while (std::getline(golden, line)) {
    std::stringstream row(line);
    std::getline(row, family, ',');
    std::getline(row, prior, ',');
    std::vector<double> v;
    while (std::getline(row, cell, ',')) v.push_back(std::stod(cell));
    if (const std::string study = family + "_" + prior; study != loaded) {
      summary = fit_json(examples + study + ".toml", prior == "flat" ? 0 : 1);
      loaded = study;
    }
    const json& stage = summary["stages"][static_cast<std::size_t>(v[0]) - 1];
    const json& k = stage["parameters"]["k"];
    const auto near = [&](double actual, double expected) {
      EXPECT_NEAR(actual, expected, 0.002 * std::abs(expected)) << line;
      ++compared;
    };
    near(k["mean"].get<double>() * 1e4, v[2]);
    near(k["sd"].get<double>() * 1e4, v[3]);
    near(stage["parameters"]["sigma"]["mean"], v[4]);
    near(stage["parameters"]["sigma"]["sd"], v[5]);
    for (const json& p : stage["predictions"]) {
      if (p["cycles"] != v[1] || !p.contains("measured")) continue;
      near(p["ci05"], v[6]);
      near(p["ci95"], v[7]);
      near(p["pi05"], v[8]);
      near(p["pi95"], v[9]);
      break;
    }
  }
  EXPECT_EQ(compared, 20 * 8);
}

// Every row of the two tables in docs/explanation/validation.md ends with what the examples give.
TEST_F(FitCommand, TablesOfTheTutorialAreTrue) {
  const std::string tutorial = slurp(PROJECT_SOURCE_DIR "/docs/explanation/validation.md");
  const auto expect_row = [&](const std::string& beginning, const std::string& end) {
    const auto at = tutorial.find("\n" + beginning);
    ASSERT_NE(at, std::string::npos) << beginning;
    EXPECT_THAT(tutorial.substr(at + 1, tutorial.find('\n', at + 1) - at - 1),
                testing::EndsWith("| " + end + " |"));
  };
  for (const std::string likelihood : {"normal", "lognormal"}) {
    for (const std::string prior : {"flat", "tribometer"}) {
      const json summary =
          fit_json(examples + likelihood + "_" + prior + ".toml", prior == "flat" ? 0 : 1);
      for (std::size_t n = 3; n <= 6; ++n) {
        const json& stage = summary["stages"][n - 1];
        const json& k = stage["parameters"]["k"];
        expect_row(fmt::format("| {} | {} | {} |", likelihood, prior, n),
                   fmt::format("{:.2f}/{:.2f}", k["mean"].get<double>() * 1e4,
                               k["sd"].get<double>() * 1e4));
        if (prior != "flat") continue;
        const json& p = stage["predictions"][0];
        for (const std::string interval : {"ci", "pi"}) {
          expect_row(fmt::format("| {} | {} | {} | {} |", n, p["measured"].get<double>(),
                                 likelihood, interval == "ci" ? "CI" : "PI"),
                     fmt::format("{:.2f}..{:.2f}", p[interval + "05"].get<double>(),
                                 p[interval + "95"].get<double>()));
        }
      }
    }
  }
}

TEST_F(FitCommand, TribometerStudiesAreAPriorDataConflict) {
  for (const char* study : {"normal_tribometer.toml", "lognormal_tribometer.toml"}) {
    const json summary = fit_json(examples + study, 1);
    EXPECT_EQ(check(summary, "prior-data-conflict")["verdict"], "fail");
    EXPECT_FALSE(summary["trusted"]);
  }
}

TEST_F(FitCommand, ImproperPosteriorsExitWithOneAndSayWhy) {
  const json lognormal = fit_json(examples + "improper_lognormal.toml", 1);
  EXPECT_EQ(check(lognormal, "proper-posterior")["verdict"], "fail");
  EXPECT_THAT(check(lognormal, "proper-posterior")["detail"], HasSubstr("improper"));
  const json normal = fit_json(examples + "improper_normal.toml", 1);
  EXPECT_THAT(check(normal, "proper-posterior")["detail"],
              HasSubstr("the mean of k does not exist"));

  // With the bound that the advice asks for they are proper.
  std::string text = slurp(examples + "improper_normal.toml");
  text = std::regex_replace(text, std::regex("distribution = \"flat\", lower = \"0 mm\\^3\" "),
                            "distribution = \"uniform\", lower = \"0 mm^3\", upper = \"15 mm^3\" ");
  fs::copy(examples + "joint_wear.csv", folder() / "joint_wear.csv");
  EXPECT_TRUE(fit_json(write("bounded.toml", text).string(), 0)["trusted"]);
}

TEST_F(FitCommand, SameBitsForOneAndTwoThreads) {
  const fs::path one = folder() / "one", two = folder() / "two";
  for (const auto& [where, threads] : {std::pair{one, 1}, std::pair{two, 2}}) {
    const CommandResult run =
        run_wearwell("fit " + examples + "study.toml --threads " + std::to_string(threads) +
                     " --quiet -o " + where.string());
    ASSERT_EQ(run.exit_code, 0);
    EXPECT_EQ(run.out + run.err, "");
  }
  int files = 0;
  for (const auto& entry : fs::directory_iterator(one)) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".json" && extension != ".csv") continue;
    if (entry.path().filename() == "report.json") continue;  // holds the seconds that the fit took
    EXPECT_EQ(slurp(entry.path()), slurp(two / entry.path().filename())) << entry.path();
    ++files;
  }
  EXPECT_GE(files, 6);
}

TEST_F(FitCommand, LeavesTheFilesOfTheContract) {
  ASSERT_EQ(fit(examples + "study.toml --draws 400 --chains 2").exit_code, 0);
  const json summary = json::parse(slurp(results() / "summary.json"));
  for (const char* key : {"unit", "mean", "sd", "q05", "q50", "q95", "by", "draws"}) {
    EXPECT_TRUE(summary["parameters"]["k"].contains(key)) << key;
  }
  for (const char* key :
       {"mean", "sd", "mcse", "q05", "q50", "q95", "ess_bulk", "ess_tail", "rhat"}) {
    EXPECT_TRUE(summary["parameters"]["k"]["draws"].contains(key)) << key;
  }
  for (const char* key : {"mean", "ci05", "ci95", "pi05", "pi95"}) {
    EXPECT_TRUE(summary["predictions"][0].contains(key)) << key;
  }
  for (const char* key : {"name", "verdict", "detail"})
    EXPECT_TRUE(summary["checks"][0].contains(key)) << key;
  EXPECT_EQ(slurp(results() / "study.toml"), slurp(examples + "study.toml"));
  EXPECT_THAT(slurp(results() / "draws_2.csv"),
              HasSubstr("\nlp__,accept_stat__,stepsize__,treedepth__,n_leapfrog__,divergent__,"
                        "energy__,k,sigma\n"));
  EXPECT_THAT(slurp(results() / "predictions.csv"), HasSubstr("20585,volume,mm^3"));
}

TEST_F(FitCommand, OptionalConstantAndExponent) {
  std::string text = slurp(examples + "study.toml");
  text = std::regex_replace(text, std::regex("\\[update\\][^\\[]*"), "");
  text = std::regex_replace(
      text, std::regex("\\[prior\\]\n"),
      "[prior]\nV0 = { distribution = \"normal\", mean = \"0 mm^3\", sd = \"10 mm^3\" }\n");
  fs::copy(examples + "joint_wear.csv", folder() / "joint_wear.csv");
  const json constant = fit_json(write("constant.toml", text).string(), 0);
  // The reference: a constant term cuts the scatter of the first five sets to 0.43 mm^3 and
  // predicts 87.9 at the sixth.
  EXPECT_NEAR(constant["predictions"][0]["mean"], 87.9, 0.3);
  EXPECT_LT(constant["parameters"]["sigma"]["q05"], 0.6);
  text =
      std::regex_replace(text, std::regex("\\[prior\\]\n"),
                         "[prior]\nexponent = { distribution = \"normal\", mean = 1, sd = 0.1 }\n");
  const json both = fit_json(write("both.toml", text).string(), 0);
  EXPECT_EQ(both["parameters"].size(), 4u);
  EXPECT_EQ(both["parameters"]["exponent"]["by"], "quadrature");
}

// Work from a column, from force and slip, and from a profile; volume from pin positions.
TEST_F(FitCommand, OtherSourcesOfWorkAndVolume) {
  const std::string head =
      "model = \"archard-joint\"\n[likelihood]\nfamily = \"normal\"\n[prior]\n"
      "k = { distribution = \"flat\", unit = \"mm^3/(N m)\" }\n"
      "sigma = { distribution = \"half-normal\", scale = \"5 mm^3\" }\n";
  write("a.csv", "cycles,w,f,s,v\n100,600,60,10,6.1\n200,1200,60,20,11.8\n400,2400,60,40,24.3\n");
  const std::string volume = "volume = { column = \"v\", unit = \"mm^3\" }\ncycles = \"cycles\"\n";
  const std::string work = head + "[data]\nfile = \"a.csv\"\n[data.columns]\n" + volume +
                           "work = { column = \"w\", unit = \"J\" }\n[predict]\nwork_per_cycle = "
                           "\"6 J\"\ncycles = 800\n";
  const json by_work = fit_json(write("work.toml", work).string(), 0);
  EXPECT_NEAR(by_work["predictions"][0]["mean"], 48.4, 0.5);

  const std::string slip =
      head + "[data]\nfile = \"a.csv\"\n[data.columns]\n" + volume +
      "force = { column = \"f\", unit = \"N\" }\nslip = { column = \"s\", unit = \"m\" }\n";
  const json by_slip = fit_json(write("slip.toml", slip).string(), 0);
  EXPECT_NEAR(by_slip["parameters"]["k"]["mean"], by_work["parameters"]["k"]["mean"], 1e-9);
  EXPECT_NEAR(by_slip["pointwise"]["rows"][2]["k"], 24.3 / (60 * 40), 1e-12);

  write("profile.csv", "f,ds\n50,0.05\n70,0.05\n");
  const std::string profile = head + "[data]\nfile = \"a.csv\"\n[data.columns]\n" + volume +
                              "[conditions.profile]\nfile = \"profile.csv\"\nrule = \"rectangle\"\n"
                              "columns.force = { column = \"f\", unit = \"N\" }\n"
                              "columns.slip_increment = { column = \"ds\", unit = \"m\" }\n";
  const json by_profile = fit_json(write("profile.toml", profile).string(), 0);
  EXPECT_NEAR(by_profile["parameters"]["k"]["mean"], by_work["parameters"]["k"]["mean"], 1e-9);

  write("pin.csv", "cycles,x,y\n100,10,0\n100,0,10\n200,16,0\n200,0,16\n400,25,0\n400,0,25\n");
  const std::string pin =
      head +
      "[data]\nfile = \"pin.csv\"\n[data.columns]\ncycles = \"cycles\"\n"
      "dx = { column = \"x\", unit = \"um\" }\ndy = { column = \"y\", unit = \"um\" }\n"
      "[conditions]\nwork_per_cycle = \"6 J\"\npin_radius = \"9.5 mm\"\n"
      "bushing_radius = \"9.505 mm\"\nlength = \"20 mm\"\n";
  const json by_pin = fit_json(write("pin.toml", pin).string(), 0);
  EXPECT_GT(by_pin["parameters"]["k"]["mean"], 0);
}

// A count is a count in every multiple; work per cycle may say so.
TEST_F(FitCommand, CyclesInAnyUnitAreTheSame) {
  const auto run = [&](const std::string& cycles, const std::string& unit, const std::string& work,
                       const std::string& predict) {
    write("a.csv", "n,v\n" + cycles);
    return fit_json(write("a.toml",
                          "model = \"archard-joint\"\n[data]\nfile = \"a.csv\"\n[data.columns]\n"
                          "cycles = { column = \"n\", unit = \"" +
                              unit +
                              "\" }\nvolume = { column = \"v\", unit = \"mm^3\" }\n[conditions]\n"
                              "work_per_cycle = \"" +
                              work +
                              "\"\n[likelihood]\nfamily = \"normal\"\n[prior]\n"
                              "k = { distribution = \"flat\", unit = \"mm^3/J\" }\n"
                              "sigma = { distribution = \"half-normal\", scale = \"2 mm^3\" }\n"
                              "[predict]\ncycles = " +
                              predict + "\nlimit = \"60 mm^3\"\n")
                        .string(),
                    0);
  };
  const std::string plain = "4000,8.2\n9000,17.5\n16000,32.6\n",
                    thousands = "4,8.2\n9,17.5\n16,32.6\n";
  const json expected = run(plain, "1", "7.5 J", "25000");
  EXPECT_EQ(expected["predictions"][0]["cycles"], 25000);
  for (const auto& [cycles, unit, work, predict] :
       {std::array{plain, std::string("cycles"), std::string("7.5 N m/cycle"),
                   std::string("[25000]")},
        std::array{thousands, std::string("kcycles"), std::string("7.5 kJ/kcycle"),
                   std::string("'25 kcycles'")},
        std::array{thousands, std::string("1e3 strokes"), std::string("7.5 Nm/stroke"),
                   std::string("'0.025 Mcycles'")}}) {
    const json other = run(cycles, unit, work, predict);
    EXPECT_EQ(other["predictions"][0]["cycles"], 25000) << unit;
    EXPECT_NEAR(double(other["predictions"][0]["mean"]), double(expected["predictions"][0]["mean"]),
                1e-9)
        << unit;
    EXPECT_NEAR(double(other["life"]["b10"]) / double(expected["life"]["b10"]), 1, 1e-9) << unit;
    EXPECT_NEAR(double(other["parameters"]["k"]["mean"]),
                double(expected["parameters"]["k"]["mean"]), 1e-12)
        << unit;
  }
}

// Cycles in thousands whose unit was forgotten below one, volumes of cubic metres: a word about it.
TEST_F(FitCommand, MistakenUnitsAreNamed) {
  const auto found = [&](const std::string& cycles, const std::string& unit) {
    write("a.csv", "cycles,v\n" + cycles);
    return fit_json(write("a.toml",
                          "model = \"archard-joint\"\n[data]\nfile = \"a.csv\"\n"
                          "[data.columns]\ncycles = \"cycles\"\n"
                          "volume = { column = \"v\", unit = \"" +
                              unit +
                              "\" }\n"
                              "[conditions]\nwork_per_cycle = \"7.5 J\"\n"
                              "[likelihood]\nfamily = \"normal\"\n[prior]\n"
                              "k = { distribution = \"flat\", unit = \"mm^3/J\" }\n"
                              "sigma = { distribution = \"half-normal\", scale = \"2 " +
                              unit + "\" }\n")
                        .string(),
                    0);
  };
  const json parts = found("0.4,8.2\n0.9,17.5\n1.6,32.6\n", "mm^3");
  EXPECT_EQ(check(parts, "units")["verdict"], "warn");
  EXPECT_THAT(check(parts, "units")["detail"], HasSubstr("cycles: 2 of 3 counts are below 1"));
  const json large = found("400,8.2\n900,17.5\n1600,32.6\n", "m^3");
  EXPECT_THAT(check(large, "units")["detail"], HasSubstr("volume: the largest value is 32.6 m^3"));
  EXPECT_THROW(check(found("400,8.2\n900,17.5\n1600,32.6\n", "mm^3"), "units"), std::runtime_error);
}

// Where cubes and squares of the data leave the range of doubles: one message, and no internal error.
TEST_F(FitCommand, ValuesBeyondDoublesAreRefusedByName) {
  for (const char* power : {"e-300", "e-120", "e-80"}) {
    std::string table = "cycles,volume\n";
    for (const char* row : {"1,4.44", "100,5.105", "1000,8.825", "5000,24.175", "10000,45.31"})
      table += row + std::string(power) + "\n";
    write("a.csv", table);
    const auto study =
        write("a.toml",
              "model = \"archard-joint\"\n[data]\nfile = \"a.csv\"\n[data.columns]\ncycles = "
              "\"cycles\"\nvolume = { column = \"volume\", unit = \"mm^3\" }\n[conditions]\n"
              "work_per_cycle = \"5.966 N m\"\n[likelihood]\nfamily = \"lognormal\"\n[prior]\n"
              "k = { distribution = \"flat\", lower = \"0 mm^3/(N m)\" }\n"
              "sigma = { distribution = \"uniform\", lower = \"0 mm^3\", upper = \"7 mm^3\" }\n");
    const CommandResult run = fit(study.string() + " --draws 100");
    EXPECT_EQ(run.err.find("internal error"), std::string::npos) << run.err;
    if (power == std::string("e-80")) {
      EXPECT_LE(run.exit_code, 2) << run.err;
    } else {
      EXPECT_EQ(run.exit_code, 2);
      EXPECT_THAT(run.err, HasSubstr("row 1, column 'volume': 4.44"));
      EXPECT_THAT(run.err, HasSubstr("mm^3 is too small to compute with"));
    }
  }
}

// A label that commands a terminal (ECMA-48) or turns text round (Unicode Standard Annex 9) is the
// same harmless text in every file, and a command finds it by that text and by what the table has.
TEST_F(FitCommand, LabelsCommandNoTerminal) {
  const std::string bearing = PROJECT_SOURCE_DIR "/examples/bearing/";
  std::string table = slurp(bearing + "inspections.csv");
  const std::string label = "\x1b]0;owned\x07\u202e\u200f!",
                    shown = R"(\x1b]0;owned\x07\u202e\u200f!)";
  for (std::size_t at = 0; (at = table.find("\nA,", at)) != table.npos; at += 3)
    table.replace(at + 1, 1, label);
  write("inspections.csv", table);
  const auto study =
      write("study.toml", slurp(bearing + "study.toml") + "life_of = '" + shown + "'\n");
  ASSERT_LE(fit(study.string() + " --draws 100").exit_code, 1);
  int files = 0, naming = 0;
  for (const auto& each : fs::recursive_directory_iterator(results())) {
    if (!each.is_regular_file() || each.path().filename() == "state.bin") continue;
    ++files;
    const std::string text = slurp(each.path());
    naming += text.find("owned") != text.npos;
    for (const char* bad : {"\x1b", "\x07", "\u202e", "\u200f"})
      EXPECT_EQ(text.find(bad), text.npos) << each.path();
  }
  EXPECT_GT(files, 5);
  EXPECT_GE(naming, 3);  // study, summary and report
  for (const std::string& asked : {shown, label}) {
    const CommandResult life =
        run_wearwell("life '" + results().string() + "' --unit '" + asked + "'");
    EXPECT_LE(life.exit_code, 1) << life.err;
    EXPECT_THAT(life.out, HasSubstr(shown));
  }
}

// Quadrature that was asked for and does not reach is said to be none before the run, and after.
TEST_F(FitCommand, ExactBeyondFourParametersIsSaidToBeASampler) {
  write("a.csv",
        "a,b,c,y\n1,2,0,3.1\n2,1,1,4.2\n3,3,0,7.9\n4,1,2,9.3\n5,2,1,11.2\n6,1,0,10.1\n"
        "7,3,1,16.2\n8,2,2,17.1\n");
  const auto study =
      write("a.toml",
            "model = \"formula\"\n[data]\nfile = \"a.csv\"\n[data.columns]\na = \"a\"\n"
            "b = \"b\"\nc = \"c\"\ny = \"y\"\n[likelihood.y]\nfamily = \"normal\"\n"
            "mean = \"p + q*a + r*b + t*c\"\nsd = \"s\"\n[prior]\n"
            "p = { distribution = \"normal\", mean = 0, sd = 5 }\n"
            "q = { distribution = \"normal\", mean = 0, sd = 5 }\n"
            "r = { distribution = \"normal\", mean = 0, sd = 5 }\n"
            "t = { distribution = \"normal\", mean = 0, sd = 5 }\n"
            "s = { distribution = \"half-normal\", scale = 1 }\n"
            "[sampler]\nmethod = \"exact\"\n")
          .string();
  const char* const said =
      "Method: NUTS instead of quadrature (--method exact): 5 "
      "parameters exceed the limit of quadrature (4)";
  EXPECT_THAT(run_wearwell("check " + study).out, HasSubstr("by nuts, 4 chains"));
  const auto in_one_line = [](std::string text) {
    return std::regex_replace(text, std::regex("\n +"), " ");
  };
  EXPECT_THAT(in_one_line(run_wearwell("check " + study).out), HasSubstr(said));
  const CommandResult run = fit(study);
  EXPECT_LE(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr(said));
  const std::string out = in_one_line(run.out);
  EXPECT_LT(out.find(said), out.find("Answers"));
  EXPECT_THAT(out, HasSubstr("Draws (nuts, 4 chains"));
  const json summary = json::parse(slurp(results() / "summary.json"));
  EXPECT_EQ(summary["sampler"]["method"], "nuts");
  EXPECT_THAT(summary["sampler"]["note"].get<std::string>(), HasSubstr(said));
  EXPECT_FALSE(summary["parameters"]["p"].contains("exact"));
  EXPECT_THAT(slurp(results() / "report.html"), HasSubstr(said));
  // One fewer, and quadrature does what it was asked to.
  EXPECT_EQ(
      fit_json(examples + "study.toml --method exact --draws 100", 0)["sampler"].count("note"), 0u);
}

// Study and data are changed while the fit runs: the results hold what was run.
TEST_F(FitCommand, KeepsTheStudyThatWasRun) {
  fs::copy(examples + "study.toml", folder() / "study.toml");
  fs::copy(examples + "joint_wear.csv", folder() / "joint_wear.csv");
  const std::string before = slurp(folder() / "study.toml");
  const std::string sums = run_command("cd '" + folder().string() + "' && sha1sum *").out;
  const CommandResult run = run_command(
      "cd '" + folder().string() +
      "'; '" WEARWELL_BINARY
      "' fit study.toml -o results --quiet "
      "--method metropolis --draws 20000 & while ! ls -d .wearwell.* 2>/dev/null >&2; do :; done; "
      "echo '# edited' >> study.toml; echo 1,1 >> joint_wear.csv; wait $!");
  ASSERT_LE(run.exit_code, 1) << run.err;
  EXPECT_EQ(slurp(results() / "study.toml"), before);
  const std::string report = slurp(results() / "report.html");
  EXPECT_THAT(report, HasSubstr(sums.substr(0, 40)));
  EXPECT_THAT(report, HasSubstr(sums.substr(sums.find('\n') + 1, 40)));
  EXPECT_EQ(report.find("# edited"), std::string::npos);
}

TEST_F(FitCommand, EndsBySignalAtOnceAndLeavesNothing) {
  for (const auto& [signal, exit_code] : {std::pair("INT", 130), {"TERM", 143}, {"HUP", 129}}) {
    const CommandResult run =
        run_command("cd '" + folder().string() + "'; timeout --preserve-status --signal=" + signal +
                    " 1 '" WEARWELL_BINARY "' fit " + examples +
                    "study.toml --method metropolis --draws 1000000 -o results");
    EXPECT_EQ(run.exit_code, exit_code) << run.err;
    EXPECT_TRUE(fs::is_empty(folder())) << signal;
  }
}

class BadInput : public FitCommand {
 protected:
  // A study that works, with one text replaced.
  std::string study(const std::string& what, const std::string& with) {
    std::string text = slurp(examples + "study.toml");
    const auto at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    text.replace(at, what.size(), with);
    fs::copy(examples + "joint_wear.csv", folder() / "joint_wear.csv",
             fs::copy_options::overwrite_existing);
    return write("study.toml", text).string();
  }
  std::string csv_study(const std::string& csv, const std::string& family = "normal") {
    write("a.csv", csv);
    return write("study.toml",
                 "model = \"archard-joint\"\n[data]\nfile = \"a.csv\"\n[data.columns]\ncycles = "
                 "\"cycles\"\n"
                 "volume = { column = \"volume\", unit = \"mm^3\" }\n[conditions]\nwork_per_cycle "
                 "= \"6 N m\"\n"
                 "[likelihood]\nfamily = \"" +
                     family +
                     "\"\n[prior]\nk = { distribution = \"flat\", unit = \"mm^3/J\" }\n"
                     "sigma = { distribution = \"uniform\", lower = \"0 mm^3\", upper = \"15 "
                     "mm^3\" }\n")
        .string();
  }
  // Exit code 2, one line that names the place, nothing written.
  void expect_refused(const std::string& arguments, const std::string& message) {
    const CommandResult run = fit(arguments);
    EXPECT_EQ(run.exit_code, 2) << run.out;
    EXPECT_EQ(run.out, "");
    EXPECT_THAT(run.err, HasSubstr(message));
    EXPECT_EQ(messages_in(run.err), 1u) << run.err;
    EXPECT_FALSE(fs::exists(results()));
    for (const auto& entry : fs::directory_iterator(folder())) {
      EXPECT_THAT(entry.path().filename().string(), testing::Not(testing::StartsWith(".")))
          << "left behind";
    }
  }
};

TEST_F(BadInput, Files) {
  expect_refused((folder() / "none.toml").string(), "no such file");
  expect_refused(folder().string(), "is a folder");
  expect_refused(write("empty.toml", "").string(), "empty.toml is empty");
  expect_refused(write("broken.toml", "model = \n").string(), "broken.toml:1:");
  expect_refused(study("joint_wear.csv", "none.csv"), "no such file");
  expect_refused(csv_study(""), "a.csv is empty");
  expect_refused(csv_study("cycles,volume\n"), "a.csv has no rows");
  expect_refused(csv_study("cycles,volume\n100,5\n"), "has 1 inspection");
}

TEST_F(BadInput, Columns) {
  expect_refused(csv_study("cycles,volum\n1,2\n3,4\n"),
                 "has no column 'volume' (nearest: 'volum')");
  expect_refused(csv_study("cycles,volume\n1,2\n3,x4\n"),
                 "row 2, column 'volume': 'x4' is not a number");
  expect_refused(csv_study("cycles,volume\n1,2\n3,nan\n"), "row 2, column 'volume': no value");
  expect_refused(csv_study("cycles,volume\n1,2\n3,\n"), "row 2, column 'volume': no value");
  expect_refused(csv_study("cycles,volume\n-1,2\n3,4\n"),
                 "row 1, column 'cycles': -1 must be 0 or more");
  expect_refused(csv_study("cycles,volume,volume\n1,2,3\n3,4,5\n"),
                 "two columns named 'volume': columns 2 and 3");
  expect_refused(csv_study("cycles,volume\n1,2\n3,-4\n", "lognormal"),
                 "row 2, column 'volume': -4 must be positive for the lognormal likelihood");
}

TEST_F(BadInput, UnitsAndKeys) {
  expect_refused(study("unit = \"mm^3\"", "unit = \"mm^2\""),
                 "volume.unit: unit 'mm^2' has the wrong dimension");
  expect_refused(study("5.966 N m", "5.966 N"),
                 "conditions.work_per_cycle: unit 'N' has the wrong dimension");
  expect_refused(study("\"5.966 N m\"", "5.966"), "has no unit");
  expect_refused(study("5.966 N m", "5.966 N m/rad"), "unit 'N m/rad' contains an angle");
  expect_refused(study("5.966 N m", "5 966 N m"), "is ambiguous: one number with a gap");
  expect_refused(study("cycles = \"cycles\"", "cycles = { column = \"cycles\", unit = \"rad\" }"),
                 "cycles.unit: unit 'rad' contains an angle");
  expect_refused(study("unit = \"mm^3\"", "unit = \"1/mm^3\""),
                 "is the reciprocal of the expected unit");
  expect_refused(study("unit = \"mm^3\"", "unit = \"lg(re 1 mm^3)\""), "is a logarithm");
  expect_refused(study("cycles = [20585]", "cycles = \"20 585\""), "a gap");
  expect_refused(study("risk   = \"1 %\"", "risk = \"1 cycle\""), "contains a count");
  expect_refused(
      study("lower = \"0 mm^3/(N m)\"", "lowr = \"0 mm^3/(N m)\", unit = \"mm^3/(N m)\""),
      "prior.k.lowr: unknown key; did you mean 'lower'?");
  expect_refused(study("lower = \"0 mm^3\"", "lower = \"20 mm^3\""),
                 "prior.sigma.upper: the lower bound 20 is not below the upper bound 15");
  expect_refused(study("\"uniform\"", "\"unifrom\""), "nearest: 'uniform'");
  expect_refused(study("family = \"normal\"", "family = \"weibull\""), "normal, lognormal");
  expect_refused(study("archard-joint", "archard"), "nearest: 'archard-joint'");
  expect_refused(study("risk   = \"1 %\"", "risk = 2"), "predict.risk: must lie between 0 and 1");
}

TEST_F(BadInput, ContradictionsAndOptions) {
  expect_refused(study("cycles = \"cycles\"",
                       "cycles = \"cycles\"\nwork = { column = \"volume\", unit = \"J\" }"),
                 "the work is given twice");
  expect_refused(examples + "study.toml --json --quiet", "--quiet");
  expect_refused(examples + "study.toml --method gibbs", "gibbs");
  expect_refused(examples + "study.toml --draws 1", "draws");
  expect_refused("", "STUDY");
}

TEST_F(BadInput, OutputFolder) {
  const auto refused = [](const std::string& output, const std::string& message) {
    const CommandResult run = run_wearwell("fit " + examples + "study.toml -o '" + output + "'");
    EXPECT_EQ(run.exit_code, 2) << output;
    EXPECT_THAT(run.err, HasSubstr(message));
  };
  refused("/proc/results", "cannot write to /proc");
  refused(write("file", "x").string(), "not a folder");
  fs::create_directory(folder() / "full");
  write("full/precious.txt", "mine");
  refused((folder() / "full").string(), "will not replace");
  EXPECT_EQ(slurp(folder() / "full/precious.txt"), "mine");
}

}  // namespace
}  // namespace wearwell
