// `wearwell fleet` with servers of ClickHouse: one, and two shards with two replicas each (0.5 GB of memory, ZooKeeper
// with it).
#include <gmock/gmock.h>

#include <memory>

#include "fleet/clickhouse_server.h"
#include "fleet/sample_fleet.h"
#include "fleet/sample_kinds.h"
#include "fleet/sample_law.h"
#include "support/scratch.h"
#include "wearwell/fleet/clickhouse_engine.h"
#include "wearwell/models/clutch/fleet_run.h"
#include "wearwell/study/result_writer.h"

namespace wearwell::clutch {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const std::string columns =
    " --columns unit=vin cycle=cycle slip_speed=n:rad/s 'torque=m:N m' temperature=temp:degC "
    "closing_time=t:s energy=e:J";
const std::string layout =
    "(vin String, cycle UInt64, n Float64, m Nullable(Float64), temp Float64, t Float32, e "
    "Float64)";

std::string rows_of(const std::vector<FleetCycle>& cycles, const std::string& table) {
  std::string rows = "insert into " + table + " values";
  for (const FleetCycle& c : cycles)
    rows += fmt::format(" ('{}', {}, {}, {}, {}, {}, {})", c.unit, c.number, c.slip_speed, c.torque,
                        c.temperature, c.closing_time, c.energy);
  return rows + ";\n";
}

class ClickhouseFleet : public ScratchTest {
 protected:
  void SetUp() override {
    const std::string missing = ClickhouseServer::missing();
    if (!missing.empty()) GTEST_SKIP() << "NOT TESTED with ClickHouse: " << missing;
    // As Float32 has them.
    for (FleetCycle& each : cycles_) each.closing_time = static_cast<float>(each.closing_time);
    write("model.json", to_json(fleet_model(ScatterKind::exponential)).dump(1));
    write("cycles.csv", fleet_csv(cycles_));
    model_ = "'" + (folder() / "model.json").string() + "'";
  }

  static void must(const ClickhouseServer& server, const std::string& statements) {
    const CommandResult done = server.sql(statements);
    ASSERT_EQ(done.exit_code, 0) << done.err;
  }
  std::string output() const { return " -o '" + (folder() / "results").string() + "'"; }
  std::string table_file() const { return "'" + (folder() / "cycles.csv").string() + "'"; }
  std::string asked(const std::string& engine, const std::string& table = "cycles") const {
    return model_ + " --engine '" + engine + "' --table " + table + output() + columns;
  }
  json predicted() const {
    return json::parse(
        run_wearwell("clutch predict " + model_ + " " + table_file() + " --json").out);
  }
  void refused(const std::string& arguments, const std::string& why) const {
    const CommandResult run = run_wearwell("fleet " + arguments);
    EXPECT_EQ(run.exit_code, 2) << run.err;
    EXPECT_THAT(run.err, AllOf(HasSubstr(why), Not(HasSubstr("cret"))));
    EXPECT_TRUE(run.out.empty()) << run.out;
    EXPECT_FALSE(std::filesystem::exists(folder() / "results"));
  }

