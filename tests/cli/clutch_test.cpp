// `wearwell clutch ...`, and `wearwell fit` of clutch studies, as their user meets them.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "support/run_command.h"
#include "support/scratch.h"

namespace wearwell {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

const std::string example = PROJECT_SOURCE_DIR "/examples/clutch/";

std::string read(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> all;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) all.push_back(line);
  return all;
}

std::string joined(const std::vector<std::string>& all) {
  std::string text;
  for (const std::string& line : all) text += line + "\n";
  return text;
}

void replace(std::string& text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  ASSERT_NE(at, std::string::npos) << what;
  text.replace(at, what.size(), by);
}

// A campaign a tenth as long as the example's, with a tenth of its scatter; simulated and fitted
// once for all tests.
class Clutch : public ScratchTest {
 protected:
  static void SetUpTestSuite() {
    std::string pattern = (fs::temp_directory_path() / "wearwell-test-XXXXXX").string();
    shared_ = mkdtemp(pattern.data());
    std::string truth = read(example + "truth.toml");
    replace(truth, "[40, 100, 200, 400, 800, 1500, 2500, 4000, 6000, 8000]",
            "[10, 30, 60, 120, 250, 500, 1000]");
    replace(truth, "\"78 MJ\"", "\"10 MJ\"");
    replace(truth, "\"6 MJ\"", "\"1 MJ\"");
    replace(truth, "run_out_cycles = 1500", "run_out_cycles = 200");
    replace(truth, "p1 = \"75 mm^3/MJ\"", "p1 = \"6.5 mm^3/MJ\"");
    replace(truth, "p2 = 2.2", "p2 = 0.2");
    replace(truth, "least_cycles = 750", "least_cycles = 100");
    replace(truth, "\"0.3 g\"", "\"0 g\"");
    replace(truth, "depth = \"1 mm\"", "depth = \"0.05 mm\"");
    replace(truth, "sd = \"1 mg\"", "sd = \"0.1 mg\"");
    std::ofstream(shared_ / "truth.toml") << truth;
    fs::copy(example + "design.csv", shared_ / "design.csv");
    const CommandResult run =
        in_shared("clutch simulate --design design.csv --truth truth.toml -o .");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    std::ofstream(shared_ / "study.toml") << study;
    const CommandResult fit = in_shared("fit study.toml -o result --json");
    ASSERT_LE(fit.exit_code, 1) << fit.err;
    summary_ = json::parse(fit.out);
  }
  static void TearDownTestSuite() { fs::remove_all(shared_); }

  static CommandResult in_shared(const std::string& arguments) {
    return run_command("cd '" + shared_.string() + "'; '" WEARWELL_BINARY "' " + arguments);
  }
  CommandResult here(const std::string& arguments) const {
    return run_command("cd '" + folder().string() + "'; '" WEARWELL_BINARY "' " + arguments);
  }

  static std::string model() { return "'" + (shared_ / "result/model.json").string() + "' "; }
  static std::vector<std::string> cycles() { return lines(read(shared_ / "cycles.csv")); }
  static std::vector<std::string> weighings() { return lines(read(shared_ / "weighings.csv")); }

  // What fit says of the campaign with these files in the place of the good ones.
  std::string fit_refusal(const std::vector<std::string>& some_cycles,
                          const std::vector<std::string>& some_weighings) const {
    write("cycles.csv", joined(some_cycles));
    write("weighings.csv", joined(some_weighings));
    write("design.csv", read(shared_ / "design.csv"));
    write("traces.csv", read(shared_ / "traces.csv"));
    write("study.toml", study);
    const CommandResult run = here("fit study.toml -o out");
    EXPECT_EQ(run.exit_code, 2) << run.out;
    EXPECT_EQ(run.out, "");
    EXPECT_FALSE(fs::exists(folder() / "out"));
    return run.err;
  }

  // What predict says of a file.
  std::string predict_refusal(const std::string& content) const {
    write("bad.csv", content);
    const CommandResult run = here("clutch predict " + model() + " bad.csv --state state.json");
    EXPECT_EQ(run.exit_code, 2) << run.out;
    EXPECT_EQ(run.out, "");
    EXPECT_FALSE(fs::exists(folder() / "state.json"));
    return run.err;
  }

  static constexpr const char* study = R"toml(title = "small"
model = "clutch-wear"
[data]
design = "design.csv"
cycles = "cycles.csv"
weighings = "weighings.csv"
traces = "traces.csv"
[lining]
density = "2.2 g/cm^3"
depth = "0.05 mm"
area = "100 cm^2"
[balance]
sd = "0.1 mg"
[search]
lowest = 1
highest = 1.2
step = 0.2
[uncertainty]
replicates = 5
[life.points.launch]
slip_speed = "1700 rpm"
torque = "50 N m"
temperature = "170 degC"
closing_time = "2.15 s"
)toml";
  static inline fs::path shared_;
  static inline json summary_;
};

const std::string heading =
    "plate,cycle,slip_speed [rpm],torque [N m],temperature [degC],closing_time [s],energy [J]\n";

