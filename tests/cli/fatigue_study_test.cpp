// `wearwell fit` of S-N studies, as its user meets it.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "support/run_command.h"
#include "support/scratch.h"
#include "wearwell/input/table.h"

namespace wearwell {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const std::string example = PROJECT_SOURCE_DIR "/examples/spring/";

// tests/golden/spring_blives.csv: (case, parameter or type) and its five numbers.
std::map<std::string, std::vector<double>> golden() {
  const Table table = read_table(
      PROJECT_SOURCE_DIR "/tests/golden/spring_blives.csv",
      "select concat(\"case\"::integer, ' ', name) as key, v1, v2, v3, v4, v5 from data");
  std::map<std::string, std::vector<double>> values;
  for (std::size_t i = 0; i < table.rows; ++i) {
    for (int v = 1; v <= 5; ++v) {
      values[table.columns[0].text[i]].push_back(
          table.columns[static_cast<std::size_t>(v)].numbers[i]);
    }
  }
  return values;
}

class FatigueStudy : public ScratchTest {
 protected:
  json fit(const std::string& study, const std::string& options) {
    const CommandResult run = run_wearwell("fit '" + study + "' --json --no-report -o '" +
                                           (folder() / "out").string() + "' " + options);
    EXPECT_LE(run.exit_code, 1) << run.err;  // 1: a check failed
    return json::parse(run.out);
  }
  json fit_text(const std::string& study,
                const std::string& options = "--method exact --draws 50") {
    return fit(write("study.toml", study).string(), options);
  }

