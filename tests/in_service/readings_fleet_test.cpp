// wearwell fleet with a table of readings: each unit has the numbers of its tracker, the fleet those of units that share a population.
#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

#include "fleet/clickhouse_server.h"
#include "support/disk_content.h"
#include "support/run_command.h"
#include "support/scratch.h"
#include "support/servers.h"
#include "wearwell/models/registry.h"
#include "wearwell/prognosis/carried_state.h"
#include "wearwell/prognosis/common_population.h"
#include "wearwell/prognosis/result_lives.h"
#include "wearwell/prognosis/unit_tracker.h"

namespace wearwell {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

const std::string guides = PROJECT_SOURCE_DIR "/examples/fleet";

struct Row {
  std::string machine;
  double use = 0, wear = 0;  // h, um
};

// Machines at different rates, the last of which goes on at five times its rate.
std::vector<Row> rows_of(int machines) {
  std::vector<Row> rows;
  for (int i = 0; i < machines; ++i) {
    const double rate = 0.012 + 0.004 * (i % 6);
    for (int n = 1; n <= 2 + i % 4; ++n)
      rows.push_back(
          {fmt::format("M{}", i), 400.0 * n, rate * 400 * n + 1.5 * std::sin(7.0 * n + i)});
  }
  return rows;
}

std::string csv_of(std::vector<Row> rows, bool shuffled = true) {
  if (shuffled)
    std::stable_sort(rows.begin(), rows.end(),
                     [](const Row& a, const Row& b) { return a.wear < b.wear; });
  std::string text = "unit,use [h],wear [um]\n";
  for (const Row& each : rows) text += fmt::format("{},{},{}\n", each.machine, each.use, each.wear);
  return text;
}

class ReadingsFleet : public ScratchTest {
 protected:
  static void SetUpTestSuite() {
    char pattern[] = "/tmp/wearwell-test-XXXXXX";
    fit_ = mkdtemp(pattern) + std::string("/guides");
    ASSERT_EQ(run_wearwell("fit " + guides + "/study.toml -o " + fit_ + " --quiet").exit_code, 0);
    state_ = std::make_unique<prognosis::CarriedState>(prognosis::read_state(fit_));
    tracker_ = prognosis::tracker_where_possible(*state_, all_models());
  }
  static void TearDownTestSuite() {
    tracker_.reset();
    state_.reset();
    std::filesystem::remove_all(std::filesystem::path(fit_).parent_path());
  }
  std::string output() const { return " -o " + (folder() / "fleet").string(); }
  std::string table(const std::string& content) const { return write("a.csv", content).string(); }
  json fleet(const std::string& arguments, int exit_code = 0) const {
    const CommandResult run =
        run_wearwell("fleet " + fit_ + " " + arguments + output() + " --json");
    EXPECT_EQ(run.exit_code, exit_code) << run.err;
    return run.exit_code == exit_code ? json::parse(run.out) : json();
  }
  template <class Matcher>
  void refused(const std::string& arguments, const Matcher& what) const {
    const CommandResult run = run_wearwell("fleet " + fit_ + " " + arguments + output());
    EXPECT_EQ(run.exit_code, 2) << arguments;
    EXPECT_THAT(run.err, what) << arguments;
    EXPECT_FALSE(std::filesystem::exists(folder() / "fleet")) << arguments;
  }
  // A unit with all its rows, as Python's fit.track has it.
  static std::shared_ptr<prognosis::UnitTracker> tracked(const std::vector<Row>& rows,
                                                         const std::string& machine, bool fresh) {
    Table table;
    Column use, wear;
    table.source = "test";
    use.name = "use";
    wear.name = "wear";
    use.unit = "h";
    wear.unit = "um";
    use.is_number = wear.is_number = true;
    for (const Row& each : rows) {
      if (each.machine != machine) continue;
      use.numbers.push_back(each.use);
      wear.numbers.push_back(each.wear);
    }
    table.rows = use.numbers.size();
    table.columns = {use, wear};
    auto unit = std::make_shared<prognosis::UnitTracker>(tracker_, machine, fresh);
    unit->update(table);
    return unit;
  }
  static void expect_same(const json& found, const prognosis::UnitTracker& unit) {
    const json wanted = unit.json();
    for (const char* key : {"at", "level", "remaining", "b10", "passed", "beyond", "doubt"})
      EXPECT_EQ(found[key].dump(), wanted[key].dump()) << unit.unit() << " " << key;
    EXPECT_EQ(found["failing"][0], unit.risk("200 h")) << unit.unit();
    EXPECT_EQ(found["failing"][1], unit.risk("2000 h")) << unit.unit();
  }