TEST_F(Clutch, FitRunsFromTracesToLife) {
  for (const char* file :
       {"summary.json", "model.json", "predictions.csv", "report.html", "study.toml"})
    EXPECT_TRUE(fs::exists(shared_ / "result" / file)) << file;
  EXPECT_FALSE(summary_["simulated"]) << "from files nobody knows it";
  EXPECT_EQ(summary_["data"]["points"], 101);
  EXPECT_EQ(summary_["data"]["held_out"], 20);
  EXPECT_EQ(summary_["search"]["pairs"], 4);
  EXPECT_EQ(summary_["search"]["submodels_of_each"], 1048575);
  EXPECT_EQ(summary_["maps"].size(), 4u);
  EXPECT_EQ(summary_["scatter"]["candidates"].size(), 4u);
  EXPECT_EQ(summary_["validation"]["points"].size(), 20u);
  ASSERT_EQ(summary_["sequences"].size(), 2u);
  for (const json& sequence : summary_["sequences"]) {
    EXPECT_LT(std::abs(double(sequence["final_error"])), 0.15);
    for (const json& w : sequence["weighings"])
      EXPECT_GT(double(w["sd_full"]), double(w["sd_scatter"]));
  }
  EXPECT_EQ(summary_["life"][0]["levels"].size(), 5u);
  for (const json& check : summary_["checks"]) EXPECT_NE(check["name"], "units");
}

// The same campaign simulated within the study; one thread; the same numbers.
TEST_F(Clutch, FilesAndSimulationAndThreadsAgree) {
  std::string other = study;
  const std::size_t from = other.find("[data]"), to = other.find("[search]");
  other.replace(from, to - from, "[simulation]\ndesign = \"design.csv\"\ntruth = \"truth.toml\"\n");
  std::ofstream(shared_ / "simulated.toml") << other;
  const CommandResult one = in_shared("fit simulated.toml -o one --json --threads 1");
  ASSERT_LE(one.exit_code, 1) << one.err;
  const CommandResult two = in_shared("fit simulated.toml -o two --json --threads 2");
  EXPECT_EQ(one.out, two.out);
  EXPECT_EQ(read(shared_ / "one/model.json"), read(shared_ / "two/model.json"));
  const json result = json::parse(one.out);
  EXPECT_TRUE(result["simulated"]);
  EXPECT_EQ(result["maps"][0]["terms"], summary_["maps"][0]["terms"]);
  EXPECT_NEAR(double(result["maps"][0]["r2p"]), double(summary_["maps"][0]["r2p"]), 1e-6);
  EXPECT_NEAR(double(result["sequences"][0]["final_error"]),
              double(summary_["sequences"][0]["final_error"]), 1e-6);
}

// predict sums the sequences as fit did.
TEST_F(Clutch, PredictAgreesWithFit) {
  const CommandResult run = in_shared("clutch predict " + model() + " cycles.csv --json");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json result = json::parse(run.out);
  ASSERT_EQ(result["plates"].size(), 15u);
  for (const json& sequence : summary_["sequences"]) {
    const json& last = sequence["weighings"].back();
    for (const json& plate : result["plates"]) {
      if (plate["plate"] != sequence["plate"]) continue;
      EXPECT_EQ(plate["last_cycle"], last["cycle"]);
      EXPECT_NEAR(double(plate["volume"]) / double(last["predicted"]), 1, 1e-12);
      EXPECT_NEAR(double(plate["sd_scatter"]) / double(last["sd_scatter"]), 1, 1e-12);
      EXPECT_NEAR(double(plate["sd_full"]) / double(last["sd_full"]), 1, 1e-12);
    }
  }
}

TEST_F(Clutch, PredictGoesOnFromItsState) {
  const auto all = cycles();
  const std::size_t cut = all.size() / 3 + 5;
  write("all.csv", joined(all));
  write("first.csv", joined({all.begin(), all.begin() + static_cast<std::ptrdiff_t>(cut)}));
  std::vector<std::string> rest = {all[0]};
  rest.insert(rest.end(), all.begin() + static_cast<std::ptrdiff_t>(cut), all.end());
  write("rest.csv", joined(rest));
  const std::string start = "clutch predict " + model();
  const CommandResult whole = here(start + "all.csv --state whole.json --threads 1");
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  EXPECT_EQ(here(start + "first.csv --state state.json").exit_code, 0);
  const CommandResult second = here(start + "rest.csv --state state.json --threads 2");
  EXPECT_EQ(second.exit_code, 0);
  EXPECT_EQ(second.out, whole.out);
  EXPECT_EQ(read(folder() / "state.json"), read(folder() / "whole.json"));

  const CommandResult again = here(start + "rest.csv --state state.json");
  EXPECT_EQ(again.exit_code, 2) << "these cycles are in it already";
  EXPECT_THAT(again.err, AllOf(HasSubstr("rest.csv, row 1"), HasSubstr("cycles must ascend")));
  EXPECT_EQ(read(folder() / "state.json"), read(folder() / "whole.json")) << "as it was";
  EXPECT_THAT(here(start + "rest.csv --scatter-only --state state.json").err,
              HasSubstr("without --scatter-only"));
  std::string other = read(shared_ / "result/model.json");
  replace(other, "\"title\": \"small\"", "\"title\": \"other\"");
  write("other.json", other);
  EXPECT_THAT(here("clutch predict other.json rest.csv --state state.json").err,
              HasSubstr("belongs to another model"));
}

