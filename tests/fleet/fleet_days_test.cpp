// "By when" of a fleet in days: from moments, from dates, from cycles a day.
#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "fleet/sample_fleet.h"
#include "support/scratch.h"
#include "wearwell/models/clutch/fleet_counts.h"
#include "wearwell/models/clutch/fleet_days.h"

namespace wearwell::clutch {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class FleetInDays : public ScratchTest {
 protected:
  std::string path(const std::string& name) const { return "'" + (folder() / name).string() + "'"; }
  std::string output() const { return " -o " + path("results"); }
  /// Cycles of three units, 40 a day of each, unit 3 twice as many; of unit 4 there is one.
  std::string fleet() {
    write("model.json", to_json(fleet_model(ScatterKind::linear)).dump(1));
    auto cycles = fleet_cycles(3000, 3, 31);
    cycles.push_back(cycles.front());
    cycles.back().unit = "unit 4";
    std::istringstream lines(fleet_csv(cycles));
    std::string line, text;
    std::getline(lines, line);
    text = line + ",moment,day,rate,words\n";
    std::map<std::string, int> count;
    for (const FleetCycle& each : cycles) {
      std::getline(lines, line);
      const int daily = each.unit == "unit 3" ? 80 : 40, i = count[each.unit]++;
      const int seconds = i * (86400 / daily), day = seconds / 86400, left = seconds % 86400;
      const std::string date = day_text(1.7e9 + 86400.0 * day);
      text += fmt::format("{},{} {:02}:{:02}:{:02},{},{},soon\n", line, date, left / 3600,
                          left / 60 % 60, left % 60, date,
                          each.unit == "unit 4" ? "" : std::to_string(daily));
    }
    write("cycles.csv", text);
    return path("model.json") + " " + path("cycles.csv") + output();
  }
};

TEST_F(FleetInDays, AreTheCyclesThatAUnitMakesInThem) {
  const std::string asked = fleet();
  // Unit 4 has the mean of the others, (40 + 40 + 80) / 3.
  const json rated = fleet_summary(asked + " --columns cycles_per_day=rate --days 30,0");
  const json timed = fleet_summary(asked + " --columns time=moment --days 30,0");
  const json plain = fleet_summary(asked + " --horizon 0");
  EXPECT_FALSE(plain.contains("levels_by_day"));
  for (const json* each : {&rated, &timed}) {
    EXPECT_NEAR((*each)["fleet"]["cycles_per_day"].get<double>(), 160.0 / 3, 1e-9);
    EXPECT_EQ((*each)["fleet"]["units_without_rate"], 1);
    ASSERT_EQ((*each)["levels_by_day"].size(), 8u);
    for (std::size_t l = 0; l < 4; ++l)
      EXPECT_EQ((*each)["levels_by_day"][4 + l]["units"], plain["levels"][l]["units"]);
    for (const auto& unit : (*each)["worst"]) {
      if (!unit["cycles_left"].is_number()) continue;
      EXPECT_NEAR(unit["days_left"].get<double>() * unit["cycles_per_day"].get<double>(),
                  unit["cycles_left"].get<double>(), 1e-9 * unit["cycles_left"].get<double>());
    }
  }
  for (std::size_t i = 0; i < 8; ++i)
    EXPECT_NEAR(timed["levels_by_day"][i]["units"].get<double>(),
                rated["levels_by_day"][i]["units"].get<double>(), 1e-6);
  EXPECT_EQ(rated["levels_by_day"][0]["date"], "");
  EXPECT_THAT(timed["levels_by_day"][0]["date"].get<std::string>(), HasSubstr("202"));
  // Each unit by itself: what it has after 30 days is what it has after so many cycles.
  const json dated = fleet_summary(asked + " --columns time=day");
  ASSERT_EQ(dated["levels_by_day"].size(), 12u);
  const std::vector<FleetCycle> all = fleet_cycles(3000, 3, 31);
  for (const auto& unit : dated["worst"]) {
    // By the days from the first to the last, both counted, of which the last need not be full.
    const auto name = unit["unit"].get<std::string>();
    if (name == "unit 4") continue;
    const int daily = name == "unit 3" ? 80 : 40;
    const auto cycles = std::count_if(all.begin(), all.end(),
                                      [&](const FleetCycle& each) { return each.unit == name; });
    EXPECT_NEAR(unit["cycles_per_day"].get<double>(),
                static_cast<double>(cycles) / static_cast<double>((cycles - 1) / daily + 1), 1e-9);
  }
}

TEST_F(FleetInDays, WhatTellsNoDaysIsRefused) {
  const std::string asked = fleet();
  const auto refused = [&](const std::string& options, const std::string& part) {
    const CommandResult run = run_wearwell("fleet " + asked + options);
    EXPECT_EQ(run.exit_code, 2) << run.out;
    EXPECT_THAT(run.err, HasSubstr(part));
    EXPECT_FALSE(std::filesystem::exists(folder() / "results"));
  };
  refused(" --days 30", "the cycles per day of units are unknown");
  refused(" --columns time=words", "soon");
  refused(" --columns cycles_per_day=words", "does not hold numbers");
  refused(" --columns cycles_per_day=rate time=day", "keep one of them");
  refused(" --columns time=never", "has no column 'never'");
  EXPECT_THAT(run_wearwell("fleet " + asked).out,
              HasSubstr("cycles: the data have no cycles per day"));
  EXPECT_THAT(run_wearwell("fleet " + asked + " --columns time=day").out,
              HasSubstr("last of the data"));
  EXPECT_THAT(run_wearwell("sql " + path("model.json") +
                           " --dialect duckdb --table t --columns time=day slip_speed=a:rpm "
                           "'torque=b:N m' temperature=c:degC closing_time=d:s energy=e:J")
                  .err,
              HasSubstr("for wearwell fleet only"));
}

TEST(FleetDays, AreWordsOfTheCalendar) {
  EXPECT_EQ(day_text(0), "1970-01-01");
  EXPECT_EQ(day_text(951782400), "2000-02-29");
  EXPECT_EQ(day_text(951782399), "2000-02-28");
  EXPECT_EQ(day_text(253402300799.0), "9999-12-31");
  EXPECT_EQ(day_text(253402300800.0), "");
  EXPECT_EQ(day_text(NAN), "");
}

// Forecasts by any number of threads.
TEST(FleetCounts, AreTheSameBitsWhateverTheThreads) {
  const WearModel model = fleet_model(ScatterKind::linear);
  std::vector<UnitSums> units(300);
  std::vector<double> per_day;
  for (std::size_t i = 0; i < units.size(); ++i) {
    UnitSums& u = units[i];
    u.unit = std::to_string(i);
    u.cycles = 1000.0 + static_cast<double>(i);
    u.energy = 1e7 + 1e5 * static_cast<double>(i);
    u.volume = 0.3e-7 + 1e-9 * static_cast<double>(i % 97);
    u.settled = 0.9 * u.volume;
    u.variance = 1e-20 * static_cast<double>(1 + i);
    u.volumes = Eigen::ArrayXd::LinSpaced(5, 0.9, 1.2) * u.volume;
    u.settleds = 0.9 * u.volumes;
    per_day.push_back(10 + static_cast<double>(i % 7));
  }
  const auto counted = [&](int threads) {
    FleetCounts counts(model, true, {0.25, 1}, {0, 500}, {30});
    std::string text;
    for (const UnitRow& row : counts.add(units, per_day, threads))
      text += fmt::format("{} {} {} {} {} {}\n", row.unit, row.left, row.full.low, row.full.high,
                          row.reached, row.per_day);
    for (std::size_t l = 0; l < 2; ++l)
      for (std::size_t h = 0; h < 3; ++h) {
        const UnitCount n = counts.reached(l, h);
        text += fmt::format("{} {} {}\n", n.expected, n.low, n.high);
      }
    return text;
  };
  const std::string one = counted(1);
  for (const int threads : {2, 3, 8}) EXPECT_EQ(one, counted(threads));
}

}  // namespace
}  // namespace wearwell::clutch
