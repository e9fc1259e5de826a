// `wearwell fleet` over files: the numbers of `wearwell clutch predict`, whatever the order of rows.
#include <duckdb.h>
#include <gmock/gmock.h>

#include "fleet/sample_fleet.h"
#include "support/scratch.h"
#include "wearwell/fleet/duckdb_engine.h"
#include "wearwell/models/clutch/fleet_run.h"

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
  /// The first value of the answer of the database of --state.
  std::string kept(const std::string& statement) const {
    duckdb_database database = nullptr;
    duckdb_connection connection = nullptr;
    duckdb_result result;
    EXPECT_EQ(duckdb_open((folder() / "sums.duckdb").c_str(), &database), DuckDBSuccess);
    EXPECT_EQ(duckdb_connect(database, &connection), DuckDBSuccess);
    EXPECT_EQ(duckdb_query(connection, statement.c_str(), &result), DuckDBSuccess)
        << duckdb_result_error(&result);
    char* const text =
        duckdb_row_count(&result) > 0 ? duckdb_value_varchar(&result, 0, 0) : nullptr;
    const std::string value = text ? text : "";
    duckdb_free(text);
    duckdb_destroy_result(&result);
    duckdb_disconnect(&connection);
    duckdb_close(&database);
    return value;
  }
  long rows_kept() const { return std::stol(kept("select count(*) from wearwell_sums")); }
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
    for (const char* way : {"", " --statements"}) {
      const json fleet = fleet_summary(name + " " + table + output() + way);
      EXPECT_LT(difference(fleet, predicted), 1e-12) << name_of(kind) << way;
      double negative = 0;
      for (const auto& each : fleet["worst"]) negative += each["negative"].get<double>();
      EXPECT_GT(negative, 100);
    }
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

// Each unit is one row, however many runs there were; the statements do the same, and go on from it.
TEST_F(DuckdbFleet, SavedSumsAreOneRowAUnit) {
  const auto cycles = fleet_cycles(3000, 4, 15);
  const std::string name = model(), state = " --state " + path("sums.duckdb");
  for (const char* way : {"", " --statements"}) {
    std::filesystem::remove(folder() / "sums.duckdb");
    const json whole = fleet_summary(name + " " + file("all.csv", cycles) + output() + way);
    json last;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto from = cycles.begin() + static_cast<long>(1000 * i);
      last =
          fleet_summary(name + " " + file("day.csv", {from, from + 1000}) + output() + state + way);
    }
    EXPECT_EQ(whole["worst"].dump(), last["worst"].dump()) << way;
    EXPECT_EQ(rows_kept(), 4) << way;
  }
  // From one to the other.
  const std::string more = file("more.csv", fleet_cycles(3200, 4, 15));
  const json mixed = fleet_summary(name + " " + more + output() + state);
  const json plain = fleet_summary(name + " " + more + output());
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(
        mixed["worst"][i]["sd_full"].get<double>() / plain["worst"][i]["sd_full"].get<double>(), 1,
        1e-12);
}

TEST_F(DuckdbFleet, SumsOfAnotherModelOrOptionAreRefused) {
  const std::string name = model();
  std::string table = file("a.csv", fleet_cycles(500, 2, 16));
  const std::string state = output() + " --state " + path("sums.duckdb");
  fleet_summary(name + " " + table + state);
  table = file("b.csv", fleet_cycles(600, 2, 16));
  const auto refused = [&](const std::string& arguments, const std::string& part) {
    const CommandResult run = run_wearwell("fleet " + arguments + " " + table + state);
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_THAT(run.err, HasSubstr(part));
    EXPECT_EQ(rows_kept(), 2);
  };
  for (const std::string way : {"", " --statements"}) {
    refused(name + way + " --scatter-only", "made without --scatter-only");
    WearModel other = fleet_model(ScatterKind::linear);
    other.worn_out *= 2;
    write("other.json", to_json(other).dump(1));
    refused(path("other.json") + way, "the sums of another model");
  }
  std::filesystem::remove(folder() / "sums.duckdb");
  fleet_summary(name + " " + table + state + " --scatter-only");
  refused(name, "made with --scatter-only");
}

// A file of a version that kept a row for each run, and whose key was another; and one with fewer replicates.
TEST_F(DuckdbFleet, SumsOfAnotherVersionAreRefused) {
  const std::string name = model(), state = output() + " --state " + path("sums.duckdb");
  fleet_summary(name + " " + file("a.csv", fleet_cycles(500, 2, 19)) + state);
  const std::string table = file("b.csv", fleet_cycles(600, 2, 19));
  const std::string before = kept("select sum(hash(s)) from wearwell_sums as s");
  const auto refused = [&](const std::string& part) {
    std::filesystem::remove_all(folder() / "results");
    for (const std::string way : {"", " --statements"}) {
      const CommandResult run = run_wearwell("fleet " + name + " " + table + state + way);
      EXPECT_EQ(run.exit_code, 2);
      EXPECT_THAT(run.err, AllOf(HasSubstr(part), HasSubstr("into another file (--state)")));
      EXPECT_FALSE(std::filesystem::exists(folder() / "results"));
    }
  };
  std::string made = kept("select sql from duckdb_tables() where table_name = 'wearwell_sums'");
  const std::string key = "PRIMARY KEY(model, unit", other = key + ", after_cycle";
  ASSERT_NE(made.find(key), std::string::npos) << made;
  made.replace(made.find(key), key.size(), other);
  kept("create temp table old as select * from wearwell_sums; drop table wearwell_sums; " + made +
       "insert into wearwell_sums select * from old");
  refused("another version of wearwell");
  EXPECT_EQ(before, kept("select sum(hash(s)) from wearwell_sums as s"));
  kept("alter table wearwell_sums drop column v5; alter table wearwell_sums drop column s5");
  refused("of a model of 4 replicates, and this one has 5");
}

