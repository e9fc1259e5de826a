// States follow from the readings in the order of storage alone: whatever is cut, repeated, late, or taken up again.
#include <gmock/gmock.h>

#include <algorithm>
#include <thread>

#include "monitor/fleet_rig.h"
#include "wearwell/base/rng.h"
#include "wearwell/monitor/fleet_json.h"
#include "wearwell/monitor/fleet_metrics.h"
#include "wearwell/monitor/fleet_text.h"
#include "wearwell/monitor/save_schedule.h"
#include "wearwell/monitor/unit_record.h"

namespace wearwell::monitor {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

using Fleets = FleetRig;

// States of very many units: a save of 20 s is followed by 180 s without one.
TEST(SaveSchedule, TakesATenthOfTheTimeAtMost) {
  using std::chrono::seconds;
  const SaveSchedule::Clock::time_point begin{};
  SaveSchedule saves(seconds(30), 9, begin);
  EXPECT_FALSE(saves.is_due(begin + seconds(29)));
  EXPECT_TRUE(saves.is_due(begin + seconds(30)));
  saves.saved(begin + seconds(30), begin + seconds(31));
  EXPECT_TRUE(saves.is_due(begin + seconds(61)));
  saves.saved(begin + seconds(61), begin + seconds(81));
  EXPECT_FALSE(saves.is_due(begin + seconds(260)));
  EXPECT_TRUE(saves.is_due(begin + seconds(261)));
}

TEST_F(Fleets, TellWhatIsKnown) {
  open();
  for (int n = 1; n <= 20; ++n) {
    deliver(message("slow", n, 0.5 * n));
    deliver(message("fast", n, 45.0 * n));
  }
  catch_up();
  const FleetView fleet = fleet_->fleet();
  EXPECT_EQ(fleet.units, 2U);
  EXPECT_EQ(fleet.stored, 40U);
  EXPECT_EQ(fleet.messages, 40U);
  EXPECT_EQ(fleet.axis_unit, "h");
  EXPECT_EQ(fleet.horizon, 100);
  const auto units = fleet_->units("", 0, 10);
  ASSERT_EQ(units.size(), 2U);
  EXPECT_EQ(units[0].unit, "fast");
  EXPECT_EQ(units[0].alarm, Alarm::act);
  EXPECT_EQ(units[1].alarm, Alarm::ok);
  EXPECT_EQ(units[0].at, 20);
  std::uint64_t matching = 0;
  EXPECT_EQ(fleet_->units("SLO", 0, 10, &matching)[0].unit, "slow");
  EXPECT_EQ(matching, 1U);
  const auto detail = fleet_->unit("fast");
  ASSERT_TRUE(detail);
  EXPECT_EQ(detail->moments.size(), 17U);  // sixteen, and the last
  EXPECT_EQ(detail->moments[4].measured, 225);
  EXPECT_EQ(detail->judged, 19U);
  EXPECT_GT(detail->survival.size(), 50U);
  EXPECT_EQ(detail->survival.front().survival, 1);
  EXPECT_FALSE(fleet_->unit("another"));
}

// Nothing is known of it before its second reading.
class BlindUnit : public GrowthUnit {
 public:
  prognosis::Forecast forecast() const override {
    if (readings() >= 2) return GrowthUnit::forecast();
    prognosis::Forecast forecast;
    forecast.level05 = forecast.level50 = forecast.level95 = forecast.passed =
        std::numeric_limits<double>::quiet_NaN();
    return forecast;
  }
};

class BlindTracker : public GrowthTracker {
 public:
  std::unique_ptr<prognosis::TrackedUnit> begin(const std::string&) const override {
    return std::make_unique<BlindUnit>();
  }
};

class BlindFleets : public FleetRig {
 protected:
  std::unique_ptr<Fleet> make_fleet() override {
    FleetSettings settings;
    settings.population = "population";
    settings.alarm = alarm_;
    return std::make_unique<Fleet>(blind_, *store_, *tally_, quiet_, settings);
  }
  BlindTracker blind_;
};

TEST_F(BlindFleets, ShowNothingWhereNothingIsKnown) {
  open();
  deliver(message("dark", 1, 1));
  for (int n = 1; n <= 3; ++n) deliver(message("seen", n, 0.5 * n));
  catch_up();
  const auto units = fleet_->units("", 0, 10);
  ASSERT_EQ(units.size(), 2U);
  EXPECT_EQ(units[0].unit, "seen");
  EXPECT_TRUE(units[0].known);
  EXPECT_FALSE(units[1].known);
  EXPECT_EQ(units[1].alarm, Alarm::unknown);
  const auto json = json_of(units[1]);
  EXPECT_EQ(json["known"], false);
  for (const char* key : {"at", "level", "remaining", "b10", "numerical_error", "risk", "passed"})
    EXPECT_TRUE(json[key].is_null()) << key;
  EXPECT_EQ(json["quality"]["readings"], 1);
  EXPECT_EQ(json_of(units[0])["known"], true);
  EXPECT_TRUE(json_of(units[0])["risk"].is_number());
  const std::string metrics = metrics_text(fleet_->fleet(), units, {});
  EXPECT_THAT(metrics, HasSubstr("wearwell_unit_alarm{unit=\"dark\"} -1\n"));
  EXPECT_THAT(metrics, HasSubstr("wearwell_unit_risk_ratio{unit=\"seen\"}"));
  for (const char* name : {"risk_ratio", "passed_ratio", "position", "remaining_b10"})
    EXPECT_THAT(metrics, Not(HasSubstr(fmt::format("wearwell_unit_{}{{unit=\"dark\"}}", name))));
  EXPECT_THAT(metrics, Not(HasSubstr("{unit=\"dark\",percentile")));
  const present::Table table = fleet_table(*fleet_, 10);
  EXPECT_TRUE(std::holds_alternative<std::monostate>(table.rows[1][7]));
  const auto detail = fleet_->unit("dark");
  ASSERT_TRUE(detail);
  EXPECT_TRUE(detail->moments.empty());
  EXPECT_TRUE(detail->path.empty());
  EXPECT_TRUE(detail->survival.empty());
  deliver(message("dark", 2, 2));
  catch_up();
  EXPECT_TRUE(fleet_->unit("dark")->view.known);
  EXPECT_EQ(fleet_->unit("dark")->moments.size(), 1U);
}

TEST_F(Fleets, TellThePathAhead) {
  open();
  for (int n = 1; n <= 20; ++n) deliver(message("a", n, 10.0 * n));
  catch_up();
  const auto detail = fleet_->unit("a");
  ASSERT_TRUE(detail);
  const UnitView& view = detail->view;
  std::vector<UnitDetail::PathPoint> ahead;
  for (const auto& each : detail->path)
    if (each.at > view.at) ahead.push_back(each);
  ASSERT_GT(ahead.size(), 20U);
  double before = view.level.q50;
  for (const auto& each : ahead) {
    EXPECT_GT(each.level.q50, before);
    EXPECT_LT(each.level.q05, each.level.q50);
    EXPECT_LT(each.level.q50, each.level.q95);
    before = each.level.q50;
  }
  // To where nineteen of twenty have reached the limit; the median does half way, of the stations.
  EXPECT_NEAR(ahead.back().at, view.at + view.remaining.q95, 1e-6);
  EXPECT_NEAR(ahead.back().level.q05, GrowthUnit::limit, 20);
  EXPECT_NEAR(ahead[ahead.size() / 2 - 1].at, view.at + view.remaining.q50, 1e-6);
  EXPECT_NEAR(ahead[ahead.size() / 2 - 1].level.q50, GrowthUnit::limit, 20);
  // Asked again, and while readings come.
  EXPECT_EQ(fleet_->unit("a")->path.size(), detail->path.size());
  std::jthread reader([&](std::stop_token stop) {
    while (!stop.stop_requested()) fleet_->unit("a");
  });
  for (int n = 21; n <= 60; ++n) {
    deliver(message("a", n, 10.0 * n));
    catch_up();
  }
  reader.request_stop();
  reader.join();
  EXPECT_GT(fleet_->unit("a")->path.back().at, 60);
}

TEST_F(Fleets, TellWhatHasChanged) {
  open();
  deliver(message("a", 1, 1));
  deliver(message("b", 1, 1));
  catch_up();
  const std::uint64_t before = fleet_->version();
  EXPECT_EQ(fleet_->changed_since(0).size(), 2U);
  EXPECT_TRUE(fleet_->changed_since(before).empty());
  deliver(message("b", 2, 2));
  catch_up();
  EXPECT_THAT(fleet_->changed_since(before), ElementsAre("b"));
  EXPECT_GT(fleet_->version(), before);
}

TEST_F(Fleets, CountRepeatedLateAndContradicting) {
  open();
  for (const int n : {1, 2, 5, 5, 4, 5}) deliver(message("a", n, n));
  EXPECT_EQ(deliver(message("a", 5, 7)).refused, 1U);
  deliver(message("a", 6, 9000));
  catch_up();
  const UnitView view = fleet_->units("", 0, 1)[0];
  EXPECT_EQ(view.quality.readings, 5U);
  EXPECT_EQ(view.quality.repeated, 2U);
  EXPECT_EQ(view.quality.late, 1U);
  EXPECT_EQ(view.quality.contradicting, 1U);
  EXPECT_EQ(view.quality.refused, 1U);
  EXPECT_THAT(view.quality.last_problem,
              HasSubstr("another reading with number 5 is stored already"));
}

// A growing unit whose rate triples: to beyond the threshold, which the forecast does not know.
TEST_F(Fleets, DoubtAForecastThatReadingsDoNotFollow) {
  open();
  const auto read = [&](const std::string& unit, int n, double wear) {
    deliver(message(unit, n, wear, 20 * n));
  };
  const auto wear = [](int n) {
    return 24.0 * n + (n > 10 ? 72.0 * (n - 10) : 0) + 3 * (n % 3 - 1);
  };
  for (int n = 1; n <= 10; ++n) {
    read("changes", n, wear(n));
    read("stays", n, 20 * n);
  }
  catch_up();
  EXPECT_EQ(fleet_->unit("changes")->view.doubt, "");
  EXPECT_EQ(fleet_->fleet().doubt, 0U);
  for (int n = 11; n <= 12; ++n) read("changes", n, wear(n));
  catch_up();
  UnitView view = fleet_->unit("changes")->view;
  EXPECT_NE(view.doubt, "");
  EXPECT_FALSE(view.beyond);
  // Where the risk does not call for action, the alarm is the doubt.
  read("stays", 11, 360);
  catch_up();
  view = fleet_->unit("stays")->view;
  EXPECT_EQ(view.alarm, Alarm::doubt);
  EXPECT_LT(view.risk, 0.2);
  EXPECT_THAT(view.doubt, HasSubstr("the last reading, 360 m, lies above the forecast of 220"));
  EXPECT_EQ(fleet_->fleet().doubt + fleet_->fleet().act, 2U);
  EXPECT_THAT(changes_, testing::Contains("stays ok -> doubt"));
  EXPECT_EQ(json_of(view)["alarm"], "doubt");
  EXPECT_EQ(json_of(view)["doubt"], view.doubt);
  const std::string metrics = metrics_text(fleet_->fleet(), {view}, {});
  EXPECT_THAT(metrics, HasSubstr("wearwell_unit_doubt{unit=\"stays\"} 1\n"));
  EXPECT_THAT(metrics, HasSubstr("wearwell_unit_alarm{unit=\"stays\"} 3\n"));
  EXPECT_THAT(metrics, HasSubstr("wearwell_fleet_units{alarm=\"doubt\"} "));
  EXPECT_THAT(fleet_text(*fleet_), HasSubstr("stays: the forecast is in doubt: the last reading"));
  // After a restart all is as before, and known as before.
  const std::string here = bits();
  changes_.clear();
  open();
  catch_up();
  EXPECT_TRUE(bits() == here);
  EXPECT_EQ(fleet_->unit("stays")->view.doubt, view.doubt);
  EXPECT_EQ(fleet_->unit("stays")->view.alarm, Alarm::doubt);
  EXPECT_TRUE(changes_.empty());
  // And from the readings alone.
  store_->save("population", {{"stays", 3, "damaged"}, {"changes", 3, "damaged"}}, 3);
  open();
  catch_up();
  EXPECT_TRUE(bits() == here);
}

// Single readings far off at 18 and 28: evidence is still left of the first as the second comes. Each doubt ends with
// three readings that agree with those before.
TEST_F(Fleets, EndDoubtWithReadingsThatAgree) {
  open();
  const std::map<int, int> off = {{4, 11}, {9, 21}, {10, 11}, {11, 9}, {18, -27}, {28, 35}};
  std::string doubted;
  for (int n = 1; n <= 32; ++n) {
    const auto at = off.find(n);
    deliver(message("a", n, 20 * n + (at == off.end() ? 0 : at->second), 20 * n));
    catch_up();
    doubted += fleet_->unit("a")->view.doubt.empty() ? '.' : 'x';
  }
  EXPECT_EQ(doubted, ".................xxxx......xxx..");
}

TEST_F(Fleets, ActOnALevelBeyondTheThreshold) {
  alarm_.horizon = 1;
  open();
  for (int n = 1; n <= 10; ++n) deliver(message("a", n, 20 * n, 20 * n));
  deliver(message("a", 11, 1008, 220));
  catch_up();
  UnitView view = fleet_->unit("a")->view;
  EXPECT_TRUE(view.beyond);
  EXPECT_EQ(view.alarm, Alarm::act);
  EXPECT_LT(view.risk, 0.01);
  EXPECT_NE(view.doubt, "");
  EXPECT_EQ(json_of(view)["beyond"], true);
  EXPECT_THAT(fleet_text(*fleet_), HasSubstr("a: the last reading is beyond the limit."));
  deliver(message("b", 1, 20, 20));
  catch_up();
  EXPECT_EQ(fleet_->units("", 0, 1)[0].unit, "a");
  for (int n = 12; n <= 40; ++n) deliver(message("a", n, 20 * n, 20 * n));
  catch_up();
  view = fleet_->unit("a")->view;
  EXPECT_FALSE(view.beyond);
  EXPECT_NE(view.alarm, Alarm::act);
}

TEST_F(Fleets, OrderAlarmsByUrgency) {
  EXPECT_EQ(alarm_of_readings(Alarm::ok, false, false), Alarm::ok);
  EXPECT_EQ(alarm_of_readings(Alarm::watch, false, true), Alarm::doubt);
  EXPECT_EQ(alarm_of_readings(Alarm::unknown, false, true), Alarm::doubt);
  EXPECT_EQ(alarm_of_readings(Alarm::act, false, true), Alarm::act);
  EXPECT_EQ(alarm_of_readings(Alarm::ok, true, true), Alarm::act);
  for (const Alarm each : {Alarm::ok, Alarm::watch, Alarm::act, Alarm::doubt, Alarm::unknown})
    EXPECT_EQ(alarm_named(name(each)), each);
}

TEST(Risk, IsAProbability) {
  prognosis::Forecast forecast;
  const double lives[] = {1, 2, 3};
  const double weights[] = {0.1, 0.7, 0.2};
  forecast.remaining = prognosis::WeightedLives(lives, weights);
  for (double passed = 0; passed <= 1 + 1e-14; passed += 0.001) {
    forecast.passed = passed;
    EXPECT_LE(risk_within(forecast, 100), 1);
    EXPECT_GE(risk_within(forecast, 0), 0);
  }
  forecast.passed = 1.0000000000000082;
  forecast.remaining = {};
  EXPECT_EQ(risk_within(forecast, 1), 1);
}

TEST_F(Fleets, RefuseWhatIsNoReading) {
  open();
  const auto problem = [&](const std::string& payload) {
    const Delivery delivery = deliver(payload);
    EXPECT_TRUE(delivery.stored);
    EXPECT_EQ(delivery.refused, 1U);
    return delivery.problem;
  };
  EXPECT_EQ(problem(R"({"machine": "a", "n": 1, "time": 3})"), "unit 'a', n 1: wear is missing");
  EXPECT_EQ(problem(R"({"machine": "a", "n": 1, "wear": 3})"), "unit 'a', n 1: time is missing");
  EXPECT_EQ(problem(R"({"machine": "a", "n": 1.5, "wear": 3, "time": 3})"),
            "unit 'a', n 1.5: n must be a whole number");
  EXPECT_EQ(problem(R"({"machine": "a", "n": 1, "wear": "1,5", "time": 3})"),
            "unit 'a', n 1: wear is '1,5', but must be a number");
  EXPECT_EQ(problem(R"({"machine": "a", "n": 1, "wear": true, "time": 3})"),
            "unit 'a', n 1: wear must be a number");
  EXPECT_THAT(problem(R"({"machine": "a\u0007", "n": 1, "wear": 1, "time": 3})"),
              HasSubstr("must be a name"));
  EXPECT_THAT(problem(R"({"n": 1, "wear": 1, "time": 3})"), HasSubstr("machine is missing"));
  EXPECT_EQ(deliver(R"({"machine": 12, "n": 1, "wear": "1.5", "time": 3})").readings, 1U);
  catch_up();
  EXPECT_EQ(fleet_->units("", 0, 1)[0].unit, "12");
}

TEST_F(Fleets, LetInSoManyUnits) {
  most_units_ = 2;
  open();
  deliver(message("a", 1, 1));
  deliver(message("b", 1, 1));
  EXPECT_THAT(deliver(message("c", 1, 1)).problem, HasSubstr("limits.units"));
  EXPECT_EQ(deliver(message("a", 2, 1)).readings, 1U);
}

TEST_F(Fleets, GoOnFromAnyMomentToTheSameBits) {
  Rng rng(5, 1);
  std::vector<std::string> messages;
  for (int n = 1; n <= 150; ++n) {
    for (const char* unit : {"a", "b", "c"})
      messages.push_back(message(unit, n, n * rng.uniform(0.5, 1.5)));
  }
  for (std::size_t i = messages.size(); i-- > 1;)
    if (rng.uniform() < 0.3)
      std::swap(messages[i], messages[i - rng.bits() % std::min<std::size_t>(i, 9)]);
  const auto feed = [&](const std::function<void()>& between) {
    for (const std::string& each : messages) {
      deliver(each);
      between();
    }
    catch_up();
    return bits();
  };
  open();
  const std::string whole = feed([] {});
  std::filesystem::remove_all(folder());
  std::filesystem::create_directory(folder());
  threads_ = 1;
  open();
  // Ended at any moment: sometimes with its states kept, sometimes with the readings alone; and messages come again.
  const std::string cut = feed([&] {
    const double what = rng.uniform();
    if (what < 0.2) fleet_->apply();
    if (what < 0.1) fleet_->save();
    if (what < 0.05) open();
    if (what > 0.9) deliver(messages[rng.bits() % 20]);
  });
  EXPECT_TRUE(cut == whole);
  // And with other states thrown away, from the readings.
  store_->save("population", {{"b", 3, "damaged"}}, 3);
  open();
  catch_up();
  EXPECT_TRUE(bits() == whole);
}

// Asked to end, a monitor leaves to the next start what takes too long.
TEST_F(Fleets, EndBeforeAllReadingsAreProcessed) {
  open();
  const auto place = [&] { return static_cast<std::size_t>(fleet_->place()); };
  for (std::size_t n = 1; n <= Fleet::small_piece + 20; ++n)
    deliver(message(n % 2 == 1 ? "a" : "b", static_cast<int>(n), 0.1 * static_cast<double>(n)));
  int asked = 0;
  EXPECT_FALSE(fleet_->finish([&] { return asked++ > 0; }));
  EXPECT_EQ(place(), Fleet::small_piece);
  EXPECT_EQ(store_->all_up_to("population"), fleet_->place());
  EXPECT_TRUE(fleet_->finish([] { return false; }));
  EXPECT_EQ(place(), Fleet::small_piece + 20);
  const std::string in_two = bits();
  store_->save("population", {{"a", 3, "damaged"}, {"b", 3, "damaged"}}, 3);
  open();
  catch_up();
  EXPECT_TRUE(bits() == in_two);
}

TEST_F(Fleets, RaiseAlarmsWithHysteresis) {
  EXPECT_EQ(alarm_at(0.051, Alarm::ok, alarm_), Alarm::watch);
  EXPECT_EQ(alarm_at(0.041, Alarm::ok, alarm_), Alarm::ok);
  EXPECT_EQ(alarm_at(0.041, Alarm::watch, alarm_), Alarm::watch);
  EXPECT_EQ(alarm_at(0.039, Alarm::watch, alarm_), Alarm::ok);
  EXPECT_EQ(alarm_at(0.17, Alarm::act, alarm_), Alarm::act);
  EXPECT_EQ(alarm_at(0.15, Alarm::act, alarm_), Alarm::watch);
  EXPECT_EQ(alarm_at(0.17, Alarm::watch, alarm_), Alarm::watch);
  EXPECT_EQ(alarm_at(0.041, Alarm::act, alarm_), Alarm::watch);
  EXPECT_EQ(alarm_at(0.5, Alarm::ok, alarm_), Alarm::act);
  open();
  deliver(message("a", 1, 1));
  catch_up();
  deliver(message("a", 10, 450));
  catch_up();
  EXPECT_THAT(changes_, ElementsAre("a ok -> act"));
  open();
  fleet_->refresh(true);
  EXPECT_THAT(changes_, ElementsAre("a ok -> act"));  // which is known
  EXPECT_EQ(store_->alarms().size(), 1U);
}

TEST_F(Fleets, DoNotKnowOfASilentUnit) {
  alarm_.silence = 0.3;
  open();
  deliver(message("a", 1, 1));
  catch_up();
  EXPECT_EQ(fleet_->units("", 0, 1)[0].alarm, Alarm::ok);
  std::this_thread::sleep_for(std::chrono::milliseconds(600));
  fleet_->refresh();
  EXPECT_EQ(fleet_->units("", 0, 1)[0].alarm, Alarm::unknown);
  EXPECT_EQ(fleet_->fleet().unknown, 1U);
  deliver(message("a", 2, 2));
  catch_up();
  EXPECT_EQ(fleet_->units("", 0, 1)[0].alarm, Alarm::ok);
  EXPECT_THAT(changes_, ElementsAre("a ok -> unknown", "a unknown -> ok"));
  // What was last heard of before the program began is as old as it is.
  std::this_thread::sleep_for(std::chrono::milliseconds(600));
  open();
  fleet_->refresh(true);
  EXPECT_EQ(fleet_->units("", 0, 1)[0].alarm, Alarm::unknown);
}

// A sender's clock that is ahead: its reading counts, is told, and makes nothing younger than it is.
TEST_F(Fleets, TellOfAReadingFromTheFuture) {
  open();
  const std::int64_t now = 1'795'360'000'000, day = 86'400'000;
  store_->add(
      {{0, "a", 1, now - 1000, now, {1, 3600}, {}}, {0, "a", 2, now + day, now, {2, 7200}, {}}});
  catch_up();
  const UnitView view = fleet_->units("", 0, 1)[0];
  EXPECT_EQ(view.at, 2);
  EXPECT_EQ(view.quality.readings, 2U);
  EXPECT_EQ(view.last_reading_ms, now);
  EXPECT_THAT(view.quality.last_problem, HasSubstr("more than an hour ahead"));
  // What lay in the store a moment ago has not waited since then, whatever the machine's clock said.
  store_->add({{0, "a", 3, now, now - 1000 * day, {3, 10800}, {}}});
  EXPECT_GT(fleet_->apply(), 0U);
  EXPECT_LT(fleet_->fleet().lag_ms, 60'000);
}

TEST(Moments, GrowSlowly) {
  int kept = 0;
  for (std::uint64_t n = 1; n <= 1'000'000; ++n) kept += is_kept_moment(n);
  EXPECT_TRUE(is_kept_moment(1) && is_kept_moment(12));
  EXPECT_LT(kept, 120);
}

/// A store that fails when it is told to, before or after it has done what it was asked.
class FailingStore : public Store {
 public:
  enum class Fails { never, before, after };
  explicit FailingStore(std::unique_ptr<Store> store) : store_(std::move(store)) {}
  Fails adds = Fails::never;
  bool reads = true, fails_events = false, fails_log = false;

  std::vector<Kept> add(const std::vector<StoredReading>& readings) override {
    if (adds == Fails::before) throw StoreError("the disk is full");
    auto kept = store_->add(readings);
    if (adds == Fails::after) throw StoreError("the connection was lost");
    return kept;
  }
  std::vector<StoredReading> after(std::int64_t place, std::size_t count) override {
    look();
    return store_->after(place, count);
  }
  void of_unit(const std::string& unit, std::int64_t after, std::int64_t last,
               const std::function<void(const StoredReading&)>& visit) override {
    look();
    if (fails_histories && last < INT64_MAX && after == 0) {
      fails_histories = false;
      throw StoreError("the connection was lost");
    }
    store_->of_unit(unit, after, last, visit);
  }
  std::optional<StoredReading> reading(const std::string& unit, std::int64_t key) override {
    look();
    return store_->reading(unit, key);
  }
  std::uint64_t count() override { return store_->count(); }
  bool has_unit(const std::string& unit) override {
    look();
    return store_->has_unit(unit);
  }
  std::vector<std::string> units() override { return store_->units(); }
  std::int64_t last_place() override { return store_->last_place(); }
  std::vector<Kept> add_events(const std::vector<UnitEvent>& events) override {
    if (adds == Fails::before || fails_events) throw StoreError("the disk is full");
    auto kept = store_->add_events(events);
    if (adds == Fails::after) throw StoreError("the connection was lost");
    return kept;
  }
  std::vector<UnitEvent> events_after(std::int64_t number) override {
    look();
    return store_->events_after(number);
  }
  std::vector<UnitEvent> events_of(const std::string& unit) override {
    look();
    return store_->events_of(unit);
  }
  std::vector<StoredFit> fits() override { return store_->fits(); }
  void begin_fit(const StoredFit& fit, const std::vector<MovedForecast>& moved) override {
    store_->begin_fit(fit, moved);
  }
  std::vector<MovedForecast> moved(std::int64_t fit) override { return store_->moved(fit); }
  std::map<std::string, SentAlarm> sent_alarms() override { return store_->sent_alarms(); }
  void note_sent(const std::string& unit, const SentAlarm& sent, std::int64_t time_ms) override {
    store_->note_sent(unit, sent, time_ms);
  }
  void save(const std::string& population, const std::vector<Checkpoint>& states,
            std::int64_t all_up_to) override {
    store_->save(population, states, all_up_to);
  }
  std::vector<Checkpoint> states(const std::string& p) override { return store_->states(p); }
  std::int64_t all_up_to(const std::string& p) override { return store_->all_up_to(p); }
  void log(const std::vector<AlarmChange>& changes) override {
    if (fails_log) throw StoreError("the disk is full");
    store_->log(changes);
  }
  std::vector<AlarmChange> alarms() override { return store_->alarms(); }
  bool remove(const Removal& removal) override {
    if (adds == Fails::before) throw StoreError("the disk is full");
    const bool removed = store_->remove(removal);
    if (adds == Fails::after) throw StoreError("the connection was lost");
    return removed;
  }
  std::map<std::string, RemovedReadings> removed() override { return store_->removed(); }
  std::uint64_t remove_forecasts(std::int64_t before_ms) override {
    return store_->remove_forecasts(before_ms);
  }
  void note_file(const std::string& file, std::int64_t bytes) override {
    store_->note_file(file, bytes);
  }
  std::map<std::string, std::int64_t> files() override { return store_->files(); }

  bool fails_histories = false;

 private:
  void look() const {
    if (!reads) throw StoreError("the connection was lost");
  }
  std::unique_ptr<Store> store_;
};

class FailingFleets : public FleetRig {
 protected:
  std::unique_ptr<Store> make_store() override {
    auto store = std::make_unique<FailingStore>(FleetRig::make_store());
    failing_ = store.get();
    return store;
  }
  FailingStore* failing_ = nullptr;
};

// Readings that are stored before their events cannot be are counted, once.
TEST_F(FailingFleets, CountReadingsWhoseEventsWait) {
  source_.mapping = plain_mapping(tracker_, false);
  source_.mapping.unit = "machine";
  source_.mapping.sequence = "n";
  open();
  const std::string both =
      message("a", 1, 10, 10) + "\n" +
      R"({"machine": "a", "event": "replaced", "by": "B", "n": 2, "time": 10})";
  failing_->fails_events = true;
  EXPECT_FALSE(deliver(both).stored);
  catch_up();
  EXPECT_EQ(fleet_->fleet().stored, 1U);
  failing_->fails_events = false;
  const Delivery again = deliver(both);
  EXPECT_TRUE(again.stored);
  EXPECT_EQ(again.repeated, 1U);
  EXPECT_EQ(again.events, 1U);
  catch_up();
  EXPECT_EQ(fleet_->fleet().stored, 1U);
  EXPECT_EQ(store_->count(), 1U);
}

// What a fleet could not store of its alarms, the one that takes its place stores.
TEST_F(FailingFleets, HandOverAlarmsThatAreNotStored) {
  open();
  for (int n = 1; n <= 20; ++n) deliver(message("a", n, 49.0 * n, 49 * n));
  while (fleet_->apply() > 0) {
  }
  failing_->fails_log = true;
  EXPECT_THROW(fleet_->refresh(true), StoreError);
  const UnitView before = *fleet_->view("a");
  ASSERT_EQ(before.alarm, Alarm::act);
  FleetSettings settings;
  settings.population = "another";
  settings.alarm = alarm_;
  settings.beside = true;
  Fleet next(tracker_, *store_, *tally_, quiet_, settings);
  while (next.apply() > 0) {
  }
  next.refresh(true);
  next.take_over(*fleet_);
  failing_->fails_log = false;
  EXPECT_TRUE(store_->alarms().empty());
  next.refresh();
  ASSERT_EQ(store_->alarms().size(), 1U);
  EXPECT_EQ(store_->alarms()[0].alarm, Alarm::act);
  EXPECT_EQ(store_->alarms()[0].time_ms, before.alarm_ms);
  fleet_->refresh();
  EXPECT_EQ(store_->alarms().size(), 1U);
}

TEST_F(FailingFleets, LoseNothing) {
  open();
  for (int n = 1; n <= 120; ++n) {
    using Fails = FailingStore::Fails;
    const std::string payload = message("a", n, n) + "\n" + message("b", n, 2 * n);
    failing_->adds = n % 7 == 3 ? Fails::before : n % 7 == 5 ? Fails::after : Fails::never;
    const Delivery delivery = deliver(payload);
    EXPECT_EQ(delivery.stored, failing_->adds == Fails::never);
    failing_->adds = Fails::never;
    if (!delivery.stored) {
      EXPECT_TRUE(deliver(payload).stored);
    }
    failing_->reads = n % 5 != 0;
    failing_->fails_histories = n % 11 == 0;
    try {
      fleet_->apply();
    } catch (const StoreError&) {
    }
    failing_->reads = true;
  }
  failing_->fails_histories = false;
  catch_up();
  EXPECT_EQ(store_->count(), 240U);
  const std::string here = bits();
  for (const UnitView& each : fleet_->units("", 0, 2)) EXPECT_EQ(each.quality.readings, 120U);
  // The same from the readings alone.
  store_->save("another", {}, 0);
  store_->save("population", {{"a", 0, "damaged"}, {"b", 0, "damaged"}}, 0);
  open();
  catch_up();
  EXPECT_TRUE(bits() == here);
}

}  // namespace
}  // namespace wearwell::monitor
