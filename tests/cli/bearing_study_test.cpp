// `wearwell fit` of bearing studies, and `wearwell bearing profile`, as their user meets them.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "support/run_command.h"
#include "support/scratch.h"
#include "wearwell/input/table.h"

namespace wearwell {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

const std::string example = PROJECT_SOURCE_DIR "/examples/bearing/";

std::map<std::string, double> golden() {
  const Table table = read_table(PROJECT_SOURCE_DIR "/tests/golden/bearing_fit.csv",
                                 "select what, value from data where what <> 'log_likelihood'");
  std::map<std::string, double> values;
  for (std::size_t i = 0; i < table.rows; ++i) {
    values[table.columns[0].text[i]] = table.columns[1].numbers[i];
  }
  return values;
}

class BearingStudy : public ScratchTest {
 protected:
  json fit(const std::string& study, const std::string& options = "") {
    const CommandResult run = run_wearwell("fit '" + study + "' --json -o '" +
                                           (folder() / "out").string() + "' " + options);
    EXPECT_LE(run.exit_code, 1) << run.err;  // 1: a check failed
    return json::parse(run.out);
  }

  // The message of a study that is refused.
  std::string refusal(const std::string& study) {
    const auto file = write("study.toml", study);
    const CommandResult run =
        run_wearwell("fit '" + file.string() + "' -o '" + (folder() / "out").string() + "'");
    EXPECT_EQ(run.exit_code, 2) << study;
    EXPECT_FALSE(std::filesystem::exists(folder() / "out"));
    return run.err;
  }
};

const json& quantity(const json& result, const std::string& name, const std::string& of,
                     const std::string& unit) {
  for (const json& each : result["quantities"]) {
    if (each["name"] == name && each["of"] == of && each["unit"] == unit) return each;
  }
  throw std::runtime_error("no " + name + " of " + of);
}

// The grid of tests/golden/bearing_fit.R is 0.01 wide in ln k and in k_scatter.
TEST_F(BearingStudy, ExampleAgreesWithTheGridOfR) {
  const json result = fit(example + "study.toml");
  EXPECT_TRUE(result["trusted"]);
  const auto expected = golden();
  const json& k = result["parameters"]["k"];
  const json& scatter = result["parameters"]["k_scatter"];
  for (const char* what : {"mean", "sd"}) {
    EXPECT_NEAR(double(k[what]) * 1e-9 / expected.at(std::string("k_") + what), 1, 1e-4) << what;
    EXPECT_NEAR(double(scatter[what]) / expected.at(std::string("k_scatter_") + what), 1, 1e-4);
  }
  for (const char* what : {"q05", "q50", "q95"}) {
    EXPECT_NEAR(double(k[what]) * 1e-9 / expected.at(std::string("k_") + what), 1, 1e-3) << what;
    EXPECT_NEAR(double(scatter[what]) / expected.at(std::string("k_scatter_") + what), 1, 2e-3);
  }
  // Of a new bearing: the life is 1/k, the length k, each times what does not vary.
  const json& life = quantity(result, "life", "new bearing", "revolutions");
  const double at_median = double(life["q50"]) * expected.at("new_k_0.5");
  EXPECT_NEAR(double(life["q05"]) * expected.at("new_k_0.95") / at_median, 1, 1e-3);
  EXPECT_NEAR(double(life["q95"]) * expected.at("new_k_0.05") / at_median, 1, 1e-3);
  const json& length = quantity(result, "length", "new bearing", "mm");
  EXPECT_NEAR(double(length["q95"]) / double(length["q50"]) * expected.at("new_k_0.5") /
                  expected.at("new_k_0.95"),
              1, 1e-3);
  // The sampler, within five Monte Carlo standard errors.
  for (const char* name : {"k", "k_scatter"}) {
    const json& p = result["parameters"][name];
    EXPECT_NEAR(double(p["draws"]["mean"]), double(p["mean"]), 5 * double(p["draws"]["mcse"]));
  }
}

// Each answer of [predict] undoes the others, through the bearing command.
TEST_F(BearingStudy, PredictionsAgreeWithTheBearingCommand) {
  const json result = fit(example + "study.toml", "--method exact");
  const double k = result["parameters"]["k"]["q50"];
  const auto answer = [&](const std::string& arguments) -> double {
    const CommandResult run =
        run_wearwell("bearing " + arguments +
                     " --contact stationary --radius '10 mm' --clearance '30 um' --json");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return json::parse(run.out)["value"];
  };
  const std::string rate = fmt::format(" --rate '{} mm^3/(N m)' ", k);
  const auto median = [&](const char* name, const char* unit) -> double {
    return quantity(result, name, "median bearing", unit)["q50"];
  };
  EXPECT_NEAR(median("depth", "um") /
                  (1e3 * answer("depth --pressure '1.5 MPa' --revolutions 100000" + rate)),
              1, 1e-4);
  const std::string to = " --depth '80 um' " + rate;
  EXPECT_NEAR(median("life", "revolutions") / answer("life --pressure '1.5 MPa'" + to), 1, 1e-4);
  EXPECT_NEAR(median("life", "h") / answer("life --pressure '1.5 MPa' --speed '60 rpm'" + to), 1,
              1e-4);
  EXPECT_NEAR(median("pressure", "MPa") / answer("pressure --speed '60 rpm' --time '200 h'" + to),
              1, 1e-4);
  EXPECT_NEAR(median("length", "mm") /
                  answer("length --force '500 N' --speed '60 rpm' --time '200 h'" + to),
              1, 1e-4);
  EXPECT_NEAR(quantity(result, "life", "median bearing", "h")["b10"],
              double(quantity(result, "life", "median bearing", "revolutions")["b10"]) / 3600,
              1e-9 * 100);
}

// What the joint says, of a new bearing: the wait has the risk that was asked for, in the life's own
// distribution, and the page draws limit and life.
TEST_F(BearingStudy, SaysWhenToInspectAtARisk) {
  const auto study = [&](const std::string& predict) {
    std::ifstream in(example + "study.toml");
    std::string text{std::istreambuf_iterator<char>(in), {}};
    text.replace(text.find("inspections.csv"), 15, example + "inspections.csv");
    return text.substr(0, text.find("[predict]")) + "[predict]\nclearance = \"30 um\"\n" + predict;
  };
  const std::string asked = "limit = \"80 um\"\npressure = \"1.5 MPa\"\nspeed = \"60 rpm\"\n";
  const json one =
      fit(write("a.toml", study(asked + "risk = \"10 %\"\n")).string(), "--method exact");
  const json& life = one["life"];
  EXPECT_EQ(one["life"]["of"], "new bearing");
  EXPECT_EQ(one["life"]["unit"], "h");
  EXPECT_EQ(one["life"]["risk"], 0.1);
  EXPECT_NEAR(double(life["inspect_within"]) / double(life["b10"]), 1, 1e-6);
  const json& quantities = quantity(one, "life", "new bearing", "h");
  for (const char* q : {"q05", "q95", "b1", "b10", "b50"})
    EXPECT_NEAR(double(life[q]) / double(quantities[q]), 1, 1e-6) << q;
  std::ifstream page(folder() / "out" / "report.html");
  const std::string html{std::istreambuf_iterator<char>(page), {}};
  EXPECT_THAT(html, HasSubstr("Life until 80"));
  EXPECT_THAT(html, HasSubstr("\"datum\":\"limit\""));
  std::filesystem::remove_all(folder() / "out");
  const std::string needs = "predict.risk: needs predict.limit and predict.pressure";
  EXPECT_THAT(refusal(study("risk = \"1 %\"\npressure = \"1 MPa\"\nrevolutions = 1e5\n")),
              HasSubstr(needs));
  EXPECT_THAT(refusal(study(asked + "risk = \"100 %\"\n")),
              HasSubstr("predict.risk: must lie between 0 and 1"));
}

// The limit is told in a unit of its own.
TEST_F(BearingStudy, TheLimitIsDrawnInTheUnitOfTheDepths) {
  std::ifstream in(example + "study.toml");
  std::string text{std::istreambuf_iterator<char>(in), {}};
  text.replace(text.find("inspections.csv"), 15, example + "inspections.csv");
  text.replace(text.find("limit       = \"80 um\""), 21, "limit       = \"0.08 mm\"");
  fit(write("a.toml", text).string(), "--method exact");
  std::ifstream file(folder() / "out" / "report.json");
  const std::string report{std::istreambuf_iterator<char>(file), {}};
  EXPECT_THAT(report, HasSubstr("\"values\":\"y\\n80\""));
}

// The same inspections with other words and units: times at a speed, loads as pressures, the
// contact in a column. Exact data of one k are recovered, whatever the contact.
TEST_F(BearingStudy, RecoversExactDataOfEveryContact) {
  std::string rows = "contact,radius_mm,clearance_mm,p_MPa,speed_rpm,time_h,depth_mm\n";
  for (const std::string contact : {"stationary", "journal", "bushing"}) {
    for (const int hours : {5, 20, 80}) {
      const CommandResult run = run_wearwell(fmt::format(
          "bearing depth --contact {} --radius '12 mm' --clearance '0.04 mm' --rate '3e-15 "
          "m^3/(N m)' --pressure '0.8 MPa' --speed '50 rpm' --time '{} h' --json",
          contact, hours));
      rows += fmt::format("{},12,0.04,0.8,50,{},{}\n", contact, hours,
                          double(json::parse(run.out)["value"]));
    }
  }
  write("data.csv", rows);
  const auto study = write("study.toml", R"toml(
model = "bearing-wear"
[data]
file = "data.csv"
[data.columns]
contact = "contact"
radius = { column = "radius_mm", unit = "mm" }
clearance = { column = "clearance_mm", unit = "mm" }
pressure = { column = "p_MPa", unit = "MPa" }
speed = { column = "speed_rpm", unit = "rpm" }
time = { column = "time_h", unit = "h" }
depth = { column = "depth_mm", unit = "mm" }
[likelihood]
family = "lognormal"
depth_error = "0.1 um"
[prior]
k = { distribution = "lognormal", median = "1e-15 m^3/(N m)", log_sd = 2 }
)toml");
  const json result = fit(study.string());
  EXPECT_NEAR(result["parameters"]["k"]["mean"], 3e-15, 3e-18);
  EXPECT_EQ(result["parameters"].size(), 1u) << "a known error leaves no sigma";
  EXPECT_FALSE(result.contains("quantities"));
}

TEST_F(BearingStudy, UpdatesRowByRow) {
  std::ifstream text(example + "study.toml");
  std::string study(std::istreambuf_iterator<char>(text), {});
  std::filesystem::copy(example + "inspections.csv", folder() / "inspections.csv");
  const std::string all = "file = \"inspections.csv\"";
  study.replace(study.find(all), all.size(), all + "\nsql = \"select * from data limit 5\"");
  const auto file = write("study.toml", study + "\n[update]\nstages = \"row\"\n");
  const json result = fit(file.string(), "--method exact --draws 200");
  ASSERT_EQ(result["stages"].size(), 5u);
  const json& last = result["stages"][4];
  EXPECT_NEAR(last["parameters"]["k"]["mean"], double(result["parameters"]["k"]["mean"]), 1e-12);
  EXPECT_NEAR(last["predictions"][0]["measured"], 24.0, 1e-9);
}

const std::string head = R"toml(
model = "bearing-wear"
[data]
file = "data.csv"
[data.columns]
)toml";
const std::string columns = R"toml(bearing = "b"
clearance = { column = "c", unit = "um" }
pressure = { column = "p", unit = "MPa" }
revolutions = "n"
depth = { column = "d", unit = "um" }
)toml";
const std::string conditions = "[conditions]\ncontact = \"stationary\"\nradius = \"10 mm\"\n";
const std::string likelihood = "[likelihood]\ndepth_error = \"2 um\"\n";
const std::string prior = R"toml([prior]
k = { distribution = "lognormal", median = "1e-15 m^3/(N m)", log_sd = 2 }
)toml";
const std::string good_data = "b,c,p,n,d\nA,30,1,1e5,15\nB,30,1,1e5,18\n";