// The state of years is not lost by one reading.
TEST_F(Clutch, PredictKeepsItsStateFromWhatIsNotFinite) {
  write("good.csv", heading + "5,1,1700,50,170,2,9000\n");
  write("hot.csv", heading + "5,2,1700,50,1e150,2,9000\n5,3,1700,50,170,2,9000\n");
  const std::string start = "clutch predict " + model();
  ASSERT_EQ(here(start + "good.csv --state s.json").exit_code, 0);
  const std::string before = read(folder() / "s.json");
  const CommandResult hot = here(start + "hot.csv --state s.json --trace t.csv");
  EXPECT_EQ(hot.exit_code, 2);
  EXPECT_THAT(hot.err, HasSubstr("hot.csv, row 1: plate 5, cycle 2: the model has no finite"));
  EXPECT_EQ(read(folder() / "s.json"), before);
  EXPECT_FALSE(fs::exists(folder() / "t.csv"));
  const CommandResult skipped =
      here(start + "hot.csv --state s.json --trace t.csv --skip-not-finite");
  EXPECT_EQ(skipped.exit_code, 0) << skipped.err;
  EXPECT_THAT(skipped.out, HasSubstr("skipped 1"));
  EXPECT_TRUE(lines(read(folder() / "t.csv"))[1].ends_with(",skipped"));
  EXPECT_EQ(json::parse(read(folder() / "s.json"))["plates"][0]["skipped"], 1);
  EXPECT_EQ(json::parse(read(folder() / "s.json"))["plates"][0]["last_cycle"], 3);
}

// Each of several at once counts its plate, whoever comes first.
TEST_F(Clutch, PredictsAtOnceLoseNothing) {
  std::string together;
  for (int plate = 1; plate <= 6; ++plate) {
    write("p" + std::to_string(plate) + ".csv",
          heading + std::to_string(plate) + ",1,1700,50,170,2,9000\n");
    together += "'" WEARWELL_BINARY "' clutch predict " + model() + "p" + std::to_string(plate) +
                ".csv --state s.json >/dev/null || echo failed & ";
  }
  const CommandResult run = run_command("cd '" + folder().string() + "'; " + together + "wait");
  EXPECT_EQ(run.out, "");
  EXPECT_EQ(json::parse(read(folder() / "s.json"))["plates"].size(), 6u);
  EXPECT_FALSE(fs::exists(folder() / ".s.json.lock"));
}

TEST_F(Clutch, NothingOverwritesWhatItReads) {
  write("c.csv", heading + "5,1,1700,50,170,2,9000\n");
  fs::create_symlink("c.csv", folder() / "link.csv");
  write("model.json", read(shared_ / "result/model.json"));
  const std::string start = "clutch predict model.json c.csv ";
  for (const char* options : {"--trace c.csv", "--trace link.csv", "--state ./c.csv",
                              "--trace model.json", "--state new.json --trace ./new.json"}) {
    const CommandResult run = here(start + options);
    EXPECT_EQ(run.exit_code, 2) << options;
    EXPECT_THAT(run.err, HasSubstr("nothing is written")) << options;
  }
  EXPECT_EQ(read(folder() / "c.csv"), heading + "5,1,1700,50,170,2,9000\n");
  EXPECT_EQ(read(folder() / "model.json"), read(shared_ / "result/model.json"));
  write("traces.csv", read(shared_ / "traces.csv"));
  EXPECT_EQ(here("clutch features traces.csv -o traces.csv").exit_code, 2);
  EXPECT_EQ(read(folder() / "traces.csv"), read(shared_ / "traces.csv"));
}

TEST_F(Clutch, PredictTracesAndFlagsCycles) {
  write("c.csv", heading +
                     "5,1,1700,50,170,2,9000\n5,2,4000,50,170,2,20000\n5,3,1700,50,400,2,9000\n"
                     "5,7,1700,50,170,2,9000\n");
  const CommandResult run = here("clutch predict " + model() + " c.csv --trace trace.csv --json");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto trace = lines(read(folder() / "trace.csv"));
  ASSERT_EQ(trace.size(), 5u);
  EXPECT_EQ(trace[0],
            "plate,cycle,volume [mm^3],sd_scatter [mm^3],scatter_low [mm^3],scatter_high [mm^3],"
            "sd_full [mm^3],full_low [mm^3],full_high [mm^3],outside");
  EXPECT_TRUE(trace[1].ends_with(',')) << trace[1];
  EXPECT_TRUE(trace[2].ends_with(",slip_speed") || trace[2].ends_with(",slip_speed negative"))
      << trace[2];
  EXPECT_THAT(trace[3], HasSubstr(",temperature"));
  const json plate = json::parse(run.out)["plates"][0];
  EXPECT_EQ(plate["cycles"], 4);
  EXPECT_EQ(plate["last_cycle"], 7);
  EXPECT_EQ(plate["outside"]["slip_speed"], 1);
  EXPECT_EQ(plate["outside"]["temperature"], 1);
  EXPECT_EQ(plate["outside"]["torque"], 0);
  EXPECT_EQ(plate["outside_any"], 2);
  EXPECT_EQ(here("clutch predict " + model() + " c.csv --trace t2.csv --every 2").exit_code, 0);
  EXPECT_EQ(lines(read(folder() / "t2.csv")).size(), 3u);
  EXPECT_THAT(here("clutch predict " + model() + " c.csv").out,
              HasSubstr("slip_speed 1, temperature 1"));
}