  // The message of a study that is refused.
  std::string refusal(const std::string& study) {
    const auto file = write("study.toml", study);
    const CommandResult run =
        run_wearwell("fit '" + file.string() + "' -o '" + (folder() / "out").string() + "'");
    EXPECT_EQ(run.exit_code, 2) << study << run.out;
    EXPECT_FALSE(std::filesystem::exists(folder() / "out"));
    return run.err;
  }
};

const json& quantity(const json& result, const std::string& name, const std::string& of) {
  for (const json& each : result["quantities"]) {
    if (each["name"] == name && each["of"] == of) return each;
  }
  throw std::runtime_error("no " + name + " of " + of);
}

const json& check(const json& result, const std::string& name) {
  for (const json& each : result["checks"]) {
    if (each["name"] == name) return each;
  }
  throw std::runtime_error("no check " + name);
}

// The numbers in a cell of the tutorial's table, "2.81 / 3.00 / 3.28", in the row that begins so.
std::vector<double> cell(const std::string& beginning, int column) {
  std::ifstream text(PROJECT_SOURCE_DIR "/docs/explanation/validation.md");
  for (std::string line; std::getline(text, line);) {
    if (line.rfind(beginning, 0) != 0) continue;
    std::stringstream row(line), numbers;
    std::string word;
    for (int i = 0; i <= column; ++i) std::getline(row, word, '|');
    numbers.str(word);
    std::vector<double> values;
    for (std::string number; std::getline(numbers, number, '/');)
      values.push_back(std::stod(number));
    return values;
  }
  throw std::runtime_error("no row " + beginning);
}

// Tables 6 and 7 of Heo et al. (2011) with the settings that reproduce them, against R on a grid
// (spring_blives.R), in which one parameter is integrated by hand. Its midpoint rule is 1e-3 good.
TEST_F(FatigueStudy, CasesAgreeWithTheGridOfR) {
  // Independent of that grid, to the digits of the paper.
  const std::map<std::string, std::vector<double>> checked = {
      {"case1", {3.002, -0.0872, 3.939, 0.340}}, {"case2", {2.945, -0.0897, 4.145, 0.278}}};
  const auto expected = golden();
  std::map<std::string, double> width;  // of the 90 % interval
  for (const std::string study : {"case1", "case2"}) {
    const json result = fit(example + study + ".toml", "--method exact --draws 100");
    // With nine tests the data show a steeper line than the bound of b allows: the residuals follow
    // the stress, and the check of fit says so.
    EXPECT_EQ(result["trusted"], study == "case1");
    for (const json& check : result["checks"]) {
      EXPECT_TRUE(check["verdict"] != "fail" || check["name"] == "fit") << check;
    }
    const std::string number = study.substr(4);
    std::size_t i = 0;
    for (const std::string name : {"log10_a", "b", "log10_Sut", "sigma"}) {
      const json& exact = result["parameters"][name];
      EXPECT_NEAR(double(exact["mean"]) / checked.at(study)[i++], 1, 0.01) << name;
      const auto& grid = expected.at(number + " " + name);
      const double sd = grid[1];
      EXPECT_NEAR(exact["mean"], grid[0], 2e-3 * sd) << study << " " << name;
      EXPECT_NEAR(double(exact["sd"]) / sd, 1, 2e-3) << study << " " << name;
      // Quantiles spread each node of the quadrature over its cell.
      EXPECT_NEAR(exact["q05"], grid[2], 1e-2 * sd) << study << " " << name;
      EXPECT_NEAR(exact["q50"], grid[3], 1e-2 * sd) << study << " " << name;
      EXPECT_NEAR(exact["q95"], grid[4], 1e-2 * sd) << study << " " << name;
      const double here = double(exact["q95"]) - double(exact["q05"]);
      if (study == "case2") {
        EXPECT_LT(here, width[name]) << name << ": more data narrow it";
      }
      width[name] = here;
      const auto reported = cell(fmt::format("| {} | {} |", name, number), 4);
      EXPECT_NEAR(reported.at(0), exact["q05"], 0.01 * here) << study << " " << name;
      EXPECT_NEAR(reported.at(1), exact["mean"], 0.01 * here) << study << " " << name;
      EXPECT_NEAR(reported.at(2), exact["q95"], 0.01 * here) << study << " " << name;
    }
    for (const std::string type : {"A", "B", "C", "D", "E", "F", "G"}) {
      if (study == "case1" && type == "G") continue;
      const auto& grid = expected.at(number + " " + type);
      const json& life = quantity(result, "life", "new type " + type);
      const json& b1 = quantity(result, "B1 life", "type " + type);
      const json& b10 = quantity(result, "B10 life", "type " + type);
      const auto near = [&](const json& value, double cycles, double tolerance) {
        EXPECT_NEAR(double(value) * 1e5 / cycles, 1, tolerance) << study << ", type " << type;
      };
      const int column = number == "1" ? 5 : 7;  // beside the paper's
      near(life["b1"], 1e5 * cell(fmt::format("| {} | B1 |", type), column).at(0), 2e-3);
      near(life["b10"], 1e5 * cell(fmt::format("| {} | B10 |", type), column).at(0), 2e-3);
      near(life["b1"], grid[0], 1e-3);
      near(life["b10"], grid[1], 1e-3);
      near(life["b50"], grid[2], 1e-3);
      near(b1["predictive"], grid[0], 1e-3);
      near(b10["predictive"], grid[1], 1e-3);
      near(b1["bound"], grid[3], 1e-2);
      near(b10["bound"], grid[4], 1e-2);
    }
  }
}

// Type F lies below its B10, the six others above theirs, as in the paper; NUTS agrees with
// quadrature.
TEST_F(FatigueStudy, CoverageFindsTypeF) {
  const json result = fit(example + "case2.toml", "");
  for (const auto& [name, p] : result["parameters"].items()) {
    EXPECT_NEAR(double(p["draws"]["mean"]), double(p["mean"]), 4 * double(p["draws"]["mcse"]))
        << name;
  }
  ASSERT_EQ(result["coverage"]["rows"].size(), 9u);
  EXPECT_EQ(result["coverage"]["unit"], "1e5 cycles");
  for (const json& row : result["coverage"]["rows"]) {
    EXPECT_EQ(row["below_b10"], row["label"] == "F");
    EXPECT_EQ(double(row["probability"]) < 0.1, row["label"] == "F");
  }
  EXPECT_EQ(check(result, "percentile-support")["verdict"], "warn");
  EXPECT_EQ(check(result, "extrapolation")["verdict"], "pass");
}

const std::string head = "model = \"sn\"\n[data]\nfile = \"data.csv\"\n[data.columns]\n";
const std::string columns = R"toml(alternating_stress = { column = "s", unit = "MPa" }
life = "n"
)toml";
const std::string law = "[law]\nmean_stress = \"none\"\n";
const std::string prior = R"toml([prior]
log10_a = { distribution = "normal", mean = "3.5 log10(MPa)", sd = 0.5 }
b = { distribution = "normal", mean = -0.1, sd = 0.03 }
sigma = { distribution = "half-normal", scale = 0.3 }
)toml";
const std::string some_data = "s,n,end\n400,31000,F\n350,95000,F\n300,420000,F\n260,1300000,F\n";