// Speeds and revolutions in any unit are the same.
TEST_F(BearingStudy, CountsTurnsWhateverTheUnit) {
  const auto study = [&](const std::string& turns, const std::string& cells) {
    write("data.csv", "b,c,p,n,t,d\nA,30,1," + cells + ",15\nB,30,1," + cells + ",18\n");
    std::string text = head + columns + conditions + likelihood + prior;
    text.replace(text.find("revolutions = \"n\""), 17, turns);
    return text;
  };
  const std::string times = "\ntime = { column = \"t\", unit = \"h\" }";
  const auto k = [&](const std::string& turns, const std::string& cells) -> double {
    return fit(write("a.toml", study(turns, cells)).string())["parameters"]["k"]["mean"];
  };
  const double expected = k("revolutions = \"n\"", "72000,0");
  for (const auto& [turns, cells] :
       {std::pair{"revolutions = { column = \"n\", unit = \"krev\" }", "72,0"},
        {"revolutions = { column = \"n\", unit = \"1e3 turns\" }", "72,0"}})
    EXPECT_NEAR(k(turns, cells) / expected, 1, 1e-9) << turns;
  for (const auto& [unit, speed] : {std::pair{"1/min", "60"},
                                    {"rpm", "60"},
                                    {"Hz", "1"},
                                    {"rad/s", "6.283185307179586"},
                                    {"U/min", "60"}})
    EXPECT_NEAR(k(fmt::format("speed = {{ column = \"n\", unit = \"{}\" }}", unit) + times,
                  std::string(speed) + ",20") /
                    expected,
                1, 1e-9)
        << unit;
}