// 1/2 x 50 N m x 178 rad/s x 2 s is 8.9 kJ.
TEST_F(Clutch, PredictHoldsEnergyAgainstTorqueSlipAndTime) {
  write("j.csv", heading + "5,1,1700,50,170,2,9000\n5,2,1700,50,170,2,9000\n");
  write("kj.csv",
        "plate,cycle,slip_speed [rpm],torque [N m],temperature [degC],closing_time [s],energy "
        "[kJ]\n5,1,1700,50,170,2,9000\n6,1,1700,50,170,2,9\n");
  const CommandResult right = here("clutch predict " + model() + " j.csv --json");
  EXPECT_EQ(right.exit_code, 0) << right.err;
  EXPECT_EQ(json::parse(right.out)["trusted"], true);
  const CommandResult wrong = here("clutch predict " + model() + " kj.csv --json");
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_THAT(wrong.err, HasSubstr("NOT TRUSTED: the energy of plate 5 is 1.01e+03 times"));
  EXPECT_THAT(wrong.err, testing::Not(HasSubstr("plate 6")));
  EXPECT_EQ(json::parse(wrong.out)["trusted"], false);
  EXPECT_EQ(json::parse(wrong.out)["problems"].size(), 2u);  // of the plate, and of its cycle
}

// A speed in revolutions a minute is one in rad/s; cycles are counted in any multiple.
TEST_F(Clutch, PredictReadsEveryUnit) {
  const std::string predict = "clutch predict " + model();
  write("a.csv", heading + "5,1000,1500,50,170,2,9000\n5,2000,1200,50,160,2,8000\n");
  const CommandResult expected = here(predict + "a.csv --json");
  ASSERT_EQ(expected.exit_code, 0) << expected.err;
  const std::string rest = ",torque [Nm],temperature [K],closing_time [ms],energy [kJ]\n";
  for (const auto& [unit, factor] : {std::pair{"1/min", 1.0}, {"Hz", 1. / 60}, {"deg/s", 6.0}}) {
    write("b.csv", fmt::format("plate,cycle [kcycles],slip_speed [{}]{}5,1,{:.17g},50,443.15,2000,9"
                               "\n5,2,{:.17g},50,433.15,2000,8\n",
                               unit, rest, 1500 * factor, 1200 * factor));
    const CommandResult run = here(predict + "b.csv --json");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const json a = json::parse(expected.out)["plates"][0], b = json::parse(run.out)["plates"][0];
    EXPECT_EQ(b["last_cycle"], 2000);
    EXPECT_NEAR(double(b["volume"]) / double(a["volume"]), 1, 1e-9) << unit;
  }
}

// A fleet: plates have names, and the state goes on with them.
TEST_F(Clutch, PlatesThatHaveNames) {
  const std::string predict = "clutch predict " + model();
  write("n.csv",
        heading + "1,1,1500,50,170,2,9000\n2,1,1500,50,170,2,8000\n1,2,1500,50,170,2,9000\n");
  write("v.csv",
        heading +
            "VIN-7,1,1500,50,170,2,9000\n\"B, 2\",1,1500,50,170,2,8000\nVIN-7,2,1500,50,170,2,"
            "9000\n");
  const CommandResult numbers = here(predict + "n.csv --json"),
                      named = here(predict + "v.csv --json --state s.json --trace t.csv");
  ASSERT_EQ(named.exit_code, 0) << named.err;
  const json a = json::parse(numbers.out)["plates"], b = json::parse(named.out)["plates"];
  EXPECT_EQ(b[0]["plate"], "VIN-7");
  EXPECT_EQ(b[1]["plate"], "B, 2");
  for (const int i : {0, 1}) EXPECT_EQ(a[i]["volume"], b[i]["volume"]);
  EXPECT_THAT(lines(read(folder() / "t.csv"))[2], testing::StartsWith("\"B, 2\",1,"));
  // As a logger writes it: semicolons, decimal commas, a row of units.
  write("u.csv",
        "plate;cycle;slip_speed;torque;temperature;closing_time;energy\n;;1/min;Nm;\xC2\xB0"
        "C;s;kJ\n"
        "VIN-7;1;1500;50;170;2,0;9,0\nB, 2;1;1500;50;170;2,0;8,0\nVIN-7;2;1500;50;170;2,0;9,0\n");
  const CommandResult logged = here(predict + "u.csv --json");
  ASSERT_EQ(logged.exit_code, 0) << logged.err;
  EXPECT_NEAR(double(json::parse(logged.out)["plates"][1]["volume"]) / double(b[1]["volume"]), 1,
              1e-12);
  write("w.csv", heading + "\"B, 2\",2,1500,50,170,2,8000\nVIN-9,1,1500,50,170,2,9000\n");
  const CommandResult on = here(predict + "w.csv --json --state s.json");
  ASSERT_EQ(on.exit_code, 0) << on.err;
  const json c = json::parse(on.out)["plates"];
  ASSERT_EQ(c.size(), 3u);
  EXPECT_EQ(c[1]["plate"], "B, 2");
  EXPECT_EQ(c[1]["cycles"], 2);
  EXPECT_EQ(c[2]["plate"], "VIN-9");
  EXPECT_THAT(here(predict + "n.csv --state s.json").err,
              HasSubstr("n.csv: its plates are numbers, but those of the state are names"));
  EXPECT_THAT(here(predict + "w.csv --state s.json").err,
              HasSubstr("row 1: plate B, 2, cycle 2 follows cycle 2; cycles must ascend"));
}

