// The program with real servers and real faults: killed at any moment, without its broker, its database, its disk. What is
// stored in the end is what was sent, and states are the same bits as without faults.
#include <gmock/gmock.h>
#include <sys/mount.h>

#include <cstdlib>
#include <set>
#include <thread>

#include "monitor/http_client.h"
#include "monitor/program_rig.h"

namespace wearwell::monitor {
namespace {

using testing::HasSubstr;

void sleep_s(double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

/// How often a test kills: 20 times, or as many as WEARWELL_KILLS says.
int kills() {
  const char* many = std::getenv("WEARWELL_KILLS");
  return many ? std::atoi(many) : 20;
}

class Programs : public ProgramRig {
 protected:
  /// What is known when nothing goes wrong.
  std::string undisturbed(const std::vector<std::string>& lines) const {
    const auto config = configure("undisturbed", folder_source);
    append(config.parent_path() / "incoming" / "a.jsonl", lines);
    const CommandResult run =
        run_wearwell("monitor '" + config.string() + "' --once --threads 1 --quiet");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return known(config);
  }
  /// The store then has these readings from a file, and most states are not saved.
  void kill_before_states_follow(const std::filesystem::path& config,
                                 const std::vector<std::string>& lines) const {
    append(config.parent_path() / "incoming" / "a.jsonl", lines);
    ChildProcess monitor = start(config);
    ASSERT_TRUE(eventually([&] { return stored(config) == lines.size(); })) << log(config);
    monitor.end(SIGKILL);
  }
  static constexpr int event_kinds = 5;
  /// One of these kinds of events, of the n-th reading of a machine.
  static std::string event_line(int kind, int machine, int n) {
    const std::string head =
        fmt::format("{{\"machine\": \"M{:02}\", \"n\": {}, \"by\": \"x\"", machine, n);
    const double km = 0.5 * n;
    if (kind == 0) return head + fmt::format(", \"event\": \"replaced\", \"km\": {}}}", km);
    if (kind == 3) return head + fmt::format(", \"event\": \"installed\", \"km\": {}}}", km);
    if (kind == 4)
      return head + fmt::format(", \"event\": \"repaired\", \"restored\": {}}}", 0.2 * km);
    if (kind == 1)
      return head +
             fmt::format(", \"event\": \"corrected\", \"km\": {}, \"h\": {}}}", km, 0.7 * km);
    return head + ", \"event\": \"withdrawn\"}";
  }
};

TEST_F(Programs, ReadStandardInputToItsEnd) {
  const auto config = configure("a", "[source.line]\nkind = \"stdin\"\n");
  append(folder() / "lines", readings(3, 5));
  append(folder() / "lines", {readings(3, 5)[4], "{\"machine\": \"M01\"}", "nonsense"});
  const CommandResult run =
      run_wearwell("monitor '" + config.string() + "' < '" + (folder() / "lines").string() + "'");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("3 units: 0 act"));
  EXPECT_THAT(run.out, HasSubstr("15 readings stored; of 18 messages 1 repeated, 2 refused."));
  EXPECT_THAT(run.err, HasSubstr("source.line: refused: unit 'M01': t is missing"));
  const CommandResult exported = run_wearwell("monitor '" + config.string() + "' --export '" +
                                              (folder() / "r.parquet").string() + "'");
  EXPECT_EQ(exported.out, "15 readings are in " + (folder() / "r.parquet").string() + "\n");
  const CommandResult csv = run_wearwell("monitor '" + config.string() + "' --export '" +
                                         (folder() / "r.csv").string() + "'");
  EXPECT_EQ(csv.exit_code, 0);
  EXPECT_THAT(content(folder() / "r.csv"),
              HasSubstr("machine,key,time,received,depth [um],force [N],distance "
                        "[km],doubt\nM00,1,2023-11-14T22:14:20.000Z,"));
  EXPECT_EQ(run_wearwell("monitor '" + config.string() +
                         "' --once --json < /dev/null | grep -c '\"all\":3'")
                .out,
            "1\n");
}

// `decide` takes the units as the store has them, beside the monitor and without it: the same lives as the monitor tells.
// Each problem is a message of its own, with its place in the file.
TEST_F(Programs, CheckReportsEachProblem) {
  const auto config = configure("a", folder_source);
  const std::string good = content(config);
  const auto check = [&](const std::string& text) {
    write("a/fleet.toml", text);
    return run_wearwell("monitor '" + config.string() + "' --check");
  };
  EXPECT_EQ(check(good).exit_code, 0);
  EXPECT_EQ(check(good).out.find("removed"), std::string::npos);
  std::string keeps = good;
  keeps.replace(keeps.find("[store]"), 7, "[store]\nkeep = \"100 d\"");
  EXPECT_THAT(
      check(keeps).out,
      HasSubstr("readings of parts that have been out of service for 100 days are removed"));
  keeps.replace(keeps.find("100 d"), 5, "5 years");
  EXPECT_THAT(check(keeps).out, HasSubstr("out of service for 5 years are removed"));
  std::string nowhere = good;
  nowhere.replace(nowhere.find("fleet.sqlite"), 12, "sub/fleet.sqlite");
  EXPECT_EQ(check(nowhere).exit_code, 2);
  EXPECT_THAT(check(nowhere).err, HasSubstr("no such folder"));
  std::string wrong = good;
  wrong.replace(wrong.find("horizon"), 7, "horizont");
  wrong.replace(wrong.find("[store]"), 7, "[store]\nkeep = \"5 min\"");
  const CommandResult run = check(wrong);
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("wearwell: " + config.string() + ":3:"));
  EXPECT_THAT(run.err, HasSubstr("store.keep: must lie between 1 d and 1000 years\n    keep = "));
  EXPECT_THAT(run.err, HasSubstr("\nwearwell: " + config.string()));
  EXPECT_THAT(run.err, HasSubstr("alarm.horizon: is missing"));
}

// What a start says of its store, the check says too: alone, and beside other problems.
TEST_F(Programs, CheckLooksAtTheStoreAsAStart) {
  const auto refusals = [&](const std::string& store, int exit_code) {
    const std::string config = configure("a", "[source.line]\nkind = \"stdin\"\n", store).string();
    const CommandResult check = run_wearwell("monitor '" + config + "' --check");
    const CommandResult start = run_wearwell("monitor '" + config + "' --once < /dev/null");
    EXPECT_EQ(check.exit_code, exit_code) << check.err;
    EXPECT_EQ(check.err, start.err);
    EXPECT_EQ(start.exit_code, exit_code);
    return check.err;
  };
  EXPECT_THAT(refusals("none/fleet.sqlite", 2), HasSubstr("store.url: no such folder"));
  const std::string nowhere = fmt::format("postgresql://me@127.0.0.1:{}/x", free_port());
  EXPECT_THAT(refusals(nowhere, 3), HasSubstr("127.0.0.1"));
  const auto config = configure("a", "[source.line]\nkind = \"stdni\"\n", nowhere);
  const CommandResult both = run_wearwell("monitor '" + config.string() + "' --check");
  EXPECT_EQ(both.exit_code, 2);
  EXPECT_THAT(both.err, testing::AllOf(HasSubstr("nearest: 'stdin'"), HasSubstr("127.0.0.1")));
  // A store that is still to be made is right, and the check makes none.
  const auto good = configure("b", "[source.line]\nkind = \"stdin\"\n");
  EXPECT_EQ(run_wearwell("monitor '" + good.string() + "' --check").exit_code, 0);
  std::size_t files = 0;
  for (const auto& each : std::filesystem::directory_iterator(good.parent_path())) {
    EXPECT_TRUE(each.path().filename() == "fleet.toml" || each.path().filename() == "incoming");
    ++files;
  }
  EXPECT_EQ(files, 2U);
}

// A result that has learned what is in the store would count it twice: the check says so, as the start.
TEST_F(Programs, CheckComparesTheResultWithTheStore) {
  const auto config = configure("a", "[source.line]\nkind = \"stdin\"\n");
  append(folder() / "lines", readings(2, 5));
  const std::string monitor = "monitor '" + config.string() + "'",
                    csv = (folder() / "r.csv").string(), learned = (folder() / "learned").string();
  ASSERT_EQ(
      run_wearwell(monitor + " --once --quiet < '" + (folder() / "lines").string() + "'").exit_code,
      0);
  EXPECT_EQ(run_wearwell(monitor + " --check").exit_code, 0);
  ASSERT_EQ(run_wearwell(monitor + " --export '" + csv + "'").exit_code, 0);
  const CommandResult update =
      run_wearwell("update '" + result() + "' '" + csv + "' -o '" + learned + "' --no-report");
  ASSERT_LE(update.exit_code, 1) << update.err;
  std::string text = content(config);
  text.replace(text.find(result()), result().size(), learned);
  write("a/fleet.toml", text);
  const CommandResult check = run_wearwell(monitor + " --check");
  EXPECT_EQ(check.exit_code, 2) << check.err;
  EXPECT_THAT(check.err, HasSubstr("it has learned readings of this store"));
  EXPECT_EQ(check.err, run_wearwell(monitor + " --once < /dev/null").err);
}

TEST_F(Programs, BeginWithACommentedConfiguration) {
  const std::string folder_name = (folder() / "new").string();
  const std::string make = "new monitor '" + folder_name + "' --from '" + result() + "'";
  const CommandResult made = run_wearwell(make);
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const std::string config = folder_name + "/monitor.toml";
  EXPECT_EQ(run_wearwell("monitor '" + config + "' --check").exit_code, 0);
  append(
      folder() / "lines",
      {R"({"machine": "M1", "time": "2026-05-05T12:00:00Z", "depth": 4, "force": 20, "distance": 5})"});
  const CommandResult run =
      run_wearwell("monitor '" + config + "' --once < '" + (folder() / "lines").string() + "'");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("1 readings stored"));
  EXPECT_EQ(run_wearwell(make).exit_code, 2);
  EXPECT_THAT(run_wearwell(make).err, HasSubstr("is not empty"));
  EXPECT_THAT(run_wearwell("new monitor x").err, HasSubstr("--from RESULT is missing"));
  EXPECT_THAT(run_wearwell(make + " --limit '3 um'").err, HasSubstr("not for a monitor"));
  EXPECT_THAT(run_wearwell("new monitor x --from '" + folder_name + "'").err,
              HasSubstr("state.bin"));
}

