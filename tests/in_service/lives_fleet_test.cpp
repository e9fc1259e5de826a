// wearwell fleet with a fit of lives: the numbers of wearwell decide and wearwell life, conditions of units, and refusals.
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "support/run_command.h"
#include "support/scratch.h"
#include "support/servers.h"

namespace wearwell {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::string examples = PROJECT_SOURCE_DIR "/examples";

// Fits of examples, once for all tests.
class LivesFleet : public ScratchTest {
 protected:
  static void SetUpTestSuite() {
    char pattern[] = "/tmp/wearwell-test-XXXXXX";
    fits_ = mkdtemp(pattern);
    for (const char* name : {"life", "accelerated"})
      ASSERT_EQ(run_wearwell("fit " + examples + "/" + name + "/study.toml -o " + fits_ + "/" +
                             name + " --quiet")
                    .exit_code,
                0);
  }
  static void TearDownTestSuite() { std::filesystem::remove_all(fits_); }

  static std::string fit(const std::string& name) { return fits_ + "/" + name; }
  std::string file(const std::string& name, const std::string& content) const {
    return write(name, content).string();
  }
  std::string output() const { return " -o " + (folder() / "fleet").string(); }
  json fleet(const std::string& arguments) const {
    const CommandResult run = run_wearwell("fleet " + arguments + output() + " --json");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return run.exit_code == 0 ? json::parse(run.out) : json();
  }
  void refused(const std::string& arguments, const std::string& part) const {
    const CommandResult run = run_wearwell("fleet " + arguments + output());
    EXPECT_EQ(run.exit_code, 2) << arguments;
    EXPECT_THAT(run.err, HasSubstr(part)) << arguments;
    EXPECT_FALSE(std::filesystem::exists(folder() / "fleet")) << arguments;
  }