TEST_F(Clutch, PredictRefusesBadCycles) {
  const std::string good = "1,1,1700,50,170,2,9000\n";
  EXPECT_THAT(predict_refusal(heading + good + "1,3,1700,50,170,2,9000\n1,2,1700,50,170,2,9000\n"),
              HasSubstr("bad.csv, row 3: plate 1, cycle 2 follows cycle 3; cycles must ascend"));
  EXPECT_THAT(predict_refusal(heading + good + good), HasSubstr("row 2: plate 1, cycle 1 follows"));
  EXPECT_THAT(predict_refusal(heading + good + "1,2,1700,-50,170,2,9000\n"),
              HasSubstr("bad.csv, row 2, column 'torque [N m]': -50 must be a positive number"));
  EXPECT_THAT(predict_refusal(heading + good + "1,2,1700,50,,2,9000\n"),
              HasSubstr("row 2, column 'temperature [degC]': no value"));
  EXPECT_THAT(predict_refusal(heading + good + "1,2,1700,50,170,inf,9000\n"),
              HasSubstr("row 2, column 'closing_time [s]'"));
  EXPECT_THAT(predict_refusal(heading + good + "1,2.5,1700,50,170,2,9000\n"),
              HasSubstr("row 2, column 'cycle': 2.5 must be a whole number"));
  EXPECT_THAT(predict_refusal(heading + good + "1,2,1700,50,-290,2,9000\n"),
              HasSubstr("row 2, column 'temperature [degC]': -290 is below absolute zero"));
  EXPECT_THAT(predict_refusal(heading + good + "1,x,1700,50,170,2,9000\n"),
              HasSubstr("column 'cycle' does not hold numbers"));
  EXPECT_THAT(predict_refusal(""), HasSubstr("bad.csv is empty"));
  EXPECT_THAT(predict_refusal(heading), HasSubstr("bad.csv has no rows"));
  EXPECT_THAT(predict_refusal("plate,cycle\n1,1\n"),
              HasSubstr("has no column 'slip_speed [rad/s]'"));
  std::string wrong = heading;
  replace(wrong, "torque [N m]", "torque [N]");
  EXPECT_THAT(predict_refusal(wrong + good),
              AllOf(HasSubstr("column 'torque [N]'"), HasSubstr("wrong dimension")));
  wrong = heading;
  replace(wrong, "energy [J]", "energy");
  EXPECT_THAT(predict_refusal(wrong + good), HasSubstr("column 'energy' has no unit"));
  EXPECT_THAT(here("clutch predict '" + (shared_ / "study.toml").string() + "' c.csv").err,
              HasSubstr("study.toml"));
}

TEST_F(Clutch, FitRefusesBadCampaigns) {
  const auto c = cycles(), w = weighings();
  auto bad = w;
  bad.insert(bad.begin() + 3, w[2]);  // row 3 repeats row 2
  EXPECT_THAT(fit_refusal(c, bad),
              HasSubstr("weighings.csv, row 3: plate 1 is weighed twice at cycle 10"));
  bad = w;
  bad[3] = "1,30,run-in,260";
  EXPECT_THAT(fit_refusal(c, bad),
              AllOf(HasSubstr("weighings.csv, row 3: plate 1 gained"),
                    HasSubstr("between cycles 10 and 30: more than 4 standard deviations")));
  bad = c;
  std::swap(bad[5], bad[6]);
  EXPECT_THAT(fit_refusal(bad, w),
              HasSubstr("cycles.csv, row 6: plate 1, cycle 5 follows cycle 6; cycles must ascend"));
  bad = c;
  bad.erase(bad.begin() + 7);  // cycle 7 is not logged
  EXPECT_THAT(fit_refusal(bad, w),
              HasSubstr("weighings.csv, row 2: plate 1: 9 cycles are logged between the weighings "
                        "at 0 and 10, but 10 ran"));
  bad = c;
  replace(bad[0], "temperature [degC]", "temperatur [degC]");
  EXPECT_THAT(
      fit_refusal(bad, w),
      HasSubstr("cycles.csv has no column 'temperature [K]' (nearest: 'temperatur [degC]')"));
  bad = w;
  replace(bad[0], "mass [g]", "mass [mm]");
  EXPECT_THAT(fit_refusal(c, bad), HasSubstr("weighings.csv, column 'mass [mm]'"));
  EXPECT_THAT(fit_refusal({}, w), HasSubstr("cycles.csv is empty"));
  EXPECT_THAT(fit_refusal({c[0]}, w), HasSubstr("cycles.csv has no rows"));
  bad = w;
  for (std::string& line : bad) {
    const std::size_t at = line.find("point 17,");
    if (at != std::string::npos) line.replace(at, 8, "point 999");
  }
  EXPECT_THAT(fit_refusal(c, bad), HasSubstr("point 999 has cycles but is not in the design"));
  // Run-in alone: too little to model with.
  bad = {w[0]};
  for (const std::string& line : w) {
    if (line.find("point") == std::string::npos && line.find("sequence") == std::string::npos &&
        line.find("run-out") == std::string::npos && line != w[0])
      bad.push_back(line);
  }
  EXPECT_THAT(fit_refusal(c, bad), HasSubstr("0 points to fit; at least 25 are needed"));
}

