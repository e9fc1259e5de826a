// `wearwell update` and `wearwell life`: what comes one by one is what all of it at once is.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "support/run_command.h"
#include "support/scratch.h"

namespace wearwell {
namespace {

using nlohmann::json;
using testing::HasSubstr;
namespace fs = std::filesystem;

std::string slurp(const fs::path& file) {
  std::stringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

// The heading of a CSV, and its rows.
struct Rows {
  std::string heading;
  std::vector<std::string> lines;

  explicit Rows(const std::string& file) {
    std::ifstream stream(file);
    std::getline(stream, heading);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
  }
  std::string some(const std::function<bool(const std::string&)>& wanted) const {
    std::string text = heading + "\n";
    for (const std::string& line : lines) {
      if (wanted(line)) text += line + "\n";
    }
    return text;
  }
};

double cell(const std::string& line, int column) {
  std::stringstream stream(line);
  std::string text;
  for (int c = 0; c <= column; ++c) std::getline(stream, text, ',');
  return std::stod(text);
}

class UpdateCommand : public ScratchTest {
 protected:
  CommandResult run(const std::string& arguments) {
    return run_command("cd '" + folder().string() + "' && '" WEARWELL_BINARY "' " + arguments);
  }
  json summary(const std::string& result) const {
    return json::parse(slurp(folder() / result / "summary.json"));
  }
  // Without what update adds.
  static json of_a_fit(json summary) {
    summary.erase("update");
    const auto drop = [](json& checks) {
      for (std::size_t i = 0; i < checks.size(); ++i) {
        if (checks[i]["name"] == "new-data") checks.erase(i--);
      }
    };
    drop(summary["checks"]);
    if (summary.contains("stages")) {
      for (json& stage : summary["stages"]) drop(stage["checks"]);
    }
    return summary;
  }
  // Every file of the result of all data, but for what says how the rows came.
  void expect_same(const std::string& result, const std::string& all) {
    for (const auto& each : fs::recursive_directory_iterator(folder() / all)) {
      const std::string name = fs::relative(each.path(), folder() / all);
      if (!each.is_regular_file() || name == "results.sha1" || name == "summary.json") continue;
      EXPECT_EQ(slurp(folder() / result / name), slurp(each.path())) << name;
    }
    EXPECT_EQ(of_a_fit(summary(result)), summary(all));
  }
};

// The paper's joint: each inspection before the next one. To the last bit of every draw.
TEST_F(UpdateCommand, FiveInspectionsOneByOneAreTheFitOfAll) {
  const Rows rows(PROJECT_SOURCE_DIR "/examples/joint/joint_wear.csv");
  const std::vector<double> cycles = {1000, 5000, 10000, 20585};
  write("joint_wear.csv", rows.some([](const auto& line) { return cell(line, 1) <= 100; }));
  write("study.toml", slurp(PROJECT_SOURCE_DIR "/examples/joint/study.toml"));
  const std::string quiet = " --quiet --no-report -o ";
  ASSERT_LE(run("fit study.toml --seed 5" + quiet + "r0").exit_code, 1);
  for (std::size_t i = 0; i < cycles.size(); ++i) {
    const std::string file = fmt::format("inspection{}.csv", i + 1);
    write(file, rows.some([&](const auto& line) { return cell(line, 1) == cycles[i]; }));
    const CommandResult update = run(fmt::format("update r{} {}{}r{}", i, file, quiet, i + 1));
    ASSERT_LE(update.exit_code, 1) << update.err;
  }
  write("joint_wear.csv", rows.some([](const auto&) { return true; }));
  ASSERT_LE(run("fit study.toml --seed 5" + quiet + "all").exit_code, 1);
  expect_same("r4", "all");
  // In another order, one of them twice, out of what was known first.
  ASSERT_LE(run("update r0 inspection4.csv inspection3.csv inspection1.csv inspection3.csv "
                "inspection2.csv" +
                quiet + "late")
                .exit_code,
            1);
  expect_same("late", "all");
  EXPECT_EQ(summary("late")["update"]["repeated"], 2);
  EXPECT_EQ(slurp(folder() / "late/state.bin"), slurp(folder() / "r4/state.bin"));
}

// Bearings and S-N tests in canonical order, halved: by quadrature as the fit of all.
TEST_F(UpdateCommand, OtherTradesAreTheirFitOfAll) {
  for (const auto& [example, file, option] : std::vector<std::array<std::string, 3>>{
           {"bearing", "inspections.csv", ""}, {"fatigue", "tests.csv", " --repeated another"}}) {
    const Rows rows(PROJECT_SOURCE_DIR "/examples/" + example + "/" + file);
    std::size_t i = 0;
    write(file, rows.some([&](const auto&) { return i++ % 3 != 0; }));
    i = 0;
    write("more.csv", rows.some([&](const auto&) { return i++ % 3 == 0; }));
    write("study.toml", slurp(PROJECT_SOURCE_DIR "/examples/" + example + "/study.toml"));
    const std::string quiet = " --quiet --no-report -o " + example;
    ASSERT_LE(run("fit study.toml --method exact" + quiet + "_first").exit_code, 1);
    const CommandResult update =
        run("update " + example + "_first more.csv" + option + quiet + "_both");
    ASSERT_LE(update.exit_code, 1) << update.err;
    write(file, slurp(PROJECT_SOURCE_DIR "/examples/" + example + "/" + file));
    ASSERT_LE(run("fit study.toml --method exact" + quiet + "_all").exit_code, 1);
    const json both = summary(example + "_both"), all = summary(example + "_all");
    for (const auto& [name, parameter] : all["parameters"].items()) {
      for (const char* number : {"mean", "sd", "q05", "q95"}) {
        const double expected = parameter[number];
        EXPECT_NEAR(both["parameters"][name][number], expected, 1e-4 * std::abs(expected))
            << example << " " << name << " " << number;
      }
    }
  }
}

// Machines of which each wears at its own pace: late readings, another unit of measure, a machine that is new.
TEST_F(UpdateCommand, MachinesThatDifferAreTheirFitOfAll) {
  write("study.toml", R"(model = "formula"
[data]
file = "wear.csv"
[data.columns]
wear    = { column = "wear_um", unit = "um" }
time    = { column = "hours", unit = "h" }
machine = "machine"
[formula]
depth = "rate * time"
[likelihood.wear]
family = "normal"
mean   = "depth"
sd     = "sigma"
[prior]
rate    = { distribution = "lognormal", median = "0.1 um/h", log_sd = 1 }
sigma   = { distribution = "half-normal", scale = "2 um" }
scatter = { distribution = "half-normal", scale = 0.5 }
[random_effects.machine]
rate = { distribution = "lognormal", log_sd = "scatter" }
[predict]
along = "time"
limit = { depth = "100 um" }
)");
  std::string first = "machine,hours,wear_um\n", all = first, late = "wear [mm],machine,hours\n";
  for (int machine = 1; machine <= 11; machine += 2) {
    for (int reading = 1; reading <= 4; ++reading) {
      const double hours = 100 * reading;
      const double wear =
          hours * 0.1 * (1 + 0.05 * (machine % 4)) + 0.5 * std::sin(7.0 * machine + 3.0 * reading);
      const std::string line = fmt::format("M{},{:.0f},{:.2f}\n", machine, hours, wear);
      all += line;
      if (reading != 2 && machine != 9) {
        first += line;
      } else {  // later ones first
        late.insert(late.find('\n') + 1,
                    fmt::format("{:.5f},M{},{:.0f}\n", 1e-3 * std::round(100 * wear) / 100, machine,
                                hours));
      }
    }
  }
  const std::string quiet = " --quiet --no-report -o ";
  write("wear.csv", first);
  write("late.csv", late);
  ASSERT_LE(run("fit study.toml --method exact" + quiet + "r").exit_code, 1);
  const CommandResult update = run("update r late.csv" + quiet + "both");
  ASSERT_LE(update.exit_code, 1) << update.err;
  write("wear.csv", all);
  ASSERT_LE(run("fit study.toml --method exact" + quiet + "all").exit_code, 1);
  expect_same("both", "all");

  const json fitted = json::parse(run("life both --unit M5 --json").out);
  const json moved = json::parse(run("life r --unit M5 --readings late.csv --json").out);
  EXPECT_EQ(fitted["of"], "machine M5");
  for (const char* number : {"b1", "q05", "q50", "q95"})
    EXPECT_NEAR(moved[number], fitted[number], 2e-3 * fitted[number].get<double>()) << number;
  const json fitted_all = summary("all");
  for (const json& each : fitted_all["quantities"]) {
    if (each["of"] != "machine M5" || each["name"] != "remaining useful life") continue;
    EXPECT_NEAR(fitted["q50"], each["q50"], 2e-3 * each["q50"].get<double>());
  }
  // The path ahead is at the limit where half of its lives end.
  const CommandResult with_path = run("life both --unit M5 --path path.csv");
  EXPECT_LE(with_path.exit_code, 1) << with_path.err;
  EXPECT_THAT(with_path.out, HasSubstr("The forecast is in path.csv"));
  std::istringstream path(slurp(folder() / "path.csv"));
  std::string row;
  std::getline(path, row);
  EXPECT_EQ(row, "time [h],depth 5 % [um],depth 50 % [um],depth 95 % [um]\r");
  double nearest = 1e9, at_limit = 0;
  int rows = 0;
  for (; std::getline(path, row); ++rows) {
    double at = 0, low = 0, middle = 0, high = 0;
    ASSERT_EQ(std::sscanf(row.c_str(), "%lf,%lf,%lf,%lf", &at, &low, &middle, &high), 4) << row;
    EXPECT_TRUE(low <= middle && middle <= high) << row;
    if (std::abs(middle - 100) < nearest) {
      nearest = std::abs(middle - 100);
      at_limit = at;
    }
  }
  EXPECT_EQ(rows, 25);
  EXPECT_NEAR(at_limit - 400, fitted["q50"], 0.02 * fitted["q50"].get<double>());
  const CommandResult before = run("life both --unit M5 --survived '300 h'");
  EXPECT_EQ(before.exit_code, 2);
  EXPECT_THAT(before.err, HasSubstr("has readings beyond 300 h already"));
  EXPECT_THAT(
      run("life both --unit M6").err,
      HasSubstr("'M6' is unknown; did you mean 'M1'? (known: M1, M11, M3, M5, M7, M9; without "
                "--unit a new machine)"));

  write("slip.csv", "machine,hours,wear_um\nM5,450,52\n");
  EXPECT_THAT(run("life both --unit M5 --readings slip.csv").out,
              HasSubstr("check machine M5 at hours = 450: two-sided predictive p-value"));
}

TEST_F(UpdateCommand, TellsWhatContradictsLoudly) {
  write("study.toml", slurp(PROJECT_SOURCE_DIR "/examples/joint/pointwise.toml"));
  const Rows rows(PROJECT_SOURCE_DIR "/examples/joint/joint_wear.csv");
  write("joint_wear.csv", slurp(PROJECT_SOURCE_DIR "/examples/joint/joint_wear.csv"));
  ASSERT_LE(run("fit study.toml --quiet --no-report -o r").exit_code, 1);
  write("slip.csv", rows.heading + "\n0,30000,64,9999,1795,1\n");
  const CommandResult update = run("update r slip.csv --no-report -o r2");
  EXPECT_THAT(update.out, HasSubstr("new-data"));
  EXPECT_THAT(update.out, HasSubstr("1 contradicts the earlier posterior"));
  const json reported = summary("r2")["update"];
  ASSERT_EQ(reported["contradictions"].size(), 1u);
  EXPECT_THAT(reported["contradictions"][0]["place"].get<std::string>(), HasSubstr("30000"));
  EXPECT_EQ(reported["counted"], 1);
}

TEST_F(UpdateCommand, RefusesWithNothingWritten) {
  write("study.toml", slurp(PROJECT_SOURCE_DIR "/examples/joint/study.toml"));
  write("joint_wear.csv", slurp(PROJECT_SOURCE_DIR "/examples/joint/joint_wear.csv"));
  ASSERT_LE(run("fit study.toml --quiet --no-report -o r").exit_code, 1);
  write("new.csv", "cycles,volume_mm3\nmany,3\n");
  const CommandResult wrong = run("update r new.csv -o r2");
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("new.csv, row 1, column 'cycles'"));
  EXPECT_FALSE(fs::exists(folder() / "r2"));
  std::string bytes = slurp(folder() / "r/state.bin");
  bytes[bytes.size() / 2] ^= 1;
  write("r/state.bin", bytes);
  fs::create_directory(folder() / "campaign");
  write("campaign/summary.json", R"({"model": "clutch-wear"})");
  const CommandResult clutch = run("update campaign new.csv -o r2");
  EXPECT_EQ(clutch.exit_code, 2);
  EXPECT_THAT(clutch.err, HasSubstr("Add the rows to its files and fit it again"));
  const CommandResult damaged = run("life r");
  EXPECT_EQ(damaged.exit_code, 2);
  EXPECT_THAT(damaged.err, HasSubstr("truncated or damaged"));
}

// What life tells at the last inspection is what the fit told of it; and it goes on from there.
TEST_F(UpdateCommand, LifeIsThatOfTheFit) {
  write("study.toml", slurp(PROJECT_SOURCE_DIR "/examples/joint/study.toml"));
  write("joint_wear.csv", slurp(PROJECT_SOURCE_DIR "/examples/joint/joint_wear.csv"));
  ASSERT_EQ(run("fit study.toml --quiet --no-report -o r").exit_code, 0);
  const json fitted = summary("r")["life"];
  const CommandResult now = run("life r --horizon '6000 cycles' --json -o curve.csv");
  ASSERT_EQ(now.exit_code, 0) << now.err;
  const json life = json::parse(now.out);
  const double within = fitted["inspect_within"];
  EXPECT_NEAR(life["inspect_within"], within, 1e-6 * within);
  EXPECT_NEAR(life["b50"].get<double>() + 10000, fitted["b50"], 3);
  EXPECT_GT(life["horizon"]["reached"], 0);
  EXPECT_LT(life["horizon"]["reached"], 0.01);
  EXPECT_THAT(slurp(folder() / "curve.csv"),
              HasSubstr("remaining useful life [cycles],survival\r\n"));
  // Survival beyond s + t over that beyond s.
  const json later = json::parse(run("life r --survived '16000 cycles' --json").out);
  EXPECT_NEAR(later["passed"], life["horizon"]["reached"], 2e-4);
}

}  // namespace
}  // namespace wearwell