TEST_F(FatigueStudy, MoreStressIsNeverMoreLife) {
  write("data.csv", "s,m,n\n400,100,31000\n350,200,60000\n300,150,420000\n260,300,900000\n");
  std::string points;
  for (int i = 0; i < 4; ++i) {
    points += fmt::format(
        "a{0} = {{ alternating_stress = \"{1} MPa\", mean_stress = \"150 MPa\" }}\n"
        "m{0} = {{ alternating_stress = \"300 MPa\", mean_stress = \"{2} MPa\" }}\n",
        i, 270 + 30 * i, -100 + 100 * i);
  }
  for (const std::string correction : {"goodman", "swt"}) {
    const std::string strength =
        correction == "goodman" ? "[conditions]\nS_ut = \"1500 MPa\"\n" : "";
    const json result =
        fit_text(head + columns + "mean_stress = { column = \"m\", unit = \"MPa\" }\n" + strength +
                 "[law]\nmean_stress = \"" + correction + "\"\n" + prior +
                 "[predict]\nb_lives = [1, 50]\nsurvival_to = 2e5\n"
                 "[predict.stress]\n" +
                 points);
    for (int i = 0; i + 1 < 4; ++i) {
      for (const char* kind : {"a", "m"}) {
        const std::string here = fmt::format("{}{}", kind, i),
                          more = fmt::format("{}{}", kind, i + 1);
        for (const char* name : {"B1 life", "B50 life", "survival to 200000 cycles"}) {
          for (const char* what : {"predictive", "bound", "q05", "q95"}) {
            EXPECT_GE(double(quantity(result, name, here)[what]),
                      double(quantity(result, name, more)[what]) * (1 - 1e-9))
                << correction << " " << name << " " << what << " " << here;
          }
        }
      }
    }
  }
}

// The ratio of a part is not that of the tests, and no correction is chosen: the lives are those of the tests' ratio.
TEST_F(FatigueStudy, WarnsOfAStressRatioThatNothingCorrectsFor) {
  write("data.csv", some_data);
  const auto detail = [&](const char* ratio) {
    const json result = fit_text(
        head + columns + "status = \"end\"\n[conditions]\nstress_ratio = -1\n" + law + prior +
        "[predict]\nb_lives = [10]\n[predict.stress]\nx = { alternating_stress = \"300 MPa\", "
        "stress_ratio = " +
        ratio + " }\n");
    for (const json& check : result["checks"])
      if (check["name"] == "extrapolation") return check["detail"].get<std::string>();
    return std::string();
  };
  EXPECT_THAT(detail("0.5"),
              HasSubstr("the stress ratio of x, 0.5, lies outside those tested (-1 to -1)"));
  EXPECT_THAT(detail("-1"), Not(HasSubstr("stress ratio")));
}