// Cycles after the last weighing and points that were not run are kept out of the fit, and said.
TEST_F(Clutch, FitSaysWhatItDoesNotUse) {
  auto c = cycles(), w = weighings();
  std::string last = c.back();
  const std::string number = last.substr(last.find(',') + 1);
  const long long next = std::stoll(number) + 1;
  c.push_back(fmt::format("15,{}{}", next, number.substr(number.find(','))));
  auto design = lines(read(shared_ / "design.csv"));
  design.push_back("500,model,1200,25,120,1");
  write("cycles.csv", joined(c));
  write("weighings.csv", joined(w));
  write("design.csv", joined(design));
  write("traces.csv", read(shared_ / "traces.csv"));
  write("study.toml", study);
  const CommandResult run = here("fit study.toml -o out --json --no-report");
  ASSERT_LE(run.exit_code, 1) << run.err;
  const json check = json::parse(run.out)["checks"][0];
  EXPECT_EQ(check["verdict"], "warn");
  EXPECT_THAT(std::string(check["detail"]),
              AllOf(HasSubstr("no weighing of plate 15 follows 1 of its cycles"),
                    HasSubstr("points 500 of the design have no cycles")));
  EXPECT_FALSE(fs::exists(folder() / "out/report.html"));
}

// The last two blocks of plates 12 and 13 come one after the other: the fit of all, byte for byte.
TEST_F(Clutch, UpdateIsTheFitOfAllData) {
  const auto plate_of = [](const std::string& row) { return row.substr(0, row.find(',')); };
  const auto cycle_of = [](const std::string& row) {
    return std::stoll(row.substr(row.find(',') + 1));
  };
  auto c = cycles(), w = weighings();
  std::map<std::string, long long>
      known;  // of plates whose end is late, the last cycle that is not
  for (const std::string plate : {"12", "13"}) {
    std::vector<long long> at;
    for (const std::string& row : w)
      if (plate_of(row) == plate) at.push_back(cycle_of(row));
    ASSERT_GT(at.size(), 4u);
    known[plate] = at[at.size() - 3];
  }
  std::map<std::string, std::vector<std::string>> parts;  // by file
  const auto part = [&](const std::vector<std::string>& rows, const std::string& name) {
    for (const std::string file : {"", "12", "13"}) parts[name + file] = {rows.front()};
    for (std::size_t i = 1; i < rows.size(); ++i) {
      const auto late = known.find(plate_of(rows[i]));
      const bool is_late = late != known.end() && cycle_of(rows[i]) > late->second;
      parts[name + (is_late ? late->first : "")].push_back(rows[i]);
    }
  };
  part(c, "cycles");
  part(w, "weighings");
  for (const auto& [name, rows] : parts) write(name + ".csv", joined(rows));
  write("design.csv", read(shared_ / "design.csv"));
  write("traces.csv", read(shared_ / "traces.csv"));
  write("study.toml", study);
  const auto done = [&](const std::string& command) {
    const CommandResult run = here(command + " --quiet --no-report");
    EXPECT_LE(run.exit_code, 1) << command << "\n" << run.err;
  };
  done("fit study.toml -o r0");
  done("update r0 weighings13.csv cycles13.csv -o r1");
  done("update r1 cycles12.csv weighings12.csv cycles13.csv -o r2");
  done("update r0 cycles12.csv weighings12.csv cycles13.csv weighings13.csv -o at-once");
  const auto content = [&](const std::string& file) { return read(folder() / file); };
  EXPECT_EQ(content("r2/state.bin"), content("at-once/state.bin"));
  for (const char* file : {"state.bin", "model.json", "predictions.csv"}) {
    EXPECT_EQ(content(std::string("r2/") + file), read(shared_ / "result" / file)) << file;
    EXPECT_NE(content(std::string("r1/") + file), content(std::string("r2/") + file)) << file;
  }
  json reported = json::parse(content("r2/summary.json")), whole = summary_;
  EXPECT_EQ(reported["update"]["counted"],
            parts["cycles12"].size() + parts["weighings12"].size() - 2);
  EXPECT_EQ(reported["update"]["repeated"], parts["cycles13"].size() - 1);
  EXPECT_EQ(reported["checks"][0]["name"], "new-data");
  EXPECT_EQ(std::string(reported["checks"][0]["detail"]).find("sql"), std::string::npos);
  reported["checks"].erase(0);
  reported.erase("update");
  for (json* each : {&reported, &whole}) each->erase("seconds");
  EXPECT_EQ(reported, whole);
}

TEST_F(Clutch, UpdateRefusesWhatIsNoneOfItsTables) {
  const auto refusal = [&](const std::string& content) {
    write("new.csv", content);
    const CommandResult run = here("update '" + (shared_ / "result").string() + "' new.csv -o out");
    EXPECT_EQ(run.exit_code, 2) << run.out;
    EXPECT_FALSE(fs::exists(folder() / "out"));
    return run.err;
  };
  EXPECT_THAT(refusal("plate,cycle\n1,2\n"),
              AllOf(HasSubstr("is not a table of this campaign"), HasSubstr("weighings (block")));
  EXPECT_THAT(in_shared("life result").err, HasSubstr("has no posterior"));
}

