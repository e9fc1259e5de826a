// `wearwell fleet` and `wearwell clutch sql` with servers of PostgreSQL, alone and three together.
#include <gmock/gmock.h>

#include "fleet/clickhouse_server.h"
#include "fleet/sample_fleet.h"
#include "fleet/sample_kinds.h"
#include "fleet/sample_law.h"
#include "support/scratch.h"
#include "support/servers.h"
#include "wearwell/fleet/postgres_engine.h"

namespace wearwell::clutch {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

const std::string columns =
    " --columns unit=vin cycle=cycle slip_speed=n:rad/s 'torque=m:N m' temperature=temp:degC "
    "closing_time=t:s energy=e:J";
const std::string create =
    "create table cycles (vin text not null, cycle bigint not null, n float8, m float8, temp "
    "float8, t "
    "float8, e float8)";

class Cluster : public ScratchTest {
 protected:
  void SetUp() override {
    const std::string missing = PostgresServer::missing();
    if (!missing.empty()) GTEST_SKIP() << "NOT TESTED with PostgreSQL: " << missing;
    write("model.json", to_json(fleet_model(ScatterKind::exponential)).dump(1));
    write("cycles.csv", fleet_csv(cycles_));
    model_ = "'" + (folder() / "model.json").string() + "'";
  }

  std::string table_file() const { return "'" + (folder() / "cycles.csv").string() + "'"; }
  std::string output() const { return " -o '" + (folder() / "results").string() + "'"; }
  static void load(const PostgresServer& server, const std::vector<FleetCycle>& cycles,
                   const std::string& table = "cycles") {
    std::string statements = "begin;\n";
    for (const FleetCycle& c : cycles)
      statements +=
          fmt::format("insert into {} values ('{}', {}, {}, {}, {}, {}, {});\n", table, c.unit,
                      c.number, c.slip_speed, c.torque, c.temperature, c.closing_time, c.energy);
    const CommandResult done = server.sql(statements + "commit;\n");
    ASSERT_EQ(done.exit_code, 0) << done.err;
  }
  json predicted() const {
    return json::parse(
        run_wearwell("clutch predict " + model_ + " " + table_file() + " --json").out);
  }

  std::vector<FleetCycle> cycles_ = fleet_cycles(2500, 6, 11);
  std::string model_;
};

TEST_F(Cluster, PostgresHasTheNumbersOfPredictAndOfDuckdb) {
  const PostgresServer server(folder() / "postgres");
  ASSERT_EQ(server.sql(create).exit_code, 0);
  load(server, shuffled({cycles_.begin(), cycles_.begin() + 1500}, 3));
  const std::string engine = " --engine " + server.url() + " --table cycles" + output() + columns;
  fleet_summary(model_ + engine);
  load(server, shuffled({cycles_.begin() + 1500, cycles_.end()}, 4));
  const json fleet = fleet_summary(model_ + engine);
  EXPECT_LT(difference(fleet, predicted()), 1e-9);
  // Nothing new: not a bit changes.
  EXPECT_EQ(fleet["worst"].dump(), fleet_summary(model_ + engine)["worst"].dump());
  ASSERT_EQ(server
                .sql("create view dated as select *, timestamp '2026-01-01' + cycle * interval '1 "
                     "hour' as moment from cycles")
                .exit_code,
            0);
  expect_hours(fleet_summary(model_ + " --engine " + server.url() + " --table dated" + output() +
                             columns + " time=moment --horizon 0 --days 30"),
               cycles_);
  const json duckdb = fleet_summary(model_ + " " + table_file() + output());
  for (std::size_t i = 0; i < fleet["levels"].size(); ++i)
    EXPECT_NEAR(fleet["levels"][i]["units"].get<double>(),
                duckdb["levels"][i]["units"].get<double>(), 1e-8);
}

// A user with the right to SELECT and nothing else: the same numbers as with stored sums, and nothing new in the database. The same
// where a transaction of a standby would be: read only.
TEST_F(Cluster, PostgresNeedsTheRightToReadAlone) {
  const PostgresServer server(folder() / "postgres");
  ASSERT_EQ(server.sql(create).exit_code, 0);
  load(server, shuffled(cycles_, 3));
  ASSERT_EQ(
      server
          .sql("revoke all on schema public from public; revoke all on database postgres from "
               "public; create role reader login; grant connect on database postgres to "
               "reader; grant usage on schema public to reader; create view shown as select * "
               "from cycles; grant select on shown to reader")
          .exit_code,
      0);
  const std::string reader =
      "postgresql://reader@127.0.0.1:" + std::to_string(server.port()) + "/postgres";
  const std::string arguments =
      model_ + " --engine " + reader + " --table shown" + output() + columns;
  const CommandResult refused = run_wearwell("fleet " + arguments);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("permission denied"), HasSubstr("--read-only")));
  const std::string tables = "select count(*) from pg_class where relname like 'wearwell%'";
  const json read = fleet_summary(arguments + " --read-only --horizon 0,1000");
  EXPECT_EQ(server.sql(tables).out, "0\n");
  EXPECT_LT(difference(read, predicted()), 1e-9);
  const json stored = fleet_summary(model_ + " --engine " + server.url() + " --table cycles" +
                                    output() + columns + " --horizon 0,1000");
  EXPECT_EQ(read["worst"].dump(), stored["worst"].dump());
  EXPECT_EQ(read["levels"].dump(), stored["levels"].dump());
  // By itself it chooses horizons from the same number of cycles.
  EXPECT_EQ(fleet_summary(arguments + " --read-only")["levels"].dump(),
            fleet_summary(model_ + " --engine " + server.url() + " --table cycles" + output() +
                          columns)["levels"]
                .dump());
}