// A test that was stopped unbroken says no less than that its life is at least as long. Where slope
// and scatter are known, that lengthens life under every stress: the likelihood of the curve's height
// changes by one over a hazard, which falls with the height. Where they are not, a longer life under
// one stress turns the curve, and what must not shorten is the life under that stress.
TEST_F(FatigueStudy, ARunoutNeverShortensLife) {
  const std::string known = R"toml([prior]
log10_a = { distribution = "normal", mean = "3.5 log10(MPa)", sd = 0.5 }
b = { distribution = "uniform", lower = -0.1001, upper = -0.0999 }
sigma = { distribution = "uniform", lower = 0.1999, upper = 0.2001 }
)toml";
  const std::string ask =
      "[predict]\nb_lives = [50]\n[predict.stress]\n"
      "s400 = { alternating_stress = \"400 MPa\" }\ns350 = { alternating_stress = \"350 MPa\" }\n"
      "s300 = { alternating_stress = \"300 MPa\" }\ns260 = { alternating_stress = \"260 MPa\" }\n";
  const std::pair<std::string, std::string> tests[] = {
      {"31000", "s400"}, {"95000", "s350"}, {"420000", "s300"}, {"1300000", "s260"}};
  for (const bool all_known : {true, false}) {
    const std::string study =
        head + columns + "status = \"end\"\n" + law + (all_known ? known : prior) + ask;
    write("data.csv", some_data);
    const json failed = fit_text(study);
    for (const auto& [life, own] : tests) {
      std::string data = some_data;
      data[data.find(life + ",F") + life.size() + 1] = 'S';
      write("data.csv", data);
      const json stopped = fit_text(study);
      for (const auto& test : tests) {
        const std::string& where = test.second;
        if (!all_known && where != own) continue;
        for (const std::string what : {"predictive", "q05", "q50", "q95"}) {
          if (!all_known && what == "q05") continue;  // more scatter widens it
          EXPECT_GT(double(quantity(stopped, "B50 life", where)[what]),
                    double(quantity(failed, "B50 life", where)[what]))
              << life << " " << where << " " << what;
        }
      }
    }
  }
}

TEST_F(FatigueStudy, UnitsDoNotMatter) {
  const std::string ask =
      "[predict]\nb_lives = [10]\nrequired_life = 1e6\nreliability = 0.9\n"
      "[predict.stress]\nhere = { alternating_stress = \"300 MPa\" }\n";
  write("data.csv", some_data);
  const json mpa = fit_text(head + columns + law + prior + ask);
  const double ksi = 6.894757293168361;  // MPa
  write("data.csv", fmt::format("s,n\n{:.12g},31\n{:.12g},95\n{:.12g},420\n{:.12g},1300\n",
                                400 / ksi, 350 / ksi, 300 / ksi, 260 / ksi));
  const json other = fit_text(head +
                              "alternating_stress = { column = \"s\", unit = \"ksi\" }\n"
                              "life = { column = \"n\", unit = \"1000 cycles\" }\n" +
                              law +
                              fmt::format("[prior]\nlog10_a = {{ distribution = \"normal\", mean = "
                                          "\"{:.12g} log10(ksi)\", sd = 0.5 }}\n",
                                          3.5 - std::log10(ksi)) +
                              prior.substr(prior.find("b = ")) + ask);
  const auto mean = [](const json& result, const char* name) -> double {
    return result["parameters"][name]["mean"];
  };
  EXPECT_NEAR(mean(other, "log10_a") + std::log10(ksi), mean(mpa, "log10_a"), 1e-6);
  EXPECT_NEAR(mean(other, "b") / mean(mpa, "b"), 1, 1e-6);
  EXPECT_NEAR(mean(other, "sigma") / mean(mpa, "sigma"), 1, 1e-6);
  const auto b10 = [](const json& result) -> double {
    return quantity(result, "B10 life", "here")["bound"];
  };
  EXPECT_NEAR(b10(other) * 1000 / b10(mpa), 1, 1e-6);
  const auto allowed = [](const json& result) -> double {
    return quantity(result, "allowed alternating stress", "specimen")["predictive"];
  };
  EXPECT_NEAR(allowed(other) * ksi / allowed(mpa), 1, 1e-6);
}