// Sums of more units than may be held are given to the engine on the way.
TEST_F(DuckdbFleet, UnitsBeyondMemoryAreTheSame) {
  model();
  const IdentifiedModel read = read_identified_model(folder() / "model.json");
  const int units = 600;
  std::vector<FleetCycle> cycles = fleet_cycles(30 * units, 1, 17);
  for (std::size_t i = 0; i < cycles.size(); ++i) {
    cycles[i].unit = fmt::format("{}", i % units);
    cycles[i].number = static_cast<long long>(1 + i / units);
  }
  file("all.csv", cycles);
  const auto body = [&](std::size_t units_in_memory) {
    const auto engine = fleet::duckdb_engine(
        {.files = {(folder() / "all.csv").string()}, .unit = "plate", .spill = folder()});
    return find_fleet(read, {engine.get()},
                      {.first = true,
                       .units_in_memory = units_in_memory,
                       .levels = {50},
                       .horizons = {0, 100}},
                      {})
        .body.dump();
  };
  const std::string all = body(0);
  EXPECT_EQ(all, body(100));
  EXPECT_EQ(all, body(1));
}

// Units in CSV are words, whatever they look like; whole numbers of a table are the same unit whatever their type.
TEST_F(DuckdbFleet, UnitsAreWhatTheyLookLike) {
  auto cycles = fleet_cycles(300, 3, 18);
  for (FleetCycle& each : cycles) each.unit = fmt::format("00{}", each.unit.back());
  const json fleet = fleet_summary(model() + " " + file("a.csv", cycles) + output());
  ASSERT_EQ(fleet["worst"].size(), 3u);
  for (const auto& each : fleet["worst"])
    EXPECT_THAT(each["unit"].get<std::string>(), testing::StartsWith("00"));
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
  refused(changed,
          fmt::format("1 rows of 200 have a missing or impossible value (unit {}, cycle {}: "
                      "torque is -1, in SI and degC)",
                      changed[50].unit, changed[50].number));
  changed = cycles;
  changed[50].temperature = -300;
  refused(changed, "impossible value");
  changed = cycles;
  changed[50].energy = NAN;
  refused(changed, "impossible value");
  changed = cycles;
  changed[51].unit = changed[50].unit;
  changed[51].number = changed[50].number;
  refused(changed, "a repeated number");
  changed = cycles;
  changed[50].unit = "";
  refused(changed, "1 rows have no unit");
  refused({}, "bad.csv has no rows");
  // Beyond what the sums hold.
  changed = cycles;
  changed[50].temperature = 1e12;
  refused(changed, "exceeds the range of the sums");
}

// One cycle of 1.6e9 J among 500 of some ten thousand, which the sum of its unit shows; and one of 5 MJ, which it does not.
TEST_F(DuckdbFleet, AnEnergyThatNoClosingHasIsNotTrusted) {
  for (const auto& [factor, by_sum] : {std::pair(1e5, true), {300.0, false}}) {
    auto cycles = fleet_cycles(2000, 4, 7);
    cycles[50].energy *= factor;
    for (const char* how : {"", " --statements"}) {
      const CommandResult run = run_wearwell("fleet " + model() + " " + file("kilo.csv", cycles) +
                                             output() + " --json" + how);
      EXPECT_EQ(run.exit_code, 1) << run.err;
      const json summary = json::parse(run.out);
      EXPECT_EQ(summary["trusted"], false);
      int named = 0;
      for (const auto& check : summary["checks"]) {
        const std::string detail = check["detail"];
        if (check["name"] == "energy") {
          EXPECT_EQ(check["verdict"] == "fail", by_sum) << how;
          if (by_sum) {
            EXPECT_THAT(detail, AllOf(HasSubstr("of 1 of 4 units"), HasSubstr(cycles[50].unit)));
          }
          continue;
        }
        EXPECT_EQ(check["verdict"] == "fail", check["name"] == "energy-of-cycles") << how;
        if (check["name"] != "energy-of-cycles") continue;
        ++named;
        EXPECT_THAT(detail, AllOf(HasSubstr("1 of 2000 cycles read now has more than 10 times"),
                                  HasSubstr(fmt::format("the largest is cycle {} of unit {},",
                                                        cycles[50].number, cycles[50].unit))))
            << how;
      }
      EXPECT_EQ(named, 1) << how;
    }
  }
}

TEST_F(DuckdbFleet, TwoColumnsOfOneNameAreRefused) {
  const std::string name = model();
  const auto refused = [&](const std::string& heading, const std::string& words) {
    write("twice.csv",
          "plate,cycle,slip_speed [rad/s],torque [N m],temperature [degC],closing_time [s],energy "
          "[J]," +
              heading + "\n1,1,200,40,150,2,8000,8\n1,2,200,40,150,2,8000,8\n");
    const CommandResult run = run_wearwell("fleet " + name + " " + path("twice.csv") + output());
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_THAT(run.err, HasSubstr(words));
    EXPECT_FALSE(std::filesystem::exists(folder() / "results"));
  };
  refused("energy [J]", "has two columns named 'energy [J]': columns 7 and 8");
  refused("Energy [J]",
          "'energy [J]' (column 7) and 'Energy [J]' (column 8), whose names differ only");
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