// Rows left out in a server: as in files, they do not look late, and no check counts them.
TEST_F(Cluster, PostgresLeavesBadRowsOut) {
  const PostgresServer server(folder() / "postgres");
  ASSERT_EQ(server
                .sql(create + ";alter table cycles alter column vin drop not null, alter column "
                              "cycle drop not null")
                .exit_code,
            0);
  load(server, cycles_);
  const std::string arguments =
      model_ + " --engine " + server.url() + " --table cycles" + output() + columns;
  const json good = fleet_summary(arguments + " --read-only");
  ASSERT_EQ(
      server
          .sql("insert into cycles values ('unit 1', 3, 100, -1, 100, 2, 10), ('unit 2', "
               "null, 100, 10, 100, 2, 1e9), (null, 4, 100, 10, 100, 2, 1e9), ('unit 1', 90001, "
               "100, 10, 100, 2, 'NaN')")
          .exit_code,
      0);
  EXPECT_EQ(run_wearwell("fleet " + arguments).exit_code, 2);
  for (const char* way : {" --read-only", "", ""}) {
    const json fleet = fleet_summary(arguments + " --skip-bad" + way);
    EXPECT_EQ(fleet["worst"].dump(), good["worst"].dump()) << way;
    EXPECT_EQ(fleet["left_out"]["rows"], 4);
    EXPECT_EQ(fleet["left_out"]["without_unit"], 1);
    EXPECT_EQ(fleet["left_out"]["reasons"].size(), 4u);
    // Two of them have an energy that no closing has, which is nothing against the rows that count.
    for (const json& check : fleet["checks"]) EXPECT_NE(check["verdict"], "fail") << check.dump();
  }
}

// The three statements as a user runs them, by any client.
TEST_F(Cluster, PrintedStatementsRunInPsql) {
  const PostgresServer server(folder() / "postgres");
  ASSERT_EQ(server.sql(create).exit_code, 0);
  load(server, cycles_);
  const std::string options = "sql " + model_ + " --dialect postgresql --table cycles" + columns;
  const auto part = [&](const std::string& name) {
    const CommandResult printed = run_wearwell(options + " --part " + name);
    EXPECT_EQ(printed.exit_code, 0) << printed.err;
    const CommandResult done = server.sql(printed.out);
    EXPECT_EQ(done.exit_code, 0) << name << ": " << done.err;
    return done.out;
  };
  for (int i = 0; i < 2; ++i) {
    part("setup");
    part("query");
  }
  const json expected = predicted();
  std::istringstream lines(part("combine"));
  std::size_t found = 0;
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> cells;
    std::istringstream text(line);
    for (std::string cell; std::getline(text, cell, '|');) cells.push_back(cell);
    for (const auto& p : expected["plates"]) {
      if (p["plate"] != cells.at(0)) continue;
      ++found;
      EXPECT_NEAR(std::stod(cells.at(4)) / p["volume"].get<double>(), 1, 1e-9);
      EXPECT_NEAR(std::stod(cells.at(5)) / p["sd_scatter"].get<double>(), 1, 1e-9);
      EXPECT_NEAR(std::stod(cells.at(8)) / p["sd_full"].get<double>(), 1, 1e-9);
    }
  }
  EXPECT_EQ(found, expected["plates"].size());
}