// Lives in any unit of counting.
TEST_F(FatigueStudy, LivesAreCounted) {
  const std::string ask =
      "[predict]\nb_lives = [10]\n[predict.stress]\nhere = { alternating_stress = \"300 MPa\" }\n";
  const auto lives = [](double unit) {
    return fmt::format("s,n\n400,{}\n350,{}\n300,{}\n260,{}\n", 31000 / unit, 95000 / unit,
                       420000 / unit, 1300000 / unit);
  };
  const auto fit_lives = [&](const std::string& unit, double size) {
    write("data.csv", lives(size));
    return fit_text(head +
                    "alternating_stress = { column = \"s\", unit = \"MPa\" }\n"
                    "life = { column = \"n\", unit = \"" +
                    unit + "\" }\n" + law + prior + ask);
  };
  const json expected = fit_lives("1", 1);
  for (const auto& [unit, size] :
       {std::pair{"revolutions", 1.0}, {"krev", 1e3}, {"reversals", 0.5}}) {
    const json result = fit_lives(unit, size);
    EXPECT_NEAR(double(result["parameters"]["log10_a"]["mean"]),
                double(expected["parameters"]["log10_a"]["mean"]), 1e-6)
        << unit;
    const json& life = quantity(result, "B10 life", "here");
    EXPECT_EQ(life["unit"], unit);
    EXPECT_NEAR(double(life["predictive"]) * size /
                    double(quantity(expected, "B10 life", "here")["predictive"]),
                1, 1e-6)
        << unit;
  }
}

// The scatter of a life that is not a logarithm is a count too.
TEST_F(FatigueStudy, RefusesAScatterOfLifeWithTwoReadings) {
  write("data.csv", "s,n\n400,0.31\n350,0.95\n300,4.2\n260,13\n");
  const auto with_sigma = [&](const std::string& sigma) {
    return head +
           "alternating_stress = { column = \"s\", unit = \"MPa\" }\n"
           "life = { column = \"n\", unit = \"1e5 cycles\" }\n" +
           law + "[likelihood]\nfamily = \"normal\"\n" + prior.substr(0, prior.find("sigma")) +
           "sigma = { distribution = \"half-normal\", " + sigma + " }\n";
  };
  EXPECT_THAT(
      refusal(with_sigma("scale = 2, unit = \"1e5 cycles\"")),
      AllOf(HasSubstr("prior.sigma.scale: 2 is given beside '1e5 cycles'"), HasSubstr("= 200000")));
  EXPECT_THAT(refusal(with_sigma("scale = \"2 rad\"")), HasSubstr("contains an angle"));
}