TEST_F(Clutch, FitRefusesStudiesByKey) {
  write("design.csv", read(shared_ / "design.csv"));
  write("truth.toml", read(shared_ / "truth.toml"));
  const auto refusal = [&](const std::string& content) {
    const auto file = write("study.toml", content);
    const CommandResult run = here("fit study.toml -o out");
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_FALSE(fs::exists(folder() / "out"));
    return run.err;
  };
  const std::string simulation =
      "model = \"clutch-wear\"\n[simulation]\ndesign = \"design.csv\"\ntruth = \"truth.toml\"\n";
  EXPECT_THAT(refusal(simulation + "sed = 3\n"), HasSubstr("did you mean 'seed'?"));
  EXPECT_THAT(refusal(simulation + "[data]\ndesign = \"design.csv\"\n"),
              HasSubstr("keep one of them"));
  EXPECT_THAT(refusal("model = \"clutch-wear\"\n"), HasSubstr("[simulation]"));
  EXPECT_THAT(refusal(simulation + "[search]\nlowest = 0\n"), HasSubstr("search.lowest"));
  EXPECT_THAT(refusal(simulation + "[search]\nstep = 0.0001\n"), HasSubstr("search.step"));
  EXPECT_THAT(refusal(simulation + "[life]\nlevels = [0.5, -1]\n"), HasSubstr("life.levels"));
  EXPECT_THAT(refusal(simulation + "[life.points.a]\nslip_speed = \"1 N\"\n"),
              HasSubstr("life.points.a.slip_speed"));
  EXPECT_THAT(refusal("model = \"clutch-wear\"\n[simulation]\ndesign = \"none.csv\"\n"
                      "truth = \"truth.toml\"\n"),
              HasSubstr("none.csv"));
  EXPECT_THAT(in_shared("fit study.toml --seed 2 -o out").err,
              HasSubstr("a clutch study has its seeds in the study file"));
}

TEST_F(Clutch, ReportAndCompareTakeItAsAnyOther) {
  EXPECT_EQ(in_shared("report result").exit_code, 0);
  const CommandResult compare = in_shared("compare result result");
  EXPECT_EQ(compare.exit_code, 0) << compare.err;
  EXPECT_THAT(compare.out, AllOf(HasSubstr("w0 [mm^3/MJ]"), HasSubstr("elpd")));
}

TEST_F(Clutch, CheckAndNew) {
  const CommandResult check = in_shared("check study.toml");
  EXPECT_EQ(check.exit_code, 0) << check.err;
  EXPECT_THAT(check.out, AllOf(HasSubstr("81 points of the factorial, 20 beyond it, 20 held out"),
                               HasSubstr("of 15 plates"), HasSubstr("worn-out volume 500 mm^3"),
                               HasSubstr("at each of 4 pairs"),
                               HasSubstr("launch: 1700 rpm, 50 N m, 170 degC, 2.15 s")));
  const CommandResult made = here("new clutch mine && '" WEARWELL_BINARY "' check mine/study.toml");
  EXPECT_EQ(made.exit_code, 0) << made.err;
  EXPECT_THAT(made.out, HasSubstr("simulated from a known truth"));
  for (const char* file : {"study.toml", "design.csv", "truth.toml"})
    EXPECT_EQ(read(folder() / "mine" / file), read(example + file));
}

TEST_F(Clutch, Features) {
  const auto trace = lines(read(shared_ / "traces.csv"));
  const CommandResult good = in_shared("clutch features traces.csv");
  EXPECT_EQ(good.exit_code, 0) << good.err;
  const auto found = lines(good.out);
  ASSERT_EQ(found.size(), 6u) << "five closings are traced";
  // What features writes, predict reads.
  write("cycles.csv", good.out);
  EXPECT_EQ(here("clutch predict " + model() + " cycles.csv").exit_code, 0);

  const auto features = [&](const std::vector<std::string>& rows) {
    write("t.csv", joined(rows));
    return here("clutch features t.csv -o out.csv");
  };
  auto bad = trace;
  bad.erase(bad.begin() + 100, bad.begin() + 130);  // of 50 to 390 samples of slip
  CommandResult run = features(bad);
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("plate 1, closing 1 at 0.5"));
  EXPECT_THAT(run.err, HasSubstr(": gap"));
  EXPECT_EQ(lines(read(folder() / "out.csv")).size(), 6u) << "none is left out";
  bad.assign(trace.begin(), trace.begin() + 200);
  run = features(bad);
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("closing 1 at 0.5"));
  EXPECT_THAT(run.err, HasSubstr("never closes"));
  bad = trace;
  bad[0] = "plate,time [s],slip_speed [rad/s],raw [N m],temperature [degC]";
  run = features(bad);
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("t.csv has no column 'torque [N m]'"));
  bad[0] = "plate,time [s],slip_speed [m/s],torque [N m],temperature [degC]";
  EXPECT_THAT(features(bad).err, HasSubstr("column 'slip_speed [m/s]'"));
  bad = {trace[0]};
  for (int i = 0; i < 60; ++i) bad.push_back(fmt::format("1,{},{},-30,150", 0.01 * i, 100 - 2 * i));
  run = features(bad);
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("torque of the wrong sign"));
  bad = trace;
  std::swap(bad[10], bad[11]);
  run = features(bad);
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, AllOf(HasSubstr("t.csv, row 11: time"), HasSubstr("must ascend")));
  EXPECT_THAT(features({trace[0], "1,0,100,0,150"}).err, HasSubstr("has no closing"));
  EXPECT_THAT(features({}).err, HasSubstr("t.csv is empty"));
  EXPECT_EQ(here("clutch features t.csv --torque-on '2 kg'").exit_code, 2);
  EXPECT_THAT(here("clutch features t.csv --slip-off '3 ms'").err,
              HasSubstr("--slip-off: unit 'ms'"));
  EXPECT_THAT(here("clutch features t.csv --slip-off '4 1/s'").err,
              HasSubstr("4 rev/s = 25.13 rad/s, or 4 rad/s = 0.6366 rev/s"));
}