// Also where only another model has sums there; and those of a version that kept a row for each run.
TEST_F(Cluster, SumsOfAnotherOptionOrVersionAreRefusedInPostgres) {
  const PostgresServer server(folder() / "postgres");
  ASSERT_EQ(server.sql(create).exit_code, 0);
  load(server, cycles_);
  const std::string engine = " --engine " + server.url() + " --table cycles" + output() + columns;
  fleet_summary(model_ + engine);
  fleet_summary(model_ + engine + " --scatter-only --prefix plain");
  std::filesystem::remove_all(folder() / "results");
  WearModel other = fleet_model(ScatterKind::linear);
  write("other.json", to_json(other).dump(1));
  const std::string second = "'" + (folder() / "other.json").string() + "'";
  const std::string all = "select md5(string_agg(s::text, ';' order by unit)) from wearwell_sums s";
  const std::string before = server.sql(all).out;
  const auto refused = [&](const std::string& arguments, const std::string& part) {
    const CommandResult run = run_wearwell("fleet " + arguments);
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_THAT(run.err, AllOf(HasSubstr(part), HasSubstr("under another --prefix")));
    EXPECT_FALSE(std::filesystem::exists(folder() / "results"));
    EXPECT_EQ(before, server.sql(all).out);
  };
  for (const std::string& name : {model_, second}) {
    refused(name + engine + " --scatter-only", "made without --scatter-only");
    refused(name + engine + " --prefix plain", "made with --scatter-only");
  }
  EXPECT_EQ(server.sql("select count(distinct model) from plain_model").out, "1\n");
  ASSERT_EQ(server
                .sql("alter table wearwell_sums drop constraint wearwell_sums_pkey; alter table "
                     "wearwell_sums add primary key (model, unit, after_cycle)")
                .exit_code,
            0);
  refused(model_ + engine, "another version of wearwell");
}

// Two fleets under one prefix: each has its own units. The same table in other units is refused, since it may hold only what is new.
TEST_F(Cluster, SumsBelongToTheirTable) {
  const PostgresServer server(folder() / "postgres");
  ASSERT_EQ(server.sql(create).exit_code, 0);
  load(server, cycles_);
  const std::string engine = model_ + " --engine " + server.url() + output();
  const json first = fleet_summary(engine + " --table cycles" + columns);
  ASSERT_EQ(
      server
          .sql("create table other as select 'second ' || vin as vin, cycle, n, m, temp, t, e "
               "from cycles where vin in ('unit 1', 'unit 2')")
          .exit_code,
      0);
  const json second = fleet_summary(engine + " --table other" + columns);
  EXPECT_THAT(second["title"].get<std::string>(), HasSubstr("A fleet of 2 units"));
  double cycles = 0;
  for (const auto& each : second["worst"]) {
    EXPECT_THAT(each["unit"].get<std::string>(), testing::StartsWith("second unit "));
    cycles += each["cycles"].get<double>();
  }
  EXPECT_EQ(second["data"]["rows"].get<double>(), cycles);
  EXPECT_EQ(first["worst"].dump(),
            fleet_summary(engine + " --table cycles" + columns)["worst"].dump());
  std::string kilojoule = columns;
  kilojoule.replace(kilojoule.find("e:J"), 3, "e:kJ");
  const CommandResult refused = run_wearwell("fleet " + engine + " --table cycles" + kilojoule);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("has sums of this table by other columns or units"));
}

TEST_F(Cluster, ALawInPostgresHasTheNumbersOfTheLibrary) {
  const PostgresServer server(folder() / "postgres");
  const CommandResult made = server.sql(
      "create table liners (id integer, machine text, \"F\" float8, s float8);\ninsert "
      "into liners values" +
      formula_model::formula_row_values("''") + ";\n");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const auto engine = fleet::postgres_engine(server.url(), "liners");
  formula_model::expect_library(formula_model::formula_state(folder()), *engine, "liners",
                                formula_model::formula_values());
  const CommandResult pads = server.sql(
      "create table pads (id integer, machine text, mat text, \"T\" float8, \"TF\" float8, hours "
      "float8);\ninsert into pads values" +
      formula_model::pad_row_values("''") + ";\n");
  ASSERT_EQ(pads.exit_code, 0) << pads.err;
  formula_model::expect_pads(*fleet::postgres_engine(server.url(), "pads"), "pads");
}