// The same cycles of stress, however they are written.
TEST_F(FatigueStudy, EveryWayToWriteAStressIsTheSame) {
  const double d = 3, D = 22, n = 5, G = 79300, C = D / d;  // mm, MPa
  const double per_mm =
      ((4 * C - 1) / (4 * C - 4) + 0.615 / C) * G * d / (std::numbers::pi * D * D * n);
  const double amplitude[] = {9, 8, 7.5, 6.5}, mean[] = {12, 12.5, 13, 13};
  const int lives[] = {31000, 95000, 420000, 1300000};
  std::string data = "x,xm,sa,sm,high,low,R,n\n";
  for (int i = 0; i < 4; ++i) {
    const double a = per_mm * amplitude[i], m = per_mm * mean[i];
    data += fmt::format("{},{},{:.14g},{:.14g},{:.14g},{:.14g},{:.14g},{}\n", amplitude[i], mean[i],
                        a, m, m + a, m - a, (m - a) / (m + a), lives[i]);
  }
  write("data.csv", data);
  const std::string rest = "[law]\nmean_stress = \"goodman\"\n" + prior;
  const std::string spring =
      "[conditions]\nS_ut = \"2500 MPa\"\nwire_diameter = \"3 mm\"\ncoil_diameter = \"22 mm\"\n"
      "active_coils = 5\nshear_modulus = \"79.3 GPa\"\n";
  const std::string strength = "[conditions]\nS_ut = \"2500 MPa\"\n";
  const auto result = [&](const std::string& ways, const std::string& conditions,
                          const std::string& point) {
    return fit_text(head + ways + "life = \"n\"\n" + conditions + rest +
                    "[predict]\nb_lives = 10\n[predict.stress]\nhere = { " + point + " }\n");
  };
  const json expected = result(
      "alternating_stress = { column = \"sa\", unit = \"MPa\" }\n"
      "mean_stress = { column = \"sm\", unit = \"MPa\" }\n",
      strength,
      fmt::format("alternating_stress = \"{:.14g} MPa\", mean_stress = \"{:.14g} MPa\"", 7 * per_mm,
                  12 * per_mm));
  const json others[] = {
      result("displacement_amplitude = { column = \"x\", unit = \"mm\" }\n"
             "displacement_mean = { column = \"xm\", unit = \"mm\" }\n",
             spring, "displacement_amplitude = \"7 mm\", displacement_mean = \"12 mm\""),
      result("max_stress = { column = \"high\", unit = \"MPa\" }\n"
             "min_stress = { column = \"low\", unit = \"MPa\" }\n",
             strength,
             fmt::format("max_stress = \"{:.14g} MPa\", min_stress = \"{:.14g} MPa\"", 19 * per_mm,
                         5 * per_mm)),
      result("alternating_stress = { column = \"sa\", unit = \"MPa\" }\nstress_ratio = \"R\"\n",
             strength,
             fmt::format("alternating_stress = \"{:.14g} MPa\", stress_ratio = {:.14g}", 7 * per_mm,
                         5. / 19))};
  const auto b10 = [](const json& each) -> double {
    return quantity(each, "B10 life", "here")["predictive"];
  };
  for (const json& other : others) {
    for (const auto& [name, p] : expected["parameters"].items()) {
      EXPECT_NEAR(double(other["parameters"][name]["mean"]) / double(p["mean"]), 1, 1e-6);
    }
    EXPECT_NEAR(b10(other) / b10(expected), 1, 1e-6);
  }
}

// A stress that is allowed is one that the next specimen survives, at the asked reliability.
TEST_F(FatigueStudy, AllowedStressSurvives) {
  write("data.csv", some_data);
  const std::string study = head + columns + law + prior;
  const json allowed = fit_text(study + "[predict]\nrequired_life = 2e5\nreliability = \"90 %\"\n");
  const json& stress = quantity(allowed, "allowed alternating stress", "specimen");
  EXPECT_EQ(stress["unit"], "MPa");
  EXPECT_LT(stress["bound"], stress["q50"]);
  const json survived =
      fit_text(study + fmt::format("[predict]\nsurvival_to = 2e5\nb_lives = 10\n[predict.stress]\n"
                                   "here = {{ alternating_stress = \"{:.12g} MPa\" }}\n",
                                   double(stress["predictive"])));
  EXPECT_NEAR(quantity(survived, "survival to 200000 cycles", "here")["predictive"], 90, 1e-3);
  EXPECT_NEAR(double(quantity(survived, "B10 life", "here")["predictive"]) / 2e5, 1, 1e-4);
  EXPECT_NEAR(double(quantity(survived, "life", "new here")["b10"]) / 2e5, 1, 1e-4);
}

