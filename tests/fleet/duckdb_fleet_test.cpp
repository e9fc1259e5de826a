// `wearwell fleet` over files: the numbers of `wearwell clutch predict`, whatever the order of rows.
#include <gmock/gmock.h>

#include "fleet/sample_fleet.h"
#include "support/scratch.h"

namespace wearwell::clutch {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

class DuckdbFleet : public ScratchTest {
 protected:
  std::string model(ScatterKind kind = ScatterKind::linear) {
    write("model.json", to_json(fleet_model(kind)).dump(1));
    return path("model.json");
  }
  std::string path(const std::string& name) const { return "'" + (folder() / name).string() + "'"; }
  std::string output() const { return " -o " + path("results"); }
  std::string file(const std::string& name, const std::vector<FleetCycle>& cycles) {
    write(name, fleet_csv(cycles));
    return path(name);
  }
};

// Where the map is negative, a cycle wears nothing, of each replicate by itself: the same as CycleSum, with every formula of the
// scatter.
TEST_F(DuckdbFleet, HasTheNumbersOfPredict) {
  const auto cycles = fleet_cycles(4000, 7, 1);
  const std::string table = file("cycles.csv", cycles);
  for (const ScatterKind kind : scatter_kinds) {
    const std::string name = model(kind);
    const json predicted =
        json::parse(run_wearwell("clutch predict " + name + " " + table + " --json").out);
    const json fleet = fleet_summary(name + " " + table + output());
    EXPECT_LT(difference(fleet, predicted), 1e-12) << name_of(kind);
    double negative = 0;
    for (const auto& each : fleet["worst"]) negative += each["negative"].get<double>();
    EXPECT_GT(negative, 100);
  }
}

TEST_F(DuckdbFleet, ScatterAloneIsTheSameWithoutReplicates) {
  const std::string name = model(), table = file("cycles.csv", fleet_cycles(2000, 3, 2));
  const json predicted = json::parse(
      run_wearwell("clutch predict " + name + " " + table + " --scatter-only --json").out);
  const json fleet = fleet_summary(name + " " + table + output() + " --scatter-only");
  for (const auto& p : predicted["plates"]) {
    for (const auto& u : fleet["worst"]) {
      if (u["unit"] == p["plate"]) {
        EXPECT_NEAR(u["sd_scatter"].get<double>() / p["sd_scatter"].get<double>(), 1, 1e-12);
      }
    }
  }
}

TEST_F(DuckdbFleet, NoOrderOfRowsNorCutNorThreadsChangesABit) {
  const auto cycles = fleet_cycles(6000, 5, 3);
  const std::string name = model();
  const json whole = fleet_summary(name + " " + file("a.csv", cycles) + output());
  const auto other = shuffled(cycles, 4);
  const std::size_t half = other.size() / 2;
  const std::string first =
      file("b1.csv", {other.begin(), other.begin() + static_cast<long>(half)});
  const std::string second = file("b2.csv", {other.begin() + static_cast<long>(half), other.end()});
  const json cut = fleet_summary(name + " " + second + " " + first + output() + " --threads 1");
  EXPECT_EQ(whole["worst"].dump(), cut["worst"].dump());
  EXPECT_EQ(whole["levels"].dump(), cut["levels"].dump());
  const json pattern =
      fleet_summary(name + " '" + (folder() / "b*.csv").string() + "'" + output() + " --threads 2");
  EXPECT_EQ(whole["worst"].dump(), pattern["worst"].dump());
}

TEST_F(DuckdbFleet, DayByDayIsAllAtOnce) {
  const auto cycles = fleet_cycles(3000, 4, 5);
  const std::string name = model(), state = " --state " + path("sums.duckdb");
  const json whole = fleet_summary(name + " " + file("all.csv", cycles) + output());
  const std::string monday = file("monday.csv", {cycles.begin(), cycles.begin() + 1300});
  const std::string tuesday = file("tuesday.csv", {cycles.begin() + 1300, cycles.end()});
  fleet_summary(name + " " + monday + output() + state);
  const json both = fleet_summary(name + " " + tuesday + output() + state);
  EXPECT_EQ(whole["worst"].dump(), both["worst"].dump());
  // What was counted is not counted again.
  const json again = fleet_summary(name + " " + path("all.csv") + output() + state);
  EXPECT_EQ(whole["worst"].dump(), again["worst"].dump());
}

TEST_F(DuckdbFleet, RowsThatComeLateAreRefusedAndNothingIsKept) {
  const auto cycles = fleet_cycles(3000, 4, 6);
  const std::string name = model(), state = " --state " + path("sums.duckdb");
  std::vector<FleetCycle> lost = cycles;
  lost.erase(lost.begin() + 700);
  fleet_summary(name + " " + file("lost.csv", lost) + output() + state);
  const CommandResult late =
      run_wearwell("fleet " + name + " " + file("all.csv", cycles) + output() + state);
  EXPECT_EQ(late.exit_code, 2);
  EXPECT_THAT(late.err, AllOf(HasSubstr(cycles[700].unit), HasSubstr("came late")));
  const json again = fleet_summary(name + " " + path("lost.csv") + output() + state);
  const json whole = fleet_summary(name + " " + path("lost.csv") + output());
  EXPECT_EQ(whole["worst"].dump(), again["worst"].dump());
}

TEST_F(DuckdbFleet, WhatCannotBeIsRefused) {
  const std::string name = model();
  const auto cycles = fleet_cycles(200, 2, 7);
  const auto refused = [&](std::vector<FleetCycle> changed, const std::string& part) {
    const CommandResult run =
        run_wearwell("fleet " + name + " " + file("bad.csv", changed) + output());
    EXPECT_EQ(run.exit_code, 2) << part;
    EXPECT_THAT(run.err, HasSubstr(part));
    EXPECT_FALSE(std::filesystem::exists(folder() / "results"));
  };
  auto changed = cycles;
  changed[50].torque = -1;
  refused(changed, "1 rows of 200 have no value, or one that cannot be");
  changed = cycles;
  changed[50].temperature = -300;
  refused(changed, "cannot be");
  changed = cycles;
  changed[50].energy = NAN;
  refused(changed, "cannot be");
  changed = cycles;
  changed[51].unit = changed[50].unit;
  changed[51].number = changed[50].number;
  refused(changed, "stands there twice");
  changed = cycles;
  changed[50].unit = "";
  refused(changed, "1 rows name no unit");
  // Beyond what the sums hold.
  changed = cycles;
  changed[50].temperature = 1e12;
  refused(changed, "beyond what the sums hold");
}

// Names are quoted and texts are data, whatever is in them.
TEST_F(DuckdbFleet, HostileNamesAndLabelsAreHarmless) {
  auto cycles = fleet_cycles(600, 3, 8);
  const std::string name = model();
  const json plain = fleet_summary(name + " " + file("plain.csv", cycles) + output());
  const std::vector<std::string> labels = {"'; drop table wearwell_sums; --", "x' or '1'='1",
                                           "$(rm -rf /) \\ %s {} ☃"};
  for (FleetCycle& each : cycles)
    each.unit = "\"" + labels[static_cast<std::size_t>(each.unit.back() - '1')] + "\"";
  std::string text = fleet_csv(cycles);
  const std::string column = "a'b; drop table cycles; -- %s {} select";
  text.replace(text.find("torque [N m]"), std::string("torque [N m]").size(), column);
  text.replace(0, std::string("plate").size(), "\"select\"\"\"\"from\"");
  write("hos'tile.csv", text);
  const std::string options = " \"" + (folder() / "hos'tile.csv").string() +
                              "\" --columns \"torque=" + column + ":N m\" 'unit=select\"\"from'";
  const json hostile = fleet_summary(name + options + output());
  ASSERT_EQ(hostile["worst"].size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(hostile["worst"][i]["volume"], plain["worst"][i]["volume"]);
    EXPECT_NE(
        std::find(labels.begin(), labels.end(), hostile["worst"][i]["unit"].get<std::string>()),
        labels.end());
  }
}

}  // namespace
}  // namespace wearwell::clutch