TEST_F(BearingStudy, RefusesTurnsWithTwoReadings) {
  write("data.csv", "b,c,p,n,t,d\nA,30,1,60,20,15\nB,30,1,60,20,18\n");
  const auto study = [&](const std::string& turns) {
    std::string text = head + columns + conditions + likelihood + prior;
    return text.replace(text.find("revolutions = \"n\""), 17, turns);
  };
  EXPECT_THAT(refusal(study("speed = { column = \"n\", unit = \"1/h\" }\n"
                            "time = { column = \"t\", unit = \"h\" }")),
              AllOf(HasSubstr("speed.unit: '1/h'"), HasSubstr("rev/s")));
  EXPECT_THAT(refusal(study("revolutions = { column = \"n\", unit = \"rad\" }")),
              HasSubstr("contains an angle"));
}

TEST_F(BearingStudy, RefusesContradictionsAndGapsByKey) {
  write("data.csv", good_data);
  const std::string rest = likelihood + prior;
  const auto expect = [&](const std::string& study, const std::string& message) {
    EXPECT_THAT(refusal(study), HasSubstr(message)) << study;
  };
  expect(head + columns + conditions + "clearance = \"30 um\"\n" + rest,
         "conditions.clearance: is given here and as data.columns.clearance; keep one");
  expect(head + columns + "contact = \"b\"\n" + conditions + rest,
         "conditions.contact: is given here and as data.columns.contact");
  expect(head + columns + "[conditions]\nradius = \"10 mm\"\n" + rest,
         "data.columns.contact: is missing");
  expect(head + columns + "[conditions]\ncontact = \"stationary\"\n" + rest,
         "data.columns.radius: is missing");
  expect(head + columns + "[conditions]\ncontact = \"sliding\"\nradius = \"10 mm\"\n" + rest,
         "conditions.contact: 'sliding' is not allowed");
  expect(head + columns + conditions + "force = \"800 N\"\n" + rest,
         "data.columns.force: is given, and so is pressure");
  expect(head + columns + conditions + "length = \"20 mm\"\n" + rest,
         "data.columns.length: is given, and so is pressure");
  expect(head + columns + conditions + "speed = \"60 rpm\"\n" + rest,
         "data.columns.speed: is given, and so is revolutions");
  expect(head + columns + "[conditions]\ncontact = \"stationary\"\nradius = \"-1 mm\"\n" + rest,
         "conditions.radius: must be positive");
  expect(head + columns + conditions + likelihood + prior +
             "sigma = { distribution = \"half-normal\", scale = \"1 um\" }\n",
         "prior.sigma: is given, but likelihood.depth_error fixes it");
  expect(head + columns + conditions + rest +
             "k_scater = { distribution = \"half-normal\", scale = 1 }\n",
         "did you mean 'k_scatter'?");
  expect(head + columns + conditions + rest +
             "[predict]\nlimit = \"50 um\"\nrequired_time = \"10 h\"\n",
         "predict.required_time: needs predict.speed");
  expect(
      head + columns + conditions + rest + "[predict]\nlimit = \"50 um\"\npressure = \"1 MPa\"\n",
      "predict.limit: needs predict.clearance");
  expect(
      head + columns + conditions + rest + "[predict]\nrevolutions = 1e5\nclearance = \"30 um\"\n",
      "predict.revolutions: needs predict.pressure");
  expect(head + columns + conditions + rest +
             "[predict]\nlimit = \"21 mm\"\nclearance = \"30 um\"\npressure = \"1 MPa\"\n",
         "predict.limit: depth/radius is 2.1");
  expect(head + columns + conditions + rest + "[predict]\nrequired_revolutions = 1e5\n",
         "predict.required_revolutions: needs predict.limit");
  expect(head + columns + conditions + rest + "[predict]\nforce = \"100 N\"\n",
         "predict.force: needs predict.required_revolutions");
}