TEST_F(FatigueStudy, WarnsOfExtrapolationAndOfFewTests) {
  write("data.csv", some_data);
  const json result = fit_text(head + columns + law + prior +
                               "[predict]\nb_lives = [0.1, 50]\nrequired_life = 1e8\n"
                               "reliability = 0.5\n[predict.stress]\n"
                               "low = { alternating_stress = \"200 MPa\" }\n"
                               "here = { alternating_stress = \"300 MPa\" }\n");
  const json& where = check(result, "extrapolation");
  EXPECT_EQ(where["verdict"], "warn");
  EXPECT_THAT(std::string(where["detail"]),
              HasSubstr("the alternating stress of low, 200 MPa, lies outside those tested (260 to "
                        "400 MPa)"));
  EXPECT_THAT(std::string(where["detail"]), HasSubstr("no test lasted 1e+08 cycles"));
  EXPECT_THAT(std::string(where["detail"]), testing::Not(HasSubstr("of here")));
  // 1 - 2^(-1/4) = 15.9 %; 1 - 0.999^n > 1/2 from n = 693.
  EXPECT_EQ(check(result, "percentile-support")["detail"],
            "the lowest of 4 tests is near B16; requested: B0.1 (needs 693 tests)");
}

TEST_F(FatigueStudy, RefusesBadRowsByName) {
  const std::string goodman =
      head + columns + "mean_stress = { column = \"m\", unit = \"MPa\" }\nstatus = \"end\"\n" +
      "[law]\nmean_stress = \"goodman\"\n" + prior +
      "log10_Sut = { distribution = \"uniform\", lower = \"3 log10(MPa)\", upper = \"3.2 "
      "log10(MPa)\" }\n";
  const auto expect = [&](const std::string& rows, const std::string& message) {
    write("data.csv", "s,m,n,end\n400,100,31000,F\n" + rows);
    EXPECT_THAT(refusal(goodman), HasSubstr(message)) << rows;
  };
  expect("350,100,0,F\n", "row 2, column 'n': 0 must be positive");
  expect("350,100,-5,F\n", "row 2, column 'n': -5 must be positive");
  expect("350,100,,F\n", "row 2, column 'n': no value");
  expect("0,100,95000,F\n", "row 2, column 's': 0 must be positive");
  expect("350,1600,95000,F\n",
         "row 2, column 'm': the mean stress 1600 MPa is not below S_ut, which is at most 1584.89 "
         "MPa");
  expect("350,100,95000,quux\n", "row 2, column 'end': 'quux' is not a status");
  expect("350,100,95000,true\n", "row 2, column 'end': true is ambiguous");
  write("data.csv", "s,m,n,end\n400,100,31000,S\n350,100,95000,runout\n");
  EXPECT_THAT(refusal(goodman), HasSubstr("rows 1 to 2: every test is a runout"));
  write("data.csv", "");
  EXPECT_THAT(refusal(goodman), HasSubstr("data.csv"));
  write("data.csv", "s,m,n,end\n");
  EXPECT_THAT(refusal(goodman), HasSubstr("data.csv"));
}

TEST_F(FatigueStudy, RefusesContradictionsAndGapsByKey) {
  write("data.csv", some_data);
  const std::string study = head + columns + law + prior;
  const auto expect = [&](const std::string& text, const std::string& message) {
    EXPECT_THAT(refusal(text), HasSubstr(message)) << text;
  };
  expect(
      head + "alternating_stress = { column = \"s\", unit = \"mm\" }\nlife = \"n\"\n" + law + prior,
      "prior.log10_a.mean: unit 'MPa' has the wrong dimension (expected one like 'm'), since "
      "by data.columns the stress quantity is 'mm'");
  expect(head + "alternating_stress = \"s\"\nlife = \"n\"\n" + law + prior, "needs a unit");
  expect(head + columns + "max_stress = { column = \"s\", unit = \"MPa\" }\n" + law + prior,
         "give the stress in one way");
  expect(study + "[predict]\nb_lives = [10]\n", "predict.b_lives: needs stresses");
  expect(study + "[predict]\ntypes = \"A\"\n", "predict.types: 'A' is not a type in the data");
  expect(head + "label = \"end\"\n" + columns + law + prior + "[predict]\ntypes = [\"F\", \"G\"]\n",
         "predict.types: 'G' is not a type in the data; use one of all, F");
  expect(study + "[predict]\ntypes = \"all\"\nb_lives = [0, 10]\n",
         "predict.b_lives: are percentages between 0 and 100");
  expect(study + "[predict]\nrequired_life = 1e5\n", "predict.required_life: needs the other");
  expect(study + "[predict]\nrequired_life = 1e5\nreliability = 90\n",
         "predict.reliability: must lie between 0 and 1");
  expect(study + "[predict]\ntypes = \"all\"\ncredible_level = 1\n",
         "predict.credible_level: must lie between 0 and 1");
  expect(study + "[predict]\ntypes = \"all\"\nsurvival_to = -1\n", "a life must be positive");
  expect(study +
             "[predict.stress]\nx = { displacement_amplitude = \"1 mm\", displacement_mean = \"3 "
             "mm\" }\n",
         "needs data given as displacements");
  expect(study + "[predict.stress]\nx = { mean_stress = \"1 MPa\" }\n",
         "give the stress in one way");
  expect(study + "[predict.stress]\nx = { alternating_stress = \"300 MPa\", stress_ratio = 0.5 }\n",
         "predict.stress.x.stress_ratio: has no effect: the study does not have the stress_ratio "
         "of its tests");
  expect(study + "[predict]\ntipes = \"all\"\n", "did you mean 'types'?");
  // A width is a difference: no MPa in it.
  expect(study + "[sampler.half_width]\nlog10_a = \"0.1 log10(MPa)\"\nb = 0.01\nsigma = 0.1\n",
         "sampler.half_width.log10_a");
}