TEST_F(Programs, AreDecidedUpon) {
  const auto config = configure("a", folder_source);
  const auto lines = readings(4, 20);
  const auto file = config.parent_path() / "incoming" / "a.jsonl";
  append(file, lines);
  const std::string decide = "decide '" + config.string() +
                             "' --failure-cost 12 --replacement-cost 1 --inspection-cost 0.01 "
                             "--month '10 km' --json";
  EXPECT_THAT(run_wearwell(decide).err, HasSubstr("is not a store yet: no monitor has run"));
  ChildProcess monitor = start(config);
  ASSERT_TRUE(eventually([&] { return stored(config) == lines.size(); })) << log(config);
  const CommandResult beside = run_wearwell(decide);  // states have not been saved yet
  EXPECT_LE(beside.exit_code, 1) << beside.err;
  EXPECT_EQ(monitor.end(SIGTERM), 0) << log(config);
  const CommandResult after =
      run_wearwell(decide + " --unit M01 --inspect-after '5 km' --given 'force = 20 N'");
  EXPECT_LE(after.exit_code, 1) << after.err;
  const auto reported = nlohmann::json::parse(after.out), early = nlohmann::json::parse(beside.out);
  EXPECT_EQ(reported["units"], early["units"]);
  const CommandResult fleet =
      run_wearwell("monitor '" + config.string() + "' --once --json < /dev/null");
  std::map<std::string, nlohmann::json> lives;
  const auto shown = nlohmann::json::parse(fleet.out);
  for (const auto& each : shown["list"]) lives[each["unit"]] = each["remaining"];
  ASSERT_EQ(lives.size(), 4U);
  ASSERT_EQ(reported["units"].size(), 4U);
  for (const auto& each : reported["units"]) {
    for (const char* p : {"q05", "q50", "q95"}) {
      const double expected = lives.at(each["unit"])[p];
      EXPECT_NEAR(each[p].get<double>(), expected, 1e-9 * expected);
    }
  }
  EXPECT_EQ(reported["inspection_ahead"]["unit"], "M01");
  EXPECT_GE(reported["inspection_ahead"]["worth"], 0);
  EXPECT_THAT(run_wearwell(decide + " --unit M9 --inspect-after '5 km'").err,
              HasSubstr("the fleet has no machine 'M9'"));
}