// Ten decades from the prior of k a quadrature over the scatter of bearings would not end.
TEST_F(BearingStudy, RefusesDepthsBelowAtomsWithTheLikelyUnit) {
  const std::string study = head + columns + conditions + "[likelihood]\nfamily = \"normal\"\n" +
                            prior + "k_scatter = { distribution = \"half-normal\", scale = 1 }\n";
  write("data.csv", "b,c,p,n,d\nA,30,1,1e5,1e-11\nA,30,1,2e5,1e-11\nB,30,1,1e5,1e-11\n");
  EXPECT_THAT(refusal(study),
              HasSubstr("column 'd' (data.columns.depth): the largest depth is 1e-11 um, less than "
                        "the size of an atom (1e-10 m); no unit of length makes it a wear depth"));
  write("data.csv", "b,c,p,n,d\nA,30,1,1e5,1.5e-5\nA,30,1,2e5,3e-5\nB,30,1,1e5,2e-5\n");
  EXPECT_THAT(refusal(study), HasSubstr("in m it would be 30 um: check the unit"));
}

TEST_F(BearingStudy, RefusesBadRowsByName) {
  const std::string study = head + columns + conditions + likelihood + prior;
  const auto expect = [&](const std::string& data, const std::string& message,
                          const std::string& with) {
    write("data.csv", data);
    EXPECT_THAT(refusal(with), HasSubstr(message)) << data;
  };
  expect("b,c,p,n,d\nA,30,1,1e5,15\nB,-30,1,1e5,18\n", "row 2, column 'c': -30 must be positive",
         study);
  expect("b,c,p,n,d\nA,30,1,1e5,15\nB,30,0,1e5,18\n", "row 2, column 'p': 0 must be positive",
         study);
  expect("b,c,p,n,d\nA,30,1,1e5,15\nB,30,1,,18\n", "row 2, column 'n': no value", study);
  expect("b,c,p,n,d\nA,30,1,1e5,15\nB,30,1,1e5,21000\n",
         "row 2, column 'd': 21000 must be less than the journal's diameter", study);
  expect("b,c,p,n,d\nA,30,1,1e5,0\nB,30,1,1e5,-1\n", "no measured depth is positive", study);
  expect("b,c,p,n,d\nA,30,1,1e5,15\n,30,1,1e5,18\n",
         "row 2, column 'b': no value; a label must not be empty", study);
  expect("b,c,p,n,d\nA,30,1,1e5,15\nA,30,1,1e5,18\n", "are of one bearing",
         study + "k_scatter = { distribution = \"half-normal\", scale = 1 }\n");
  expect("b,c,p,n,d\nA,30,1,1e5,15\n", "has 1 inspection",
         head + columns + conditions + prior +
             "sigma = { distribution = \"half-normal\", scale = \"1 um\" }\n");
  expect("b,c,p,n,d\nA,30,1,1e5,15\nB,30,1,1e5,0\n",
         "row 2, column 'd': 0 must be positive for the lognormal likelihood",
         head + columns + conditions +
             "[likelihood]\nfamily = \"lognormal\"\ndepth_error = \"2 um\"\n" + prior);
  expect(
      "b,c,p,n,d,k\nA,30,1,1e5,15,journal\nB,30,1,1e5,18,shaft\n",
      "row 2, column 'k': 'shaft' is not a contact; it is one of stationary, journal, bushing",
      head + columns + "contact = \"k\"\n[conditions]\nradius = \"10 mm\"\n" + likelihood + prior);
}