TEST_F(Cluster, HostileNamesAreHarmlessInPostgres) {
  const PostgresServer server(folder() / "postgres");
  const std::string table = "a\"\"b'; drop table c; --";
  ASSERT_EQ(server
                .sql("create table \"" + table +
                     "\" (\"select\" text, \"order\" bigint, n float8, m float8, temp float8, t "
                     "float8, \"e';--\" float8)")
                .exit_code,
            0);
  std::vector<FleetCycle> cycles = cycles_;
  for (FleetCycle& each : cycles) each.unit = "x''; drop table wearwell_sums; -- " + each.unit;
  load(server, cycles, "\"" + table + "\"");
  const json fleet = fleet_summary(
      model_ + " --engine " + server.url() + " --table \"a\\\"b'; drop table c; --\"" + output() +
      " --columns unit=select cycle=order slip_speed=n:rad/s 'torque=m:N m' temperature=temp:degC "
      "closing_time=t:s \"energy=e';--:J\"");
  ASSERT_EQ(fleet["worst"].size(), 6u);
  EXPECT_THAT(fleet["worst"][0]["unit"].get<std::string>(),
              HasSubstr("x'; drop table wearwell_sums; -- unit"));
  EXPECT_EQ(server.sql("select count(*) from wearwell_sums").out, "6\n");
}

// ClickHouse of 2018, without window functions; a refused row among the others is counted and left out.
TEST(Clickhouse, PrintedStatementsHaveTheNumbersOfPredict) {
  const std::string missing = ClickhouseServer::missing();
  if (!missing.empty()) GTEST_SKIP() << "NOT TESTED with ClickHouse: " << missing;
  std::string folder = (std::filesystem::temp_directory_path() / "wearwell-test-XXXXXX").string();
  ASSERT_NE(mkdtemp(folder.data()), nullptr);
  const auto cycles = fleet_cycles(2500, 6, 12);
  std::ofstream(folder + "/model.json") << to_json(fleet_model(ScatterKind::quadratic)).dump(1);
  std::ofstream(folder + "/cycles.csv") << fleet_csv(cycles);
  {
    const ClickhouseServer server(folder);
    // A name that wants to be more, and a word that is reserved.
    const std::string made =
        "create table `cycles\"; drop table x` (`select` String, cycle Int64, n Float64, `m'\"` "
        "Float64, temp Float64, t Float64, e Float64) engine = MergeTree order by cycle;\n";
    ASSERT_EQ(server.sql(made).exit_code, 0);
    std::string rows = "insert into `cycles\"; drop table x` values";
    for (const FleetCycle& c : shuffled(cycles, 6))
      rows += fmt::format(" ('{}', {}, {}, {}, {}, {}, {})", c.unit, c.number, c.slip_speed,
                          c.torque, c.temperature, c.closing_time, c.energy);
    rows += " ('unit 1', 1000000, -1, 20, 100, 1, 1000)";
    const CommandResult loaded = server.sql(rows + ";\n");
    ASSERT_EQ(loaded.exit_code, 0) << loaded.err;
    const auto part = [&](const std::string& name) {
      const CommandResult printed = run_wearwell(
          "sql '" + folder +
          "/model.json' --dialect clickhouse --table '\"cycles\"\"; drop table x\"' "
          "--part " +
          name +
          " --columns unit=select cycle=cycle slip_speed=n:rad/s \"torque=m'\\\":N m\" "
          "temperature=temp:degC closing_time=t:s energy=e:J");
      EXPECT_EQ(printed.exit_code, 0) << printed.err;
      const CommandResult done = server.sql(printed.out);
      EXPECT_EQ(done.exit_code, 0) << name << ": " << done.err;
      return done.out;
    };
    for (int i = 0; i < 2; ++i) {
      part("setup");
      part("query");
    }
    EXPECT_EQ(server.sql("select count() from wearwell_sums").out, "6\n");
    const json expected = json::parse(run_wearwell("clutch predict '" + folder + "/model.json' '" +
                                                   folder + "/cycles.csv' --json")
                                          .out);
    std::istringstream lines(part("combine"));
    std::size_t found = 0;
    for (std::string line; std::getline(lines, line);) {
      std::vector<std::string> cells;
      std::istringstream text(line);
      for (std::string cell; std::getline(text, cell, '\t');) cells.push_back(cell);
      for (const auto& p : expected["plates"]) {
        if (p["plate"] != cells.at(0)) continue;
        ++found;
        EXPECT_EQ(std::stod(cells.at(1)), p["cycles"].get<double>());
        EXPECT_NEAR(std::stod(cells.at(4)) / p["volume"].get<double>(), 1, 1e-9);
        EXPECT_NEAR(std::stod(cells.at(5)) / p["sd_scatter"].get<double>(), 1, 1e-9);
        EXPECT_NEAR(std::stod(cells.at(8)) / p["sd_full"].get<double>(), 1, 1e-9);
        EXPECT_EQ(cells.at(17), cells.at(0) == "unit 1" ? "1" : "0");  // refused
        EXPECT_EQ(std::stod(cells.at(23)), p["outside_any"].get<double>());
        EXPECT_EQ(std::stod(cells.at(24)), p["clamped"].get<double>());
      }
    }
    EXPECT_EQ(found, 6u);
  }
  std::filesystem::remove_all(folder);
}