  inline static std::string fit_;
  inline static std::unique_ptr<prognosis::CarriedState> state_;
  inline static std::shared_ptr<const prognosis::Tracker> tracker_;
};

const std::string horizons = " --horizon '2000 h,200 h'";

TEST_F(ReadingsFleet, HasTheNumbersOfTheTracker) {
  std::vector<Row> rows = rows_of(12);
  for (int n = 3; n <= 9; ++n) rows.push_back({"M0", 400.0 * n, 10 + 40.0 * (n - 2)});  // a jump
  // A machine of the study, with its rows there and later ones.
  const std::vector<Row> later = {{"L1", 3500, 86.5}, {"L1", 3800, 93.5}};
  std::string text = csv_of(rows);
  for (const Row& each : later) text += fmt::format("L1,{},{}\n", each.use, each.wear);
  text += "L1,562,14.43\nL1,1370,35.24\nL2,498,7.91\n";
  const json found = fleet(table(text) + horizons);
  ASSERT_EQ(found["riskiest"].size(), 14U);
  EXPECT_EQ(found["fleet"]["rows_of_study"], 3);
  double before = 2;
  int doubted = 0;
  for (const json& each : found["riskiest"]) {
    const std::string name = each["unit"];
    const bool of_study = name.starts_with("L");
    EXPECT_EQ(each["of_study"], of_study);
    expect_same(each, *tracked(name == "L1" ? later : rows, name, !of_study));
    EXPECT_LE(each["failing"][0].get<double>(), before);
    before = each["failing"][0];
    doubted += !each["doubt"].is_null();
    EXPECT_EQ(!each["doubt"].is_null(), name == "M0");
  }
  EXPECT_EQ(doubted, 1);
  EXPECT_THAT(found["checks"].dump(), HasSubstr("do not follow the forecast: 1 (M0)"));
}

// The failures of all are those that wearwell decide counts for the same units.
TEST_F(ReadingsFleet, CountsFailuresInTheCommonPopulation) {
  const std::vector<Row> rows = rows_of(9);
  const json found = fleet(table(csv_of(rows)) + horizons);
  std::vector<prognosis::KnownUnit> known;
  double alone = 0;
  for (int i = 0; i < 9; ++i) {
    const std::string name = fmt::format("M{}", i);
    const auto unit = tracked(rows, name, true);
    const prognosis::Forecast now = unit->forecast();
    known.push_back(
        {name, now.now, now.passed, now.remaining, [unit] { return unit->in_populations(); }});
    alone += unit->risk("2000 h");
  }
  prognosis::KnownLives lives;
  lives.populations = tracker_->populations();
  std::vector<const prognosis::KnownUnit*> units;
  for (const prognosis::KnownUnit& each : known) units.push_back(&each);
  const std::vector<double> after = {200 * 3600.0, 2000 * 3600.0};
  const prognosis::CommonPopulation common = prognosis::in_common(lives, units, after);
  EXPECT_EQ(found["fleet"]["populations"]["shared"], common.why.empty()) << common.why;
  for (std::size_t h = 0; h < 2; ++h) {
    double expected = 0;
    for (std::size_t k = 0; k < common.weight.size(); ++k)
      for (const double each : common.failed[k][h]) expected += common.weight[k] * each;
    EXPECT_NEAR(found["failures"][h]["expected"].get<double>(), expected, 1e-9);
  }
  EXPECT_NEAR(found["failures"][1]["expected"].get<double>(), alone, 0.3);
  EXPECT_LE(found["failures"][1]["low"].get<double>(), found["failures"][1]["expected"]);
  EXPECT_GE(found["failures"][1]["high"].get<double>(), found["failures"][1]["expected"]);
}

// More units than are followed at one time, and than their number is summed exactly for; on any number of threads.
TEST_F(ReadingsFleet, OfManyUnits) {
  const std::string file = table(csv_of(rows_of(700)));
  const json one = fleet(file + horizons + " --threads 1");
  std::filesystem::remove_all(folder() / "fleet");
  const json two = fleet(file + horizons + " --threads 2");
  EXPECT_EQ(one["failures"].dump(), two["failures"].dump());
  EXPECT_EQ(one["riskiest"].dump(), two["riskiest"].dump());
  EXPECT_EQ(one["fleet"]["units"], 700);
  const double expected = one["failures"][1]["expected"];
  EXPECT_GT(expected, 1);
  EXPECT_LT(one["failures"][1]["low"].get<double>(), expected);
  EXPECT_GT(one["failures"][1]["high"].get<double>(), expected);
}

TEST_F(ReadingsFleet, NamesWhatIsWrong) {
  const std::string heading = "unit,use [h],wear [um]\n";
  refused(table(heading + "A,300,2\nA,400,\n"),
          AllOf(HasSubstr("machine 'A' at use = 400 h"), HasSubstr("wear is missing")));
  refused(table(heading + "A,,3\nB,300,2\n"),
          AllOf(HasSubstr("machine 'A':"), HasSubstr("use is missing")));
  refused(table(heading + ",400,3\n"), HasSubstr("it has no unit"));
  refused(table(heading + "A,-5,3\n"), HasSubstr("machine 'A' at use = -5 h"));
  refused(table("unit,use,wear [um]\nA,400,3\n"), HasSubstr("--columns 'use=use:h'"));
  refused(table("unit,use [mm],wear [um]\nA,400,3\n"), HasSubstr("mm"));
  refused(table("machine,use [h],wear [um]\nA,400,3\n"), HasSubstr("--columns unit=machine"));
  refused(table("unit,age [h],wear [um]\nA,400,3\n"),
          AllOf(HasSubstr("has no column 'use'"), HasSubstr("leave out the measured column")));
  refused(table(heading + "A,400,3\n") + " --in-study", HasSubstr("--in-study: is for ages"));
  refused(table(heading + "A,400,3\n") + " --at x", HasSubstr("--at: is for ages"));
  refused(table(heading + "A,400,3\n") + " --horizon '5 mm'", HasSubstr("--horizon"));
  refused(table(heading + "L1,562,14.4\n"),
          AllOf(HasSubstr("machine 'L1' at use = 562 h"), HasSubstr("not one of them")));
  const json left = fleet(table(heading + "A,400,8\nA,800,\nB,400,9\n") + " --skip-bad", 1);
  EXPECT_EQ(left["left_out"]["rows"], 1);
  EXPECT_EQ(left["fleet"]["units"], 2);
}

// Without the measured column rows are ages, as of any life.
TEST_F(ReadingsFleet, AgesAloneAreAgesStill) {
  const json found = fleet(table("unit,age [h]\nA,400\nB,1200\n") + horizons);
  EXPECT_EQ(found["model"], "life-fleet");
}

TEST_F(ReadingsFleet, AViewOfPostgresHasTheNumbersOfFiles) {
  const std::string missing = PostgresServer::missing();
  if (!missing.empty()) GTEST_SKIP() << "NOT TESTED with PostgreSQL: " << missing;
  const PostgresServer server(folder() / "postgres");
  std::string rows;
  for (const Row& each : rows_of(5))
    rows += fmt::format("{}('{}', {}, {})", rows.empty() ? "" : ", ", each.machine, each.use,
                        each.wear);
  const CommandResult made = server.sql(
      "create table readings (serial text, run double precision, depth double precision);\n"
      "insert into readings values " +
      rows + ";\n");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const json database =
      fleet("--engine " + server.url() +
            " --table readings --columns unit=serial use=run:h wear=depth:um" + horizons);
  std::filesystem::remove_all(folder() / "fleet");
  const json files = fleet(table(csv_of(rows_of(5))) + horizons);
  EXPECT_EQ(database["failures"].dump(), files["failures"].dump());
  EXPECT_EQ(database["riskiest"].dump(), files["riskiest"].dump());
}

TEST_F(ReadingsFleet, ATableOfClickhouseHasTheNumbersOfFiles) {
  const std::string missing = ClickhouseServer::missing();
  if (!missing.empty()) GTEST_SKIP() << "NOT TESTED with ClickHouse: " << missing;
  const ClickhouseServer server(folder());
  std::string rows;
  for (const Row& each : rows_of(5))
    rows += fmt::format("{}('{}', {}, {})", rows.empty() ? "" : ", ", each.machine, each.use,
                        each.wear);
  const CommandResult made = server.sql(
      "create table readings (serial String, run Float64, depth Float64) engine = MergeTree order "
      "by run;\ninsert into readings values " +
      rows +
      ";\ncreate table pumps (serial String, hours Float64, known UInt8) engine = MergeTree order "
      "by serial;\ninsert into pumps values ('A', 400, 1), ('B', 1200.5, 0);\n");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const std::string engine = "--engine '" + server.address() + "' --table ";
  const json database =
      fleet(engine + "readings --columns unit=serial use=run:h wear=depth:um" + horizons);
  std::filesystem::remove_all(folder() / "fleet");
  const json files = fleet(table(csv_of(rows_of(5))) + horizons);
  EXPECT_EQ(database["failures"].dump(), files["failures"].dump());
  EXPECT_EQ(database["riskiest"].dump(), files["riskiest"].dump());
  // Ages, too.
  std::filesystem::remove_all(folder() / "fleet");
  const json ages =
      fleet(engine + "pumps --columns unit=serial age=hours:h in_study=known" + horizons);
  std::filesystem::remove_all(folder() / "fleet");
  const json same = fleet(table("unit,age [h],in_study\nA,400,yes\nB,1200.5,no\n") + horizons);
  EXPECT_EQ(ages["failures"].dump(), same["failures"].dump());
  EXPECT_EQ(ages["worst"].dump(), same["worst"].dump());
}

// While it reads and while it follows units, a signal ends it at once, and nothing is left.
TEST_F(ReadingsFleet, EndsWithASignal) {
  const std::string readings = table(csv_of(rows_of(20'000)));
  const std::string output = (folder() / "fleet").string();
  for (const int signal : {SIGINT, SIGTERM}) {
    for (const int after_ms : {50, 600}) {
      ChildProcess program({WEARWELL_BINARY, "fleet", fit_, readings, "-o", output},
                           folder() / "log");
      std::this_thread::sleep_for(std::chrono::milliseconds(after_ms));
      ASSERT_TRUE(program.runs()) << content(folder() / "log");
      const auto sent = std::chrono::steady_clock::now();
      EXPECT_EQ(program.end(signal), 128 + signal);
      EXPECT_LT(std::chrono::steady_clock::now() - sent, std::chrono::seconds(2));
      EXPECT_THAT(entries(folder()), testing::ElementsAre("a.csv", "log"));
    }
  }
}

}  // namespace
}  // namespace wearwell