  inline static std::string fits_;
};

std::string ages(const std::string& heading, const std::string& end) {
  std::string csv = heading + "\n";
  for (int i = 0; i < 30; ++i) csv += fmt::format("P{},{}{}\n", i, 3 * i, end);
  return csv;
}

TEST_F(LivesFleet, HasTheNumbersOfDecide) {
  for (const std::string in_study : {"yes", "no"}) {
    const std::string table =
        file("ages.csv", ages("unit,age [1e6 cycles],in_study", "," + in_study));
    const json mine = fleet(fit("life") + " " + table + " --horizon '5e6 cycles,10e6 cycles'");
    const CommandResult run = run_wearwell("decide " + fit("life") +
                                           " --failure-cost 5 --replacement-cost 1 --month "
                                           "'5e6 cycles' --months 2 --json --in-service " +
                                           table);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const json other = json::parse(run.out);
    // Unless the survival of all is more than the points resolve: then decide takes units as
    // independent.
    if (mine["fleet"]["populations"]["resolved"].get<bool>()) {
      for (int m = 0; m < 2; ++m) {
        const json& month = other["months"][m];
        EXPECT_NEAR(mine["failures"][m]["expected"].get<double>() / month["expected"].get<double>(),
                    1, 0.01);
        EXPECT_NEAR(mine["failures"][m]["low"].get<double>(), month["q05"].get<double>(), 1);
        EXPECT_NEAR(mine["failures"][m]["high"].get<double>(), month["q95"].get<double>(), 1);
      }
    }
    for (const json& unit : other["units"]) {
      for (const json& each : mine["worst"]) {
        if (each["unit"] != unit["unit"]) continue;
        EXPECT_NEAR(each["median"].get<double>() / unit["q50"].get<double>(), 1, 0.02);
      }
    }
  }
}

// Its own survival alone is evidence, as for wearwell life --survived, which uses all points.
TEST_F(LivesFleet, HasTheNumbersOfLifeForOneUnit) {
  for (const double age : {0.0, 20.0, 70.0}) {
    const json mine = fleet(fit("life") + " " +
                            file("one.csv", fmt::format("unit,age [1e6 cycles]\nA,{}\n", age)) +
                            " --horizon '10e6 cycles'");
    const CommandResult run =
        run_wearwell("life " + fit("life") + fmt::format(" --survived '{}e6 cycles'", age) +
                     " --horizon '10e6 cycles' --json");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const json life = json::parse(run.out);
    const json& unit = mine["worst"][0];
    EXPECT_NEAR(unit["b10"].get<double>() / life["b10"].get<double>(), 1, 0.02) << age;
    EXPECT_NEAR(unit["median"].get<double>() / life["b50"].get<double>(), 1, 0.01) << age;
    EXPECT_NEAR(unit["failing"][0].get<double>() / life["horizon"]["reached"].get<double>(), 1,
                0.02)
        << age;
  }
}

// Each unit under its own conditions; those of the study where the table has none.
TEST_F(LivesFleet, UnitsHaveTheirOwnConditions) {
  const std::string horizon = " --horizon '20000 h'";
  const json plain = fleet(fit("accelerated") + " " +
                           file("plain.csv", "unit,age [h]\nA,500\nB,9000\n") + horizon);
  const json ten =
      fleet(fit("accelerated") + " " +
            file("ten.csv", "unit,age [h],temperature [degC]\nA,500,10\nB,9000,10\n") + horizon);
  EXPECT_EQ(plain["failures"].dump(), ten["failures"].dump());
  const std::string mixed =
      file("mixed.parquet.csv", "serial,t,run\nA,283.15,500\nB,353.15,9000\n");
  const json two = fleet(fit("accelerated") + " " + mixed +
                         " --columns unit=serial age=run:h temperature=t:K" + horizon);
  EXPECT_EQ(two["worst"][0]["unit"], "B");
  const auto of = [](const json& result, const char* name) {
    for (const json& each : result["worst"])
      if (each["unit"] == name) return each["failing"][0].get<double>();
    return std::nan("");
  };
  EXPECT_NEAR(of(two, "A"), of(ten, "A"), 1e-9);
  EXPECT_GT(of(two, "B"), 5 * of(ten, "B"));
  // 90 degC lies outside the tests, from 10 to 80.
  const json hot = fleet(fit("accelerated") + " " +
                         file("hot.csv", "unit,age [h],temperature [degC]\nA,500,90\n") + horizon);
  EXPECT_THAT(hot["checks"].dump(),
              HasSubstr("1 unit has a temperature outside the study's 10 to 80"));
  EXPECT_EQ(two["fleet"]["conditions"], 2);
}

TEST_F(LivesFleet, BadRowsAreRefusedOrReported) {
  const std::string good = "unit,age [1e6 cycles]\nA,10\nB,20\n";
  const std::string bad = file("bad.csv", good + "C,-3\n,5\nD,\n");
  refused(fit("life") + " " + bad, "age is negative");
  // A decimal comma between commas: 1.5, not 1.
  refused(fit("life") + " " + file("long.csv", good + "C,1,5\n") + " --skip-bad",
          "a line has 3 values, but the heading has 2");
  const CommandResult run =
      run_wearwell("fleet " + fit("life") + " " + bad + " --skip-bad --json" + output());
  EXPECT_EQ(run.exit_code, 1);  // 60 % of the rows
  const json summary = json::parse(run.out);
  EXPECT_EQ(summary["fleet"]["units"], 2);
  EXPECT_EQ(summary["left_out"]["rows"], 3);
}

TEST_F(LivesFleet, NamesWhatIsWrong) {
  const std::string life = fit("life") + " ";
  const auto table = [&](const std::string& content) { return file("a.csv", content); };
  refused(life + table("unit,age\nA,5\n"), "age");
  refused(life + table("unit,age [mm]\nA,5\n"), "mm");
  refused(life + table("name,age [1e6 cycles]\nA,5\n"), "--columns unit=COLUMN");
  refused(life + table("unit,hours\nA,5\n"), "age=COLUMN:");
  refused(life + table("unit,age [1e6 cycles]\nA,5\nA,6\n"), "unit A has more than one row");
  refused(life + table("unit,age [1e6 cycles]\nA,5000\n"), "no unit survives to age 5000");
  refused(life + table("unit,age [1e6 cycles]\nA,five\n"), "does not hold numbers");
  refused(life + table("unit,age [1e6 cycles],in_study\nA,5,perhaps\n"), "neither yes nor no");
  refused(life + table("unit,age [1e6 cycles]\nA,5\n") + " --columns speed=v:m/s",
          "'speed' is unknown");
  refused(life + table("unit,age [1e6 cycles]\nA,5\n") + " --horizon '5 mm'", "--horizon");
  refused(life + table("unit,age [1e6 cycles]\nA,5\n") + " --horizon 5", "--horizon");
  for (const char* option : {"--level 50", "--days 30", "--scatter-only", "--prefix x",
                             "--statements", "--state s.duckdb"})
    refused(life + table("unit,age [1e6 cycles]\nA,5\n") + " " + option, "is for clutches");
  refused(fit("accelerated") + " " + table("unit,age [h],temperature\nA,5,40\n"), "temperature");
  refused(life + table("unit,age [1e6 cycles]\nA,5\n") + " --at nothing", "--at");
}

TEST_F(LivesFleet, AViewOfPostgresHasTheNumbersOfFiles) {
  const std::string missing = PostgresServer::missing();
  if (!missing.empty()) GTEST_SKIP() << "NOT TESTED with PostgreSQL: " << missing;
  const PostgresServer server(folder() / "postgres");
  const CommandResult made = server.sql(
      "create table pumps (serial bigint, run numeric, known boolean, t real);\n"
      "insert into pumps values (1, 500, true, 20), (2, 9000.5, false, 60), (3, 100, false, 60);\n"
      "create view plant as select * from pumps;\n");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const std::string columns =
      " --columns unit=serial age=run:h in_study=known temperature=t:degC --horizon '20000 h'";
  const json database = fleet(fit("accelerated") + " --engine " + server.url() +
                              " --table plant --read-only" + columns);
  const json files = fleet(fit("accelerated") + " " +
                           file("pumps.csv",
                                "serial;run;known;t\n1;500;yes;20\n2;9000,5;no;60\n"
                                "3;100;no;60\n") +
                           columns);
  EXPECT_EQ(database["failures"].dump(), files["failures"].dump());
  EXPECT_EQ(database["worst"].dump(), files["worst"].dump());
}

}  // namespace
}  // namespace wearwell