  std::vector<FleetCycle> cycles_ = fleet_cycles(2500, 6, 13);
  std::string model_;
};

TEST_F(ClickhouseFleet, HasTheNumbersOfPredictAndOfDuckdb) {
  const ClickhouseServer server(folder());
  must(server, "create table cycles " + layout + " engine = MergeTree order by vin;\n" +
                   rows_of(shuffled({cycles_.begin(), cycles_.begin() + 1500}, 3), "cycles"));
  const std::string arguments = asked(server.address());
  fleet_summary(arguments);
  must(server, rows_of(shuffled({cycles_.begin() + 1500, cycles_.end()}, 4), "cycles"));
  const json fleet = fleet_summary(arguments);
  EXPECT_LT(difference(fleet, predicted()), 1e-9);
  EXPECT_EQ(server.sql("select count() from wearwell_sums").out, "12\n");  // in two runs
  // Nothing new, and all anew: not a bit changes. A password is in the address, or beside it.
  EXPECT_EQ(fleet["worst"].dump(), fleet_summary(arguments)["worst"].dump());
  const json anew =
      fleet_summary(asked(server.address("reader:se%20cret%2F@%25@")) + " --prefix x");
  EXPECT_EQ(fleet["worst"].dump(), anew["worst"].dump());
  const auto engine = fleet::clickhouse_engine(server.address(), "cycles");
  const Result parts =
      find_fleet(read_identified_model(folder() / "model.json"), {engine.get()},
                 {.columns = {"unit=vin", "cycle=cycle", "slip_speed=n:rad/s", "torque=m:N m",
                              "temperature=temp:degC", "closing_time=t:s", "energy=e:J"},
                  .prefix = "parts",
                  .levels = {50},
                  .portion_rows = 500},
                 {});
  EXPECT_EQ(fleet["worst"].dump(), json::parse(summary_text(parts))["worst"].dump());
  ::setenv("CLICKHOUSE_PASSWORD", "se cret/@%", 1);
  const json known = fleet_summary(asked(server.address("reader@")));
  ::unsetenv("CLICKHOUSE_PASSWORD");
  EXPECT_EQ(fleet["worst"].dump(), known["worst"].dump());
  must(server,
       "create view dated as select *, toDateTime('2026-01-01 00:00:00') + toInt64(cycle) * 3600 "
       "as moment from cycles");
  expect_hours(
      fleet_summary(asked(server.address(), "dated") + " time=moment --horizon 0 --days 30"),
      cycles_);
  const json duckdb = fleet_summary(model_ + " " + table_file() + output());
  for (std::size_t i = 0; i < fleet["levels"].size(); ++i)
    EXPECT_NEAR(fleet["levels"][i]["units"].get<double>(),
                duckdb["levels"][i]["units"].get<double>(), 1e-8);
  EXPECT_LT(difference(duckdb, predicted()), 1e-9);

  std::filesystem::remove_all(folder() / "results");
  must(server, "insert into cycles values ('unit 1', 1, 100, 50, 150, 1, 1000)");
  refused(arguments, "rows came late");
  refused(arguments + " --prefix y", "with a repeated number");
  EXPECT_EQ(server.sql("select count() from y_sums").out, "0\n");  // and nothing was kept
  must(server, "insert into cycles values ('unit 1', 100000, 100, null, 150, 1, 1000)");
  refused(arguments, "unit 1, cycle 100000: torque is not a number");
  refused(asked(server.address("reader:se%20cret@")), "Wrong password");
  refused(asked(server.address(), "nothing"), "nothing doesn't exist");
  refused(asked(server.address() + "/nowhere"), "nowhere doesn't exist");
  refused(asked("clickhouse://127.0.0.1:1"), "cannot be reached: 127.0.0.1:1: Connection refused");
}

// Columns that a run does not name would be 0 there, without a word.
TEST_F(ClickhouseFleet, SumsOfAnotherOptionAreRefused) {
  const ClickhouseServer server(folder());
  must(server, "create table cycles " + layout + " engine = MergeTree order by vin;\n" +
                   rows_of(cycles_, "cycles"));
  const std::string arguments = asked(server.address());
  fleet_summary(arguments);
  fleet_summary(arguments + " --scatter-only --prefix plain");
  std::filesystem::remove_all(folder() / "results");
  const std::string all = "select sum(cityHash64(unit, last_cycle, v1)) from wearwell_sums";
  const std::string before = server.sql(all).out;
  refused(arguments + " --scatter-only",
          "made without --scatter-only, or for a model that has replicates: continue with the same "
          "option, or sum all cycles again, under another --prefix");
  refused(arguments + " --prefix plain", "made with --scatter-only: continue with the same option");
  EXPECT_EQ(before, server.sql(all).out);
  EXPECT_EQ(server.sql("select count() from plain_model").out,
            server.sql("select count() from plain_model where replicate = 0").out);
}

TEST_F(ClickhouseFleet, HostileNamesAreHarmless) {
  const ClickhouseServer server(folder());
  const std::string table = "`a\"b'; drop table c; --`";
  must(server, "create table " + table +
                   " (`select` String, `order` Int64, n Float64, m Float64, temp Float64, t "
                   "Float64, `e';--` Float64) engine = MergeTree order by n;\n");
  std::vector<FleetCycle> cycles = cycles_;
  for (FleetCycle& each : cycles) each.unit = "x\\'; drop table wearwell_sums; --\\t" + each.unit;
  must(server, rows_of(cycles, table));
  const json fleet = fleet_summary(
      model_ + " --engine " + server.address() +
      " --table \"\\\"a\\\"\\\"b'; drop table c; --\\\"\"" + output() +
      " --columns unit=select cycle=order slip_speed=n:rad/s 'torque=m:N m' temperature=temp:degC "
      "closing_time=t:s \"energy=e';--:J\"");
  ASSERT_EQ(fleet["worst"].size(), 6u);
  EXPECT_THAT(fleet["worst"][0]["unit"].get<std::string>(),
              HasSubstr("x'; drop table wearwell_sums; --\tunit"));
  EXPECT_EQ(server.sql("select count(*) from wearwell_sums").out, "6\n");
}

TEST_F(ClickhouseFleet, ALawHasTheNumbersOfTheLibrary) {
  const ClickhouseServer server(folder());
  must(server,
       "create table liners (id Int32, machine String, F Nullable(Float64), s Nullable(Float64)) "
       "engine = MergeTree order by id;\ninsert into liners values" +
           formula_model::formula_row_values("\\'") + ";\n");
  const auto engine = fleet::clickhouse_engine(server.address(), "liners");
  std::vector<std::string> values = formula_model::formula_values();
  values.push_back("erf(wear/(10 [um]))");
  formula_model::expect_library(formula_model::formula_state(folder()), *engine, "liners", values);
  must(server,
       "create table pads (id Int32, machine String, mat String, T Float64, TF Float64, hours "
       "Float64) "
       "engine = MergeTree order by id;\ninsert into pads values" +
           formula_model::pad_row_values("\\'") + ";\n");
  formula_model::expect_pads(*fleet::clickhouse_engine(server.address(), "pads"), "pads");
}

TEST_F(ClickhouseFleet, ACertificateIsHeldAgainstTheName) {
  const std::string here = folder().string();
  const CommandResult made = run_command(
      "cd '" + here +
      "' && openssl req -x509 -newkey rsa:2048 -nodes -days 2 -subj '/CN=localhost' -addext "
      "'subjectAltName=DNS:localhost' -keyout key.pem -out own.pem");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const int port = free_port();
  const ClickhouseServer server(
      folder(), fmt::format("<https_port>{1}</https_port><openSSL><server><certificateFile>{0}/own"
                            ".pem</certificateFile><privateKeyFile>{0}/key.pem</privateKeyFile>"
                            "<verificationMode>none</verificationMode></server></openSSL>",
                            here, port));
  must(server, "create table cycles " + layout + " engine = MergeTree order by vin;\n" +
                   rows_of(cycles_, "cycles"));
  refused(asked(fmt::format("clickhouses://localhost:{}", port)), "certificate verify failed");
  ::setenv("SSL_CERT_FILE", (here + "/own.pem").c_str(), 1);
  refused(asked(fmt::format("clickhouses://127.0.0.1:{}", port)), "certificate verify failed");
  const json fleet = fleet_summary(asked(fmt::format("clickhouses://localhost:{}", port)));
  ::unsetenv("SSL_CERT_FILE");
  EXPECT_LT(difference(fleet, predicted()), 1e-9);
}

/// Two shards with two replicas each. `cycles` is a part of it on every server, `slow` the same, which takes a second to be
/// read, `all_cycles` and `all_slow` are all of it, as every server knows it.
class ClickhouseShards : public ClickhouseFleet {
 protected:
  void SetUp() override {
    ClickhouseFleet::SetUp();
    if (IsSkipped()) return;
    const std::string missing = ZookeeperServer::missing();
    if (!missing.empty()) GTEST_SKIP() << "NOT TESTED with a cluster of ClickHouse: " << missing;
    zookeeper_ = std::make_unique<ZookeeperServer>(folder());
    const ClickhouseCluster cluster{zookeeper_->port(), {{{}, {}}, {{}, {}}}};
    for (std::size_t i = 0; i < 4; ++i) {
      server_[i] = std::make_unique<ClickhouseServer>(folder(), cluster, i / 2, i % 2);
      must(*server_[i],
           "create table cycles " + layout +
               " engine = ReplicatedMergeTree('/cycles/{shard}', '{replica}') order by vin;\n"
               "create view slow as select * from cycles where sleepEachRow(0.0005) = 0;\n"
               "create table all_cycles as cycles engine = Distributed(two, default, cycles, "
               "cityHash64(vin));\n"
               "create table all_slow as cycles engine = Distributed(two, default, slow);\n");
    }
    must(*server_[0],
         "set insert_distributed_sync = 1;\n" + rows_of(shuffled(cycles_, 5), "all_cycles"));
    for (std::size_t i = 0; i < 4; ++i) must(*server_[i], "system sync replica cycles");
    EXPECT_NE(server_[0]->sql("select count() from cycles").out, "2500\n");
    EXPECT_NE(server_[2]->sql("select count() from cycles").out, "2500\n");
  }