TEST_F(Programs, EndOnASignalWithAllThatWasStored) {
  const auto config = configure("a", folder_source);
  const auto lines = readings(4, 20);
  append(config.parent_path() / "incoming" / "a.jsonl", lines);
  ChildProcess monitor = start(config);
  ASSERT_TRUE(eventually([&] { return stored(config) == lines.size(); })) << log(config);
  EXPECT_EQ(monitor.end(SIGTERM), 0) << log(config);
  EXPECT_THAT(log(config), HasSubstr("80 readings stored"));
  EXPECT_EQ(known(config) == undisturbed(lines), true);
}

// Hours ahead and hours back, while it runs: nobody falls silent by that, and what is known is the same bits.
TEST_F(Programs, GoOnWhereTheClockJumps) {
  const auto config = configure("a", folder_source);
  write("a/fleet.toml", content(config) + "silence = \"30 min\"\n");
  const auto file = config.parent_path() / "incoming" / "a.jsonl";
  const auto lines = readings(6, 36);
  write("clock", "0");
  ChildProcess monitor({"/usr/bin/env", fmt::format("LD_PRELOAD={}", JUMPING_CLOCK),
                        "WEARWELL_TEST_CLOCK=" + (folder() / "clock").string(), WEARWELL_BINARY,
                        "monitor", config.string(), "--threads", "2"},
                       config.parent_path() / "log");
  const int hours[] = {0, 5, -7, 0, 700, -3000};
  std::size_t sent = 0;
  for (const int each : hours) {
    write("clock", std::to_string(3600 * each));
    sleep_s(0.6);  // by then whoever has fallen silent would have been told
    const std::size_t end = sent + lines.size() / std::size(hours);
    append(file, {lines.begin() + static_cast<std::ptrdiff_t>(sent),
                  lines.begin() + static_cast<std::ptrdiff_t>(end)});
    sent = end;
    ASSERT_TRUE(eventually([&] { return stored(config) == sent; })) << log(config);
  }
  sleep_s(1.2);
  EXPECT_EQ(monitor.end(SIGTERM), 0) << log(config);
  EXPECT_THAT(log(config), testing::Not(HasSubstr("-> unknown")));
  // The jumps have been there: messages say the time of a clock that was 700 hours ahead, and 3000 behind.
  std::int64_t least = INT64_MAX, most = 0;
  for (const StoredReading& each : look(config, "fleet.sqlite")->after(0, 1000)) {
    least = std::min(least, each.received_ms);
    most = std::max(most, each.received_ms);
  }
  EXPECT_GT(most - least, 3600'000LL * 3600);
  EXPECT_TRUE(known(config) == undisturbed(lines));
  // Begun anew it counts by the machine's clock: what came 3000 hours ago by that is old, what comes from ahead is not.
  const std::size_t reported_before = log(config).size();
  monitor = start(config);
  EXPECT_TRUE(eventually([&] {
    return log(config).find("monitoring", reported_before) != std::string::npos;
  })) << log(config);
  EXPECT_EQ(monitor.end(SIGTERM), 0);
}

TEST_F(Programs, KilledAtAnyMomentGoOnToTheSameBits) {
  Rng rng(23, 1);
  const auto config = configure("a", folder_source);
  const auto file = config.parent_path() / "incoming" / "a.jsonl";
  const int rounds = kills(), machines = 8;
  const auto lines = readings(machines, 10 * (rounds + 1));
  std::vector<std::string> events;  // installations, repairs, corrections ... among the readings
  std::size_t sent = 0;
  for (int round = 0; round <= rounds; ++round) {
    ChildProcess monitor = start(config);
    sleep_s(rng.uniform(0, 0.5));
    const std::size_t end = std::min(lines.size(), sent + 10 * machines);
    append(file, {lines.begin() + static_cast<std::ptrdiff_t>(sent),
                  lines.begin() + static_cast<std::ptrdiff_t>(end)});
    for (int i = 0; i < event_kinds; ++i)
      events.push_back(event_line(i, static_cast<int>(rng.bits() % machines),
                                  1 + static_cast<int>(rng.bits() % (end / machines))));
    append(file, {events.end() - event_kinds, events.end()});
    append(file, {lines[rng.bits() % end], events[rng.bits() % events.size()],
                  "{half"});  // and what comes again
    sent = end;
    sleep_s(rng.uniform(0, 1.5));
    monitor.end(SIGKILL);
  }
  const std::size_t reported_before = log(config).size();
  ChildProcess monitor = start(config);
  ASSERT_TRUE(eventually([&] {
    return log(config).find("monitoring", reported_before) != std::string::npos;
  })) << log(config);
  ASSERT_TRUE(eventually([&] { return stored(config) == lines.size(); })) << log(config);
  EXPECT_EQ(monitor.end(SIGTERM), 0) << log(config);
  std::set<std::string> different(events.begin(), events.end());
  EXPECT_EQ(look(config, "fleet.sqlite")->events_after(0).size(), different.size());
  auto all = lines;
  all.insert(all.end(), events.begin(), events.end());
  EXPECT_TRUE(known(config) == undisturbed(all));
}

// The last lines, which `lines` has no longer.
std::vector<std::string> taken_from_the_end(std::vector<std::string>& lines, std::ptrdiff_t count) {
  std::vector<std::string> last(lines.end() - count, lines.end());
  lines.erase(lines.end() - count, lines.end());
  return last;
}

// Killed with many readings whose states it has not saved, it answers and accepts readings at once; its states follow.
TEST_F(Programs, AcceptReadingsWhileStatesFollow) {
  const auto port = static_cast<unsigned short>(free_port());
  const auto config = configure(
      "a",
      std::string(folder_source) +
          fmt::format("[source.web]\nkind = \"http\"\n[http]\nlisten = \"127.0.0.1:{}\"\n", port));
  auto lines = readings(8, 2001);
  const std::vector<std::string> late = taken_from_the_end(lines, 8);
  ASSERT_NO_FATAL_FAILURE(kill_before_states_follow(config, lines));
  const std::size_t reported_before = log(config).size();
  const auto is_ready = [&] {
    return log(config).find("monitoring", reported_before) != std::string::npos;
  };
  ChildProcess monitor = start(config);
  ASSERT_TRUE(eventually([&] { return is_listening(port); })) << log(config);
  EXPECT_EQ(get(port, "/health").body, "{\"status\":\"starting\"}\n");
  EXPECT_EQ(get(port, "/api/v1/units").status, 503);
  for (const std::string& each : late)
    EXPECT_EQ(post(port, "/api/v1/readings", each).status, 200) << log(config);
  EXPECT_EQ(stored(config), lines.size() + 8);
  EXPECT_FALSE(is_ready());
  ASSERT_TRUE(eventually(is_ready)) << log(config);
  EXPECT_EQ(get(port, "/health").body, "{\"status\":\"ok\"}\n");
  const auto units = nlohmann::json::parse(get(port, "/api/v1/units").body);
  EXPECT_EQ(units["matching"], 8);
  for (const auto& each : units["units"]) EXPECT_GE(each["quality"]["readings"], 2000);
  EXPECT_EQ(monitor.end(SIGTERM), 0) << log(config);
  lines.insert(lines.end(), late.begin(), late.end());
  EXPECT_TRUE(known(config) == undisturbed(lines));
}

// New units that come during a start take no place of those in the store, even if these have no state yet.
TEST_F(Programs, KnowTheirUnitsFromTheFirstReading) {
  const auto port = static_cast<unsigned short>(free_port());
  const auto config =
      configure("a", std::string(folder_source) +
                         fmt::format("[source.web]\nkind = \"http\"\n[http]\nlisten = "
                                     "\"127.0.0.1:{}\"\n[limits]\nunits = 8\n",
                                     port));
  auto lines = readings(8, 1001);
  const std::vector<std::string> late = taken_from_the_end(lines, 8);
  ASSERT_NO_FATAL_FAILURE(kill_before_states_follow(config, lines));
  ChildProcess monitor = start(config);
  ASSERT_TRUE(eventually([&] { return is_listening(port); })) << log(config);
  const auto refused = post(port, "/api/v1/readings",
                            R"({"machine": "new", "n": 1, "t": 1700000060, "km": 1, "h": 0.5})");
  EXPECT_EQ(refused.status, 400);
  EXPECT_THAT(refused.body, HasSubstr("limits.units"));
  for (const std::string& each : late)
    EXPECT_EQ(post(port, "/api/v1/readings", each).status, 200) << log(config);
  EXPECT_EQ(get(port, "/health").body, "{\"status\":\"starting\"}\n");
  EXPECT_EQ(monitor.end(SIGTERM), 0) << log(config);
}

// Asked to end before its states have followed, it ends; the next one goes on from there.
TEST_F(Programs, EndInTheMiddleOfAStart) {
  const int port = free_port();
  const auto config = configure(
      "a", std::string(folder_source) + fmt::format("[http]\nlisten = \"127.0.0.1:{}\"\n", port));
  const auto lines = readings(8, 1000);
  ASSERT_NO_FATAL_FAILURE(kill_before_states_follow(config, lines));
  ChildProcess monitor = start(config);
  ASSERT_TRUE(eventually([&] { return is_listening(port); })) << log(config);
  EXPECT_EQ(monitor.end(SIGTERM), 0) << log(config);
  EXPECT_THAT(log(config), HasSubstr("ended during the start; the next start continues"));
  EXPECT_EQ(run_wearwell("monitor '" + config.string() + "' --once --quiet").exit_code, 0);
  EXPECT_TRUE(known(config) == undisturbed(lines));
}

class PostgresPrograms : public Programs {
 protected:
  void SetUp() override {
    const std::string missing = PostgresServer::missing();
    if (!missing.empty()) GTEST_SKIP() << missing;
    server_ = std::make_unique<PostgresServer>(folder() / "postgres");
  }
  std::unique_ptr<PostgresServer> server_;
};

TEST_F(PostgresPrograms, GoOnWhenTheServerIsBack) {
  const auto config = configure("a", folder_source, server_->url());
  const auto file = config.parent_path() / "incoming" / "a.jsonl";
  const auto lines = readings(8, 60);
  ChildProcess monitor = start(config);
  const std::size_t parts = 6, part = lines.size() / parts;
  for (std::size_t i = 0; i < parts; ++i) {
    append(file, {lines.begin() + static_cast<std::ptrdiff_t>(i * part),
                  lines.begin() + static_cast<std::ptrdiff_t>((i + 1) * part)});
    if (i == 0) {
      ASSERT_TRUE(eventually([&] { return stored(config, server_->url()) > 0; })) << log(config);
    }
    if (i % 2 == 0) continue;
    sleep_s(0.2);
    server_->kill();
    sleep_s(0.5);
    server_->start();
  }
  ASSERT_TRUE(eventually([&] { return stored(config, server_->url()) == lines.size(); }))
      << log(config);
  EXPECT_EQ(monitor.end(SIGTERM), 0) << log(config);
  EXPECT_TRUE(known(config, server_->url()) == undisturbed(lines)) << log(config);
  EXPECT_THAT(log(config), HasSubstr("store: "));
}

class BrokerPrograms : public Programs {
 protected:
  void SetUp() override {
    if (!Broker::installed() ||
        run_command("command -v mosquitto_pub mosquitto_sub").exit_code != 0)
      GTEST_SKIP() << "mosquitto or its clients are not installed";
    broker_ = std::make_unique<Broker>(folder() / "broker");
  }
  std::filesystem::path configure_mqtt(const std::string& more = "",
                                       const std::string& store = "fleet.sqlite") const {
    return configure(
        "a",
        fmt::format(
            "[source.plant]\nkind = \"mqtt\"\nbroker = \"{}\"\ntopic = \"plant/{{unit}}/wear\"\n{}",
            broker_->url(), more),
        store, true);
  }
  /// Sends readings `from` to `to` of each machine, at least once, and returns when the broker has them.
  void send(int from, int to) const {
    const auto lines = readings(machines, 200, false);
    for (int i = 0; i < machines; ++i) {
      const auto file = folder() / "to-send";
      std::filesystem::remove(file);
      for (int n = from; n <= to; ++n) append(file, {lines[(n - 1) * machines + i]});
      const CommandResult run =
          run_command(fmt::format("mosquitto_pub -p {} -q 1 -t plant/M{:02}/wear -l < '{}'",
                                  broker_->port(), i, file.string()));
      ASSERT_EQ(run.exit_code, 0) << run.err;
    }
  }
  static constexpr int machines = 5;
  std::unique_ptr<Broker> broker_;
};

TEST_F(BrokerPrograms, StoreWhatIsSentAndTellTheStates) {
  const auto config = configure_mqtt(
      fmt::format("[publish]\nbroker = \"{}\"\nprefix = \"fleet\"\n", broker_->url()));
  ChildProcess monitor = start(config);
  ASSERT_TRUE(eventually([&] {
    return log(config).find("follows plant/+/wear") != std::string::npos;
  })) << log(config);
  send(1, 20);
  EXPECT_TRUE(eventually([&] { return stored(config) == 20 * machines; })) << log(config);
  const auto reported = [&] {
    return run_command(fmt::format("mosquitto_sub -p {} -t 'fleet/+/state' -C {} -W 5 -v",
                                   broker_->port(), static_cast<int>(machines)))
        .out;
  };
  EXPECT_TRUE(eventually([&] {
    return reported().find("fleet/M04/state {\"unit\":\"M04\"") != std::string::npos;
  })) << reported();
  // A broker that has gone comes back; it may have forgotten, and is told again.
  broker_->kill();
  std::filesystem::remove(folder() / "broker" / "mosquitto.db");
  sleep_s(0.3);
  broker_->start();
  EXPECT_TRUE(eventually([&] {
    return reported().find("fleet/M04/state {\"unit\":\"M04\"") != std::string::npos;
  })) << log(config);
  // Subscribed anew, since otherwise this would be lost.
  ASSERT_TRUE(eventually([&] {
    send(21, 25);
    return stored(config) == 25 * machines;
  })) << log(config);
  EXPECT_EQ(monitor.end(SIGTERM), 0);
}

// A broker with a certificate of its own: read where its authority is named, and a clear word where another one is.
TEST_F(BrokerPrograms, AreSureOfWhomTheyTalkTo) {
  const auto made = run_command(fmt::format(
      "cd '{}' && for each in authority other; do openssl req -x509 -newkey ec -pkeyopt "
      "ec_paramgen_curve:P-256 -nodes -days 2 -subj /CN=$each -keyout $each.key -out $each.pem; "
      "done && openssl req -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -subj /CN=broker "
      "-keyout server.key -out server.csr && printf 'subjectAltName=IP:127.0.0.1' > names && "
      "openssl x509 -req -in server.csr -CA authority.pem -CAkey authority.key -CAcreateserial "
      "-days 2 -extfile names -out server.pem",
      folder().string()));
  if (made.exit_code != 0) GTEST_SKIP() << "no openssl: " << made.err;
  broker_ = nullptr;
  broker_ = std::make_unique<Broker>(folder() / "secure", folder());
  const auto named = [&](const std::string& authority) {
    return configure_mqtt(authority.empty() ? std::string()
                                            : fmt::format("authority = \"{}/{}.pem\"\n",
                                                          folder().string(), authority));
  };
  for (const std::string authority : {"other", ""}) {
    const auto config = named(authority);
    std::filesystem::remove(config.parent_path() / "log");
    ChildProcess monitor = start(config);
    EXPECT_TRUE(eventually([&] {
      return log(config).find("TLS: certificate verify failed: ") != std::string::npos;
    })) << log(config);
    EXPECT_THAT(log(config),
                HasSubstr(authority.empty() ? "the system's certificate authorities do not confirm"
                                            : "/other.pem does not confirm it"));
    EXPECT_THAT(log(config), testing::Not(HasSubstr("follows")));
    EXPECT_EQ(monitor.end(SIGTERM), 0);
  }
  const auto config = named("authority");
  ChildProcess monitor = start(config);
  ASSERT_TRUE(eventually([&] { return log(config).find("follows") != std::string::npos; }))
      << log(config);
  const auto lines = readings(machines, 200, false);
  for (int i = 0; i < machines; ++i) {
    for (int n = 0; n < 200; ++n)
      append(folder() / fmt::format("M{}", i), {lines[n * machines + i]});
    const CommandResult sent = run_command(fmt::format(
        "mosquitto_pub --cafile '{0}/authority.pem' -h 127.0.0.1 -p {1} -q 1 -t plant/M{2:02}/wear "
        "-l < '{0}/M{2}'",
        folder().string(), broker_->port(), i));
    ASSERT_EQ(sent.exit_code, 0) << sent.err;
  }
  EXPECT_TRUE(eventually([&] { return stored(config) == lines.size(); }))
      << stored(config) << log(config);
  // The broker goes and comes back.
  broker_->kill();
  broker_->start();
  const std::size_t reported_before = log(config).size();
  EXPECT_TRUE(eventually([&] {
    return log(config).find("trying again", reported_before / 2) != std::string::npos;
  })) << log(config);
  EXPECT_EQ(monitor.end(SIGTERM), 0);
}

TEST_F(BrokerPrograms, KilledLoseNothingThatTheBrokerHas) {
  const auto config = configure_mqtt();
  Rng rng(5, 1);
  {
    ChildProcess monitor = start(config);  // from here on the broker keeps what comes
    ASSERT_TRUE(eventually([&] { return log(config).find("follows") != std::string::npos; }))
        << log(config);
  }
  int last = 0;
  for (int round = 0; round < 5; ++round) {
    ChildProcess monitor = start(config);
    send(last + 1, last + 20);
    last += 20;
    sleep_s(rng.uniform(0, 0.6));
    monitor.end(SIGKILL);
  }
  const std::size_t reported_before = log(config).size();
  ChildProcess monitor = start(config);
  EXPECT_TRUE(eventually([&] {
    return log(config).find("follows", reported_before) != std::string::npos;
  })) << log(config);
  EXPECT_TRUE(eventually([&] {
    return stored(config) == static_cast<std::uint64_t>(last * machines);
  })) << stored(config)
      << log(config);
  EXPECT_EQ(monitor.end(SIGTERM), 0);
}

TEST_F(BrokerPrograms, AcknowledgeNothingThatIsNotStored) {
  const std::string missing = PostgresServer::missing();
  if (!missing.empty()) GTEST_SKIP() << missing;
  PostgresServer server(folder() / "postgres");
  const auto config = configure_mqtt("", server.url());
  ChildProcess monitor = start(config);
  ASSERT_TRUE(eventually([&] { return log(config).find("follows") != std::string::npos; }))
      << log(config);
  send(1, 10);
  ASSERT_TRUE(eventually([&] { return stored(config, server.url()) == 10 * machines; }))
      << log(config);
  // It reads what it cannot store, and is killed.
  server.kill();
  send(11, 40);
  ASSERT_TRUE(eventually([&] {
    return log(config).find("cannot store readings, which wait") != std::string::npos;
  })) << log(config);
  monitor.end(SIGKILL);
  server.start();
  monitor = start(config);
  EXPECT_TRUE(eventually([&] { return stored(config, server.url()) == 40 * machines; }))
      << stored(config, server.url()) << log(config);
  EXPECT_EQ(monitor.end(SIGTERM), 0);
}

TEST_F(Programs, WaitWhereTheDiskIsFull) {
  const auto disk = folder() / "disk";
  std::filesystem::create_directory(disk);
  if (mount("wearwell-monitor", disk.c_str(), "tmpfs", 0, "size=8m") != 0)
    GTEST_SKIP() << "only root may mount a small disk";
  const auto config = configure("a", folder_source, (disk / "fleet.sqlite").string());
  const auto file = config.parent_path() / "incoming" / "a.jsonl";
  const auto lines = readings(10, 100);
  append(file, {lines.begin(), lines.begin() + 50});
  ChildProcess monitor = start(config);
  const std::string url = (disk / "fleet.sqlite").string();
  EXPECT_TRUE(eventually([&] { return stored(config, url) == 50; })) << log(config);
  run_command("cat /dev/zero > '" + (disk / "fill").string() + "' 2> /dev/null");
  append(file, {lines.begin() + 50, lines.end()});
  EXPECT_TRUE(eventually([&] {
    return log(config).find("is the disk full?") != std::string::npos;
  })) << log(config);
  EXPECT_TRUE(monitor.runs());
  std::filesystem::remove(disk / "fill");
  EXPECT_TRUE(eventually([&] { return stored(config, url) == lines.size(); })) << log(config);
  EXPECT_EQ(monitor.end(SIGTERM), 0) << log(config);
  EXPECT_TRUE(known(config, url) == undisturbed(lines));
  umount(disk.c_str());
}

/// Of a process, in MB.
double resident(pid_t pid) {
  std::ifstream file(fmt::format("/proc/{}/statm", pid));
  double all = 0, pages = 0;
  file >> all >> pages;
  return pages * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

// A reading a minute of twenty machines for a day.
TEST_F(Programs, NeedNoMoreMemoryWithTime) {
  const auto config = configure("a", folder_source);
  const auto file = config.parent_path() / "incoming" / "a.jsonl";
  const auto lines = readings(20, 1440);
  ChildProcess monitor = start(config);
  double third = 0;
  for (std::size_t part = 0; part < 3; ++part) {
    const std::size_t size = lines.size() / 3;
    append(file, {lines.begin() + static_cast<std::ptrdiff_t>(part * size),
                  lines.begin() + static_cast<std::ptrdiff_t>((part + 1) * size)});
    ASSERT_TRUE(eventually([&] { return stored(config) == (part + 1) * size; }, 200))
        << log(config);
    sleep_s(1);
    if (part == 0) third = resident(monitor.pid());
  }
  EXPECT_LT(resident(monitor.pid()), third + 40) << "MB, after " << third;
  EXPECT_EQ(monitor.end(SIGTERM), 0);
}

}  // namespace
}  // namespace wearwell::monitor