TEST_F(Clutch, DesignAndSimulate) {
  const CommandResult design = here("clutch design --inside 3 --outside 2");
  EXPECT_EQ(design.exit_code, 0) << design.err;
  EXPECT_EQ(lines(design.out).size(), 1u + 81 + 2 + 3);
  EXPECT_EQ(lines(design.out)[1], "1,model,1200,25,120,0.9");
  const auto refusal = [&](const std::string& arguments) {
    const CommandResult run = here("clutch design " + arguments);
    EXPECT_EQ(run.exit_code, 2) << arguments;
    EXPECT_EQ(run.out, "");
    return run.err;
  };
  EXPECT_THAT(refusal("--torque '25, 50, 75'"),
              HasSubstr("--torque: '25, 50, 75': the unit is missing"));
  EXPECT_THAT(refusal("--torque '25, 50 kg'"), HasSubstr("--torque: '25, 50 kg'"));
  EXPECT_EQ(
      lines(here("clutch design --inside 3 --outside 2 --slip-speed '1200, 1700, 2800 1/min'").out),
      lines(design.out));
  EXPECT_THAT(refusal("--slip-speed '20, 30, 50 1/s'"), HasSubstr("write rev/s"));
  EXPECT_THAT(refusal("--torque '25 N m'"), HasSubstr("torque needs at least two levels"));
  EXPECT_THAT(refusal("--torque '25,, 50 N m'"), HasSubstr("write numbers separated by commas"));
  EXPECT_THAT(refusal("--feasible-torque '30 .. 80 N m'"), HasSubstr("feasible range of torque"));
  EXPECT_THAT(refusal("--feasible-torque '20 N m'"), HasSubstr("LOW .. HIGH UNIT"));
  EXPECT_THAT(refusal("--most-energy '1 kJ'"), HasSubstr("more than feasible"));

  const CommandResult again =
      in_shared("clutch simulate --design design.csv --truth truth.toml -o '" +
                (folder() / "b").string() + "'");
  EXPECT_EQ(again.exit_code, 0);
  for (const char* file : {"cycles.csv", "weighings.csv", "traces.csv", "realized.csv"})
    EXPECT_EQ(read(folder() / "b" / file), read(shared_ / file)) << file;
  std::string truth = read(shared_ / "truth.toml");
  replace(truth, "fast = 4", "fast = -4");
  write("truth.toml", truth);
  EXPECT_THAT(in_shared("clutch simulate --design design.csv --truth '" +
                        (folder() / "truth.toml").string() + "' -o c")
                  .err,
              AllOf(HasSubstr("run_in.fast"), HasSubstr("must not be negative")));
}

TEST_F(Clutch, LifeAndCompare) {
  const std::string at =
      "--slip-speed '1700 rpm' --torque '50 N m' --temperature '170 degC' --closing-time '2.15 s' ";
  const CommandResult run = here("clutch life " + model() + at + "--level 10,100 --json");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json life = json::parse(run.out);
  const json& fitted = summary_["life"][0];
  EXPECT_NEAR(double(life["levels"][1]["repetitions"]) / double(fitted["levels"][4]["cycles"]), 1,
              1e-12);
  // A duty of the same cycle twice lasts half as long.
  write("duty.csv", heading + "1,1,1700,50,170,2.15,9569\n1,2,1700,50,170,2.15,9569\n");
  const CommandResult duty = here("clutch life " + model() + "--duty duty.csv --level 100 --json");
  EXPECT_NEAR(2 * double(json::parse(duty.out)["levels"][0]["repetitions"]) /
                  double(life["levels"][1]["repetitions"]),
              1, 1e-4);
  EXPECT_THAT(here("clutch life " + model()).err, HasSubstr("--slip-speed is missing"));
  EXPECT_THAT(here("clutch life " + model() + at + "--level 0").err, HasSubstr("must be positive"));
  EXPECT_THAT(here("clutch life " + model() +
                   "--slip-speed '9000 rpm' --torque '50 N m' --temperature '170 degC' "
                   "--closing-time '2.15 s'")
                  .out,
              HasSubstr("Outside the calibrated range: slip_speed"));
  const CommandResult compared = in_shared("clutch compare result result");
  EXPECT_EQ(compared.exit_code, 0) << compared.err;
  EXPECT_EQ(lines(compared.out).size(), 3u);
  EXPECT_EQ(in_shared("clutch compare nothing").exit_code, 2);
}

}  // namespace
}  // namespace wearwell