  /// Both replicas of a shard as one address.
  std::string shard(std::size_t i) const {
    return fmt::format("clickhouse://127.0.0.1:{},127.0.0.1:{}", server_[2 * i]->ports().http,
                       server_[2 * i + 1]->ports().http);
  }
  std::string side_by_side(const std::string& table) const {
    return asked(shard(0), table) + " --engine " + shard(1);
  }

  /// The summary, of a run during which the server that reads for it dies.
  json killed_meanwhile(const std::string& arguments, const std::vector<std::size_t>& victims,
                        const std::string& query) {
    CommandResult run;
    std::thread meanwhile([&] { run = run_wearwell("fleet " + arguments + " --json"); });
    const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    bool killed = false;
    while (!killed && std::chrono::steady_clock::now() < give_up) {
      for (const std::size_t i : victims) {
        const std::string running =
            server_[i]->sql("select count() from system.processes where " + query).out;
        if (running.empty() || running == "0\n") continue;
        server_[i]->stop();
        killed = true;
        break;
      }
    }
    meanwhile.join();
    EXPECT_TRUE(killed);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return run.exit_code == 0 ? json::parse(run.out) : json();
  }

  std::unique_ptr<ZookeeperServer> zookeeper_;
  std::unique_ptr<ClickhouseServer> server_[4];
};

TEST_F(ClickhouseShards, AReplicaThatDiesChangesNoBit) {
  const json whole = fleet_summary(asked(server_[0]->address(), "all_cycles") + " --prefix a");
  EXPECT_LT(difference(whole, predicted()), 1e-9);
  const json beside = fleet_summary(side_by_side("cycles") + " --prefix b");
  EXPECT_EQ(whole["worst"].dump(), beside["worst"].dump());
  EXPECT_EQ(whole["levels"].dump(), beside["levels"].dump());
  // One of the second shard, while it reads for the first server.
  const json again = killed_meanwhile(asked(server_[0]->address(), "all_slow") + " --prefix c",
                                      {2, 3}, "is_initial_query = 0 and query like '%temp%'");
  EXPECT_EQ(whole["worst"].dump(), again["worst"].dump());
  // The first of the first shard, which itself is asked.
  const json other =
      killed_meanwhile(side_by_side("slow") + " --prefix d", {0}, "query like 'insert%'");
  EXPECT_EQ(whole["worst"].dump(), other["worst"].dump());
  // From the sums that a run before left there, through a replica that had none.
  EXPECT_EQ(whole["worst"].dump(),
            fleet_summary(side_by_side("cycles") + " --prefix b")["worst"].dump());
}

TEST_F(ClickhouseShards, ADeadShardOrATornUnitIsAnErrorAndNoPartOfAnAnswer) {
  FleetCycle stray = cycles_.front();
  stray.number = 1'000'000;
  // On the shard that has none of its unit.
  const std::string there = fmt::format("select count() from cycles where vin = '{}'", stray.unit);
  const std::size_t other = server_[0]->sql(there).out == "0\n" ? 0 : 2;
  must(*server_[other], rows_of({stray}, "cycles"));
  refused(asked(server_[0]->address(), "all_cycles"),
          stray.unit + " has cycles in more than one shard");
  refused(side_by_side("cycles"), stray.unit + " has cycles in more than one of the databases");
  EXPECT_EQ(server_[0]->sql("select count() from wearwell_sums").out, "0\n");
  EXPECT_EQ(server_[2]->sql("select count() from wearwell_sums").out, "0\n");

  server_[2]->stop();
  server_[3]->stop();
  // The server itself would give a part.
  EXPECT_EQ(server_[0]->sql("select count() > 0 from all_cycles").out, "1\n");
  refused(asked(server_[0]->address(), "all_cycles"), "connection tries failed");
  refused(side_by_side("cycles"), "ClickHouse cannot be reached");
}

}  // namespace
}  // namespace wearwell::clutch