// All that a report of lives shows is kept beside it.
TEST_F(FatigueStudy, ReportIsWrittenAgainTheSame) {
  const std::string out = (folder() / "out").string();
  const CommandResult run = run_wearwell("fit '" PROJECT_SOURCE_DIR
                                         "/examples/fatigue/study.toml' --quiet --method exact "
                                         "--draws 100 -o '" +
                                         out + "'");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto content = [&] {
    std::stringstream text;
    text << std::ifstream(out + "/report.html").rdbuf();
    return text.str();
  };
  const std::string first = content();
  for (const char* expected :
       {"Alternating stress against life", "Predictive life, by stress", "Haigh diagram",
        "predictive", "confidence", "Every test and its predicted life", "run-outs"}) {
    EXPECT_THAT(first, HasSubstr(expected));
  }
  ASSERT_EQ(run_wearwell("report '" + out + "'").exit_code, 0);
  EXPECT_TRUE(content() == first);
}

TEST_F(FatigueStudy, NewStudyRunsAndIsSaidInWords) {
  const std::string mine = (folder() / "mine").string();
  const CommandResult made = run_wearwell("new fatigue '" + mine + "'");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const CommandResult words = run_wearwell("check '" + mine + "/study.toml'");
  ASSERT_EQ(words.exit_code, 0) << words.err;
  for (const char* expected :
       {"25 tests: 22 failures, 3 runouts",
        "alternating stress 260 to 600 MPa, mean stress 0 to 427.78 MPa",
        "life 16970 to 2\u202f000\u202f000 cycles", "S_f = S_a/(1 - S_m/S_ut)",
        "B10 life [cycles] of the hanger at 280 MPa amplitude, R = 0.1 (mean 342.22 MPa); "
        "lower bound with 90 % credibility, and the value of the next item",
        "allowed alternating stress [MPa] of the specimen for 90 % to outlast "
        "1\u202f000\u202f000 cycles, R = 0.1"}) {
    EXPECT_THAT(words.out, HasSubstr(expected));
  }
  const CommandResult run = run_wearwell(
      "fit '" + mine + "/study.toml' --no-report --method exact --draws 100 -o '" + mine + "/out'");
  EXPECT_EQ(run.exit_code, 0) << run.out << run.err;
  for (const char* expected :
       {"at 400 MPa amplitude, fully reversed, is at least 304\u202f000\u00a0cycles",
        "Design values", "(predictive)"}) {
    EXPECT_THAT(run.out, HasSubstr(expected));
  }
}

}  // namespace
}  // namespace wearwell