const std::string profiles = " --before '" + example + "profile_before.csv' --after '" + example +
                             "profile_after.csv' --position position_mm --height height_um ";
const std::string units = " --position-unit mm --height-unit um ";

// The truth of examples/bearing/simulate_profiles.py.
TEST(BearingProfile, FindsTheAreaOfItsExample) {
  const CommandResult run = run_wearwell(
      "bearing profile --flank '5 mm' --radius '10 mm' --clearance '30 um' --pressure '1 MPa' "
      "--revolutions 1e5 --json" +
      profiles + units);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json result = json::parse(run.out);
  const json& area = result["area"];
  EXPECT_NEAR(area["value"], 0.196790, 3 * double(area["sd"]));
  EXPECT_LT(area["sd"], 0.0015);
  EXPECT_NEAR(result["depth"]["value"], 0.017, 2e-4);
  EXPECT_NEAR(result["alignment"]["shift_um"], -120, 40);
  // k = A/(4 pi r^2 p_a n)
  EXPECT_NEAR(double(result["rate"]["value"]) / (double(area["value"]) * 1e-6),
              1 / (4 * M_PI * 1e-4 * 1e11), 1e-22);
  const CommandResult force = run_wearwell(
      "bearing profile --flank '5 mm' --radius '10 mm' --length '20 mm' --force '400 N' --speed "
      "'50 rpm' "
      "--time '2000 min' --json" +
      profiles + units);
  // Without the clearance the bore is taken for as wide as the shaft: the area of its curved section.
  EXPECT_NEAR(double(json::parse(force.out)["rate"]["value"]) / double(result["rate"]["value"]), 1,
              1e-5);
  EXPECT_TRUE(json::parse(force.out)["depth"].is_null());
}

