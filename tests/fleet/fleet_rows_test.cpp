// Rows and files that are not as they should be: left out and weighed, CSV of other countries, names of columns, remote files.
#include <gmock/gmock.h>

#include <algorithm>
#include <boost/algorithm/string/replace.hpp>

#include "fleet/sample_fleet.h"
#include "support/scratch.h"
#include "wearwell/models/clutch/left_out.h"

namespace wearwell::clutch {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class FleetRows : public ScratchTest {
 protected:
  std::string model() {
    write("model.json", to_json(fleet_model(ScatterKind::linear)).dump(1));
    return path("model.json");
  }
  std::string path(const std::string& name) const { return "'" + (folder() / name).string() + "'"; }
  std::string output() const { return " -o " + path("results"); }
  std::string file(const std::string& name, const std::vector<FleetCycle>& cycles) {
    write(name, fleet_csv(cycles));
    return path(name);
  }
  void refused(const std::string& arguments, const std::string& part) const {
    const CommandResult run = run_wearwell("fleet " + arguments + output());
    EXPECT_EQ(run.exit_code, 2) << part;
    EXPECT_THAT(run.err, HasSubstr(part));
    EXPECT_FALSE(std::filesystem::exists(folder() / "results"));
  }
};

json with_exit_code(const std::string& arguments, int exit_code) {
  const CommandResult run = run_wearwell("fleet " + arguments + " --json");
  EXPECT_EQ(run.exit_code, exit_code) << run.err;
  return run.out.empty() ? json() : json::parse(run.out);
}

/// The CSV with bad rows added: of each kind one, of units that have others; two of them with an energy that no closing has.
std::string with_bad_rows(const std::vector<FleetCycle>& cycles) {
  std::string text = fleet_csv(cycles);
  for (const char* row : {"unit 1,90001,100,50,150,two,9000", "unit 1,90002,100,-50,150,2,9000",
                          "unit 1,90003,-1,-50,150,2,9000", "unit 2,2.5,100,50,150,2,9000",
                          "unit 2,90004,100,50,-300,2,9e7", "unit 2,90005,100,50,150,2,",
                          ",90006,100,50,150,2,9e7", "unit 3,90007,100,50"})
    text += std::string(row) + "\n";
  return text;
}

// The answer is that of the other rows, bit by bit, in both ways through the rows; the rows left out are counted by reason.
TEST_F(FleetRows, LeftOutAreCountedAndChangeNothingElse) {
  const auto cycles = fleet_cycles(3000, 4, 31);
  const std::string name = model();
  write("bad.csv", with_bad_rows(cycles));
  file("good.csv", cycles);
  for (const char* way : {"", " --statements"}) {
    const json good = fleet_summary(name + " " + path("good.csv") + output() + way);
    const json fleet = fleet_summary(name + " " + path("bad.csv") + output() + " --skip-bad" + way);
    EXPECT_EQ(fleet["worst"].dump(), good["worst"].dump()) << way;
    EXPECT_EQ(fleet["levels"].dump(), good["levels"].dump()) << way;
    EXPECT_EQ(fleet["fleet"]["rows"], 3008);
    const json& left_out = fleet["left_out"];
    EXPECT_EQ(left_out["rows"], 8);
    EXPECT_EQ(left_out["without_unit"], 1);
    std::map<std::string, double> reasons;
    for (const json& each : left_out["reasons"]) reasons[each["column"]] = each["rows"];
    // Row 90003 counts by the first of its reasons; the short row lacks its temperature.
    EXPECT_EQ(reasons, (std::map<std::string, double>{{"unit", 1},
                                                      {"cycle", 1},
                                                      {"slip_speed", 1},
                                                      {"torque", 1},
                                                      {"temperature", 2},
                                                      {"closing_time", 1},
                                                      {"energy", 1}}));
    // As many cycles at the mean wear of each unit; without a unit, of the fleet.
    double volume = 0, all_volume = 0, all_cycles = 0;
    for (const json& unit : good["worst"]) {
      all_volume += unit["volume"].get<double>();
      all_cycles += unit["cycles"].get<double>();
      const std::map<std::string, double> rows = {{"unit 1", 3}, {"unit 2", 3}, {"unit 3", 1}};
      if (const auto at = rows.find(unit["unit"]); at != rows.end())
        volume += at->second * unit["volume"].get<double>() / unit["cycles"].get<double>();
    }
    volume += all_volume / all_cycles;
    EXPECT_NEAR(left_out["volume"].get<double>() / volume, 1, 1e-12);
    for (const json& check : fleet["checks"]) {
      if (check["name"] == "left-out") {
        EXPECT_EQ(check["verdict"], "warn");
      }
    }
  }
  EXPECT_EQ(with_exit_code(name + " " + path("good.csv") + output() + " --skip-bad",
                           0)["left_out"]["rows"],
            0);
}

TEST_F(FleetRows, BadOnesAreRefusedWithAHintAndSoIsATableOfNothingElse) {
  const auto cycles = fleet_cycles(300, 2, 32);
  const std::string name = model();
  auto changed = cycles;
  changed[50].torque = -1;
  refused(name + " " + file("a.csv", changed), "--skip-bad leaves such rows out");
  for (FleetCycle& each : changed) each.torque = -1;
  refused(name + " " + file("b.csv", changed) + " --skip-bad", "300 rows of 300 have a missing");
}

// DuckDB's detection speaks of quotes and names no line.
TEST_F(FleetRows, InvalidLinesAreNamed) {
  const std::string name = model();
  const std::string content = fleet_csv(fleet_cycles(30'000, 2, 34));
  const std::string last = content.substr(content.rfind('\n', content.size() - 2) + 1);
  write("long.csv", content + last.substr(0, last.size() - 1) + ",7\n");
  refused(name + " " + path("long.csv"), "long.csv, line 30002: ");
  write("behind.csv", content + "\"x\"" + last);
  refused(name + " " + path("behind.csv"), "behind.csv, line 30002: a cell goes on");
  refused(name + " " + path("behind.csv") + " --skip-bad",
          "behind.csv, line 30002: a cell goes on");
}

// What is left out of a unit outweighs what is known of it; a unit has nothing else.
TEST_F(FleetRows, LeftOutThatOutweighTheirUnitAreNotTrusted) {
  auto cycles = fleet_cycles(400, 2, 33);
  const std::string name = model();
  for (std::size_t i = 0; i < cycles.size(); ++i)
    if (cycles[i].unit == "unit 1" && i > 20) cycles[i].energy = -1;
  const json fleet =
      with_exit_code(name + " " + file("a.csv", cycles) + output() + " --skip-bad", 1);
  EXPECT_FALSE(fleet["trusted"].get<bool>());
  EXPECT_EQ(fleet["left_out"]["units"][0]["unit"], "unit 1");
  cycles.push_back({"only bad", 1, 100, -50, 150, 2, 9000});
  const CommandResult run =
      run_wearwell("fleet " + name + " " + file("b.csv", cycles) + output() + " --skip-bad");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.out, HasSubstr("1 units have no other row"));
}

// Rows without a unit may all be those of one unit.
TEST_F(FleetRows, LeftOutWithoutAUnitCanOutweighAnyUnit) {
  const auto cycles = fleet_cycles(400, 2, 34);
  const std::string name = model();
  std::string text = with_bad_rows(cycles);
  for (int i = 0; i < 300; ++i) text += ",91000,100,50,150,2,9000\n";
  write("nameless.csv", text);
  const json fleet =
      with_exit_code(name + " " + path("nameless.csv") + output() + " --skip-bad", 1);
  EXPECT_FALSE(fleet["trusted"].get<bool>());
  const json& units = fleet["left_out"]["units"];
  const auto nameless = std::find_if(units.begin(), units.end(),
                                     [](const json& each) { return each["unit"].is_null(); });
  ASSERT_NE(nameless, units.end());
  EXPECT_GT((*nameless)["volume"], (*nameless)["sd"]);
  EXPECT_EQ(fleet["left_out"]["without_unit"], 301);
}

// Rows left out on Monday do not look late on Tuesday; a row that was corrected does.
TEST_F(FleetRows, LeftOutDayByDayAreThoseOfAllAtOnce) {
  const auto cycles = fleet_cycles(2000, 3, 34);
  const std::string name = model(), state = " --state " + path("sums.duckdb") + " --skip-bad";
  auto bad = cycles;
  bad[100].torque = -1;
  bad[1500].energy = -1;
  file("monday.csv", {bad.begin(), bad.begin() + 1000});
  const std::string both = file("both.csv", bad);
  fleet_summary(name + " " + path("monday.csv") + output() + state);
  const json daily = fleet_summary(name + " " + both + output() + state);
  EXPECT_EQ(daily["worst"].dump(),
            fleet_summary(name + " " + both + output() + " --skip-bad")["worst"].dump());
  std::filesystem::remove_all(folder() / "results");
  refused(name + " " + file("corrected.csv", cycles) + state, "came late");
}

// Temperatures whose unit --columns states wrongly, and only these, are refused with both readings.
TEST_F(FleetRows, TemperaturesInTheOtherUnitAreRefused) {
  const auto cycles = fleet_cycles(400, 2, 36);
  const std::string name = model();
  const std::string text = boost::replace_all_copy(fleet_csv(cycles), "temperature [degC]", "T");
  write("plain.csv", text);
  const std::string plain = name + " " + path("plain.csv");
  refused(plain, "temperature=COLUMN:degC");
  for (const char* way : {"", " --statements"}) {
    const json right = fleet_summary(plain + " --columns temperature=T:degC" + output() + way);
    EXPECT_EQ(right["fleet"]["rows"], 400);
    std::filesystem::remove_all(folder() / "results");
    refused(plain + " --columns temperature=T:K" + way, "--columns 'temperature=T:degC'");
    refused(plain + " --columns temperature=T:K" + way, "calibrated range of 105 to 245 degC");
  }
  auto kelvin = cycles;
  for (FleetCycle& each : kelvin) each.temperature += 273.15;
  write("kelvin.csv", boost::replace_all_copy(fleet_csv(kelvin), "temperature [degC]", "T"));
  refused(name + " " + path("kelvin.csv") + " --columns temperature=T:degC",
          "--columns 'temperature=T:K'");
  // In the heading it is as it is written.
  write("cold.csv", boost::replace_all_copy(text, ",T,", ",temperature [K],"));
  const CommandResult cold = run_wearwell("fleet " + name + " " + path("cold.csv") + output());
  EXPECT_THAT(cold.err, Not(HasSubstr("calibrated range")));
}

TEST_F(FleetRows, OfOtherCountriesAreTheSame) {
  const auto cycles = fleet_cycles(1500, 3, 35);
  const std::string name = model();
  const std::string points = fleet_csv(cycles);
  write("points.csv", points);
  const json expected = fleet_summary(name + " " + path("points.csv") + output());
  EXPECT_FALSE(expected["fleet"].contains("layout"));
  std::string text = boost::replace_all_copy(points, ",", ";");
  write("semicolons.csv", text);
  boost::replace_all(text, ".", ",");
  write("commas.csv", text);
  for (const char* each : {"semicolons.csv", "commas.csv"}) {
    const json fleet = fleet_summary(name + " " + path(each) + output());
    EXPECT_EQ(fleet["worst"].dump(), expected["worst"].dump()) << each;
    EXPECT_THAT(fleet["fleet"]["layout"].get<std::string>(), HasSubstr("semicolons"));
  }
  // Two layouts at once; and commas where rows are skipped, without thousands points.
  std::vector<FleetCycle> first(cycles.begin(), cycles.begin() + 700),
      second(cycles.begin() + 700, cycles.end());
  file("first.csv", first);
  std::string rest = boost::replace_all_copy(fleet_csv(second), ",", ";");
  write("second.csv", boost::replace_all_copy(rest, ".", ","));
  EXPECT_EQ(
      fleet_summary(name + " " + path("first.csv") + " " + path("second.csv") + output())["worst"]
          .dump(),
      expected["worst"].dump());
  write("thousands.csv", text + "unit 1;9000;100;1.234;150;2,5;9000\n");
  const CommandResult thousands =
      run_wearwell("fleet " + name + " " + path("thousands.csv") + output() + " --skip-bad");
  EXPECT_EQ(thousands.exit_code, 2);
  EXPECT_THAT(thousands.err, HasSubstr("thousands point"));
  // A line with too few cells is a bad row in these files, too.
  for (const auto& [file_name, whole, row] :
       {std::tuple("short-points.csv", boost::replace_all_copy(points, ",", ";"),
                   "unit 1;9000;100;2.5\n"),
        {"short-commas.csv", text, "unit 1;9000;100;2,5\n"}}) {
    write(file_name, whole + row);
    const json fleet = fleet_summary(name + " " + path(file_name) + output() + " --skip-bad");
    EXPECT_EQ(fleet["worst"].dump(), expected["worst"].dump()) << file_name;
    EXPECT_EQ(fleet["left_out"]["rows"], 1) << file_name;
  }
  write("mixed.csv",
        boost::replace_all_copy(points, ",", ";") + "unit 1;9000;100;2,5;150;2;9\nunit 1;9\n");
  EXPECT_EQ(
      run_wearwell("fleet " + name + " " + path("mixed.csv") + output() + " --skip-bad").exit_code,
      2);
  write("skipped.csv", text + "unit 1;9000;100;broken;150;2,5;9000\n");
  const json skipped = fleet_summary(name + " " + path("skipped.csv") + output() + " --skip-bad");
  EXPECT_EQ(skipped["worst"].dump(), expected["worst"].dump());
  EXPECT_EQ(skipped["left_out"]["rows"], 1);
}

TEST_F(FleetRows, WithoutTheirColumnsNameTheOptions) {
  const std::string name = model();
  write("a.csv", "vin,cycle,n,torque [N m],m,t,e\na,1,1,1,1,1,1\n");
  const CommandResult run = run_wearwell("fleet " + name + " " + path("a.csv") + output());
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, AllOf(HasSubstr("--columns unit=COLUMN slip_speed=COLUMN:rad/s"),
                             HasSubstr("energy=COLUMN:J"), HasSubstr("'vin', 'cycle', 'n'"),
                             Not(HasSubstr("torque=COLUMN")), Not(HasSubstr("rename"))));
  write("b.csv",
        "plate,cycle,slip_speed,torque [N m],temperature [degC],closing_time [s],energy [J]\n"
        "a,1,1,1,1,1,1\n");
  refused(name + " " + path("b.csv"), "write --columns 'slip_speed=slip_speed:rad/s'");
}

TEST_F(FleetRows, OfObjectStoresAreRefusedInPlainWords) {
  const std::string name = model();
  for (const char* store : {"s3", "gs", "https"})
    refused(name + " '" + store + "://bucket/cycles/*.parquet'",
            std::string("there is no access to '") + store + "://'");
  refused(name + " --read-only " + path("a.csv"), "--read-only is for databases");
}

}  // namespace
}  // namespace wearwell::clutch