/// Three servers: one that knows the table as parts that lie on the two others.
class Sharded : public Cluster {
 protected:
  void SetUp() override {
    Cluster::SetUp();
    if (IsSkipped()) return;
    first_ = std::make_unique<PostgresServer>(folder() / "first");
    second_ = std::make_unique<PostgresServer>(folder() / "second");
    head_ = std::make_unique<PostgresServer>(folder() / "head");
    std::string foreign =
        "create extension postgres_fdw;\n" + create + " partition by hash (vin);\n";
    int part = 0;
    for (const auto* each : {&first_, &second_}) {
      ASSERT_EQ((*each)->sql(create).exit_code, 0);
      foreign += fmt::format(
          "create server shard{0} foreign data wrapper postgres_fdw options (host '127.0.0.1', "
          "port "
          "'{1}', dbname 'postgres', async_capable 'true', connect_timeout '5');\ncreate user "
          "mapping "
          "for wearwell server shard{0} options (user 'wearwell');\ncreate foreign table cycles{0} "
          "partition of cycles for values with (modulus 2, remainder {0}) server shard{0} options "
          "(table_name 'cycles');\n",
          part++, (*each)->port());
    }
    const CommandResult made = head_->sql(foreign);
    ASSERT_EQ(made.exit_code, 0) << made.err;
    load(*head_, shuffled(cycles_, 5));
  }

  std::string through_head() const {
    return model_ + " --engine " + head_->url() + " --table cycles" + output() + columns;
  }
  std::string side_by_side() const {
    return model_ + " --engine " + first_->url() + " --engine " + second_->url() +
           " --table cycles" + output() + columns;
  }

  std::unique_ptr<PostgresServer> first_, second_, head_;
};

TEST_F(Sharded, BothWaysHaveTheSameBits) {
  EXPECT_NE(first_->sql("select count(distinct vin) from cycles").out, "0\n");
  EXPECT_NE(second_->sql("select count(distinct vin) from cycles").out, "0\n");
  const json head = fleet_summary(through_head()), beside = fleet_summary(side_by_side());
  EXPECT_LT(difference(head, predicted()), 1e-9);
  EXPECT_EQ(head["worst"].dump(), beside["worst"].dump());
  EXPECT_EQ(head["levels"].dump(), beside["levels"].dump());
}

TEST_F(Sharded, AUnitOnTwoShardsIsRefused) {
  const std::string unit = first_->sql("select min(vin) from cycles").out;
  const std::string name = unit.substr(0, unit.size() - 1);
  FleetCycle stray = cycles_.front();
  stray.unit = name;
  stray.number = 1'000'000;
  load(*second_, {stray});
  const CommandResult run = run_wearwell("fleet " + side_by_side());
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, AllOf(HasSubstr(name), HasSubstr("more than one of the databases")));
  EXPECT_FALSE(std::filesystem::exists(folder() / "results"));
  // And nothing was kept.
  EXPECT_EQ(first_->sql("select to_regclass('wearwell_sums') is null").out, "t\n");
}

TEST_F(Sharded, ADeadShardIsAnErrorAndNoPartOfAnAnswer) {
  second_->kill();
  for (const std::string& way : {through_head(), side_by_side()}) {
    const CommandResult run = run_wearwell("fleet " + way);
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_THAT(run.err, HasSubstr("connect"));
    EXPECT_TRUE(run.out.empty()) << run.out;
    EXPECT_FALSE(std::filesystem::exists(folder() / "results"));
  }
}

}  // namespace
}  // namespace wearwell::clutch