TEST(BearingProfile, RefusesByOption) {
  const auto refused = [](const std::string& arguments) {
    const CommandResult run = run_wearwell("bearing profile " + arguments);
    EXPECT_EQ(run.exit_code, 2) << arguments;
    EXPECT_EQ(run.out, "");
    return run.err;
  };
  const std::string radius = " --radius '10 mm' ";
  EXPECT_THAT(refused(profiles + radius + " --position-unit um "),
              HasSubstr("is in mm by its heading, and um is given as its unit"));
  EXPECT_THAT(refused(profiles + units), HasSubstr("--radius is missing"));
  EXPECT_THAT(refused(units + radius), HasSubstr("--before is missing"));
  EXPECT_THAT(refused(profiles + units + radius + "--pressure '1 MPa'"),
              HasSubstr("--revolutions (or --speed and --time) is missing"));
  EXPECT_THAT(refused(profiles + units + radius + "--revolutions 1e5"),
              HasSubstr("--pressure (or --force and --length) is missing"));
  EXPECT_THAT(refused(profiles + units + radius + "--force '1 N' --revolutions 1e5"),
              HasSubstr("--force and --length go together"));
  EXPECT_THAT(refused(profiles + units + radius + "--depth '1 mm'"),
              HasSubstr("--depth, --scar-width and --rate are results here"));
  EXPECT_THAT(refused(profiles + units + radius + "--flank '20 mm'"), HasSubstr("a flank of"));
  EXPECT_THAT(refused(profiles + units + radius + "--flank '-2 mm'"),
              HasSubstr("--flank: '-2 mm'"));
  EXPECT_THAT(refused(profiles + radius + "--position-unit mm --height-unit N"),
              HasSubstr("--height-unit: unit 'N' has the wrong dimension"));
  EXPECT_THAT(refused(" --before nothing.csv --after nothing.csv" + units + radius),
              HasSubstr("nothing.csv"));
}

}  // namespace
}  // namespace wearwell
