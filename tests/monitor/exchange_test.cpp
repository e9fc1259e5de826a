// Another fit takes the place of the running one: forecasts move, and nothing else does.
#include <gmock/gmock.h>

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "monitor/fleet_rig.h"
#include "support/disk_content.h"
#include "wearwell/base/error.h"
#include "wearwell/base/rng.h"
#include "wearwell/base/sha1.h"
#include "wearwell/monitor/current_fleet.h"
#include "wearwell/monitor/fit_exchange.h"
#include "wearwell/monitor/learned_readings.h"
#include "wearwell/monitor/monitor_signals.h"

namespace wearwell::monitor {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class Exchanges : public FleetRig {
 protected:
  /// A fleet of another fit, beside the running one.
  std::unique_ptr<Fleet> beside(const prognosis::Tracker& tracker) {
    FleetSettings settings;
    settings.population = "another";
    settings.alarm = alarm_;
    settings.threads = threads_;
    settings.beside = true;
    settings.start = FleetSettings::Start{fleet_->fleet().started_ms,
                                          fleet_->fleet().stored - tally_->total().stored};
    settings.on_alarm = [this](const AlarmChange& change, Alarm before, const UnitView&) {
      later_.push_back(fmt::format("{} {} -> {}", change.unit, name(before), name(change.alarm)));
    };
    auto fleet = std::make_unique<Fleet>(tracker, *store_, tally_ref(), quiet_, settings);
    while (fleet->apply() > 0) {
    }
    fleet->refresh(true);
    return fleet;
  }
  Tally& tally_ref() { return *tally_; }
  std::vector<std::string> later_;
  const GrowthTracker faster_{4};
};

// The later fit expects four times the rate: a unit without many readings is in danger by it, and one whose readings say
// enough is not.
TEST_F(Exchanges, MoveForecastsAndAlarms) {
  open();
  deliver(message("young", 1, 0.001, 0.001));
  for (int n = 1; n <= 40; ++n) deliver(message("known", n, 10.0 * n, 10 * n));
  catch_up();
  changes_.clear();
  const UnitView before = *fleet_->view("young");
  const auto next = beside(faster_);
  const std::vector<MovedForecast> moved = moved_forecasts(*fleet_, *next);
  ASSERT_EQ(moved.size(), 2U);
  EXPECT_EQ(moved[0].unit, "young");
  EXPECT_EQ(moved[0].before.remaining.q50, before.remaining.q50);
  EXPECT_EQ(moved[0].after.remaining.q50, next->view("young")->remaining.q50);
  EXPECT_NEAR(moved[0].after.remaining.q50 / moved[0].before.remaining.q50, 0.25, 0.02);
  EXPECT_NEAR(change_of(moved[1]), 0, 0.01);
  EXPECT_EQ(moved[0].axis_unit, "h");
  // Until it takes over, it neither says nor stores anything.
  EXPECT_THAT(later_, IsEmpty());
  const std::size_t stored = store_->alarms().size();
  store_->begin_fit({0, "another", 5, 3, true}, moved);
  next->set_moved(5, moved);
  next->take_over(*fleet_);
  next->refresh();
  EXPECT_EQ(store_->alarms().size(), stored + later_.size());
  EXPECT_EQ(next->unit("young")->moved->before.remaining.q95, before.remaining.q95);
  EXPECT_EQ(next->fleet().stored, fleet_->fleet().stored);
  EXPECT_EQ(next->fleet().started_ms, fleet_->fleet().started_ms);
  EXPECT_EQ(next->fleet().fit.since_ms, 5);
  const auto kept = store_->moved(store_->fits().back().number);
  ASSERT_EQ(kept.size(), 2U);
  EXPECT_EQ(kept[1].unit, "young");
  EXPECT_EQ(content_of(kept[1]), content_of(moved[0]));
}

// An alarm that both fits call for is neither reported nor begun again, and stays acknowledged.
TEST_F(Exchanges, KeepAlarmsThatStay) {
  source_.mapping = plain_mapping(tracker_, false);
  source_.mapping.unit = "machine";
  source_.mapping.sequence = "n";
  open();
  for (int n = 1; n <= 20; ++n) deliver(message("a", n, 49.0 * n, 49 * n));
  catch_up();
  const UnitView before = *fleet_->view("a");
  ASSERT_EQ(before.alarm, Alarm::act);
  ASSERT_GT(before.alarm_ms, 0);
  EXPECT_EQ(before.acknowledged_by, "");
  const auto acknowledge = [&](std::int64_t since) {
    return deliver(fmt::format(
        R"({{"machine": "a", "event": "acknowledged", "by": "A. Smith", "alarm_ms": {}}})", since));
  };
  EXPECT_EQ(acknowledge(before.alarm_ms - 1).events, 1U);  // of an earlier alarm
  catch_up();
  EXPECT_EQ(fleet_->view("a")->acknowledged_by, "");
  EXPECT_EQ(acknowledge(before.alarm_ms).events, 1U);
  EXPECT_EQ(acknowledge(before.alarm_ms).repeated, 1U);
  catch_up();
  EXPECT_EQ(fleet_->view("a")->acknowledged_by, "A. Smith");
  EXPECT_EQ(fleet_->view("a")->quality.readings, 20U);
  const auto next = beside(faster_);
  next->take_over(*fleet_);
  EXPECT_THAT(later_, IsEmpty());
  EXPECT_EQ(next->view("a")->alarm_ms, before.alarm_ms);
  EXPECT_EQ(next->view("a")->acknowledged_by, "A. Smith");
  // Also after a restart; and a cancelled one does not count.
  const std::string state = bits();
  open();
  catch_up();
  EXPECT_EQ(fleet_->view("a")->acknowledged_by, "A. Smith");
  EXPECT_TRUE(bits() == state);
  deliver(R"({"machine": "a", "event": "cancelled", "by": "B", "number": 2})");
  catch_up();
  EXPECT_EQ(fleet_->view("a")->acknowledged_by, "");
}

TEST_F(Exchanges, AcknowledgementsNameTheirAlarm) {
  source_.mapping = plain_mapping(tracker_, false);
  source_.mapping.unit = "machine";
  source_.mapping.sequence = "n";
  open();
  deliver(message("a", 1, 10, 10));
  EXPECT_THAT(deliver(R"({"machine": "a", "event": "acknowledged", "by": "A"})").problem,
              HasSubstr("alarm_ms must be a whole number"));
  EXPECT_THAT(deliver(R"({"machine": "a", "event": "acknowledged", "alarm_ms": 5})").problem,
              HasSubstr("by is missing"));
  // It does not make a unit.
  const Delivery none =
      deliver(R"({"machine": "b", "event": "acknowledged", "by": "A", "alarm_ms": 5})");
  EXPECT_THAT(none.problem, HasSubstr("acknowledged: 'b' is not a unit"));
  EXPECT_TRUE(none.unknown_unit);
  EXPECT_EQ(none.events, 0U);
  EXPECT_TRUE(store_->events_of("b").empty());
  EXPECT_FALSE(tally_ref().knows("b"));
  EXPECT_EQ(
      deliver(R"({"machine": "a", "event": "acknowledged", "by": "A", "alarm_ms": 5})").events, 1U);
}

// Events among readings need their own permission; the readings beside them are stored.
TEST_F(Exchanges, EventsAmongReadingsMayBeRefused) {
  source_.mapping = plain_mapping(tracker_, false);
  source_.mapping.unit = "machine";
  source_.mapping.sequence = "n";
  open();
  const Message message{
      "", Exchanges::message("a", 1, 10, 10) +
              "\n{\"machine\": \"a\", \"event\": \"withdrawn\", \"by\": \"B\", \"n\": 1}"};
  const Delivery refused = intake_->deliver(source_, std::span(&message, 1), "it is an event");
  EXPECT_EQ(refused.readings, 1U);
  EXPECT_EQ(refused.events, 0U);
  EXPECT_EQ(refused.refused, 1U);
  EXPECT_EQ(refused.problem, "unit 'a', n 1: it is an event");
  const Message of_file{"", "{\"machine\": \"a\", \"n\": 7}", Form::any, "in/a.jsonl"};
  EXPECT_THAT(intake_->deliver(source_, std::span(&of_file, 1)).problem,
              testing::StartsWith("in/a.jsonl: unit 'a', n 7: "));
  EXPECT_TRUE(store_->events_of("a").empty());
  EXPECT_EQ(intake_->deliver(source_, std::span(&message, 1)).events, 1U);
}

// A failed part was not in use before the start either: that is not news.
TEST_F(Exchanges, StartsReportNoOldNews) {
  source_.mapping = plain_mapping(tracker_, false);
  source_.mapping.unit = "machine";
  source_.mapping.sequence = "n";
  open();
  for (int n = 1; n <= 20; ++n) deliver(message("a", n, 49.0 * n, 49 * n));
  catch_up();
  deliver(R"({"machine": "a", "event": "failed", "by": "B", "n": 20, "time": 980})");
  catch_up();
  fleet_->save();
  for (int start = 0; start < 2; ++start) {
    changes_.clear();
    open();
    catch_up();
    EXPECT_EQ(fleet_->view("a")->alarm, Alarm::unknown);
    EXPECT_THAT(changes_, IsEmpty());
  }
}

TEST_F(Exchanges, VersionsGoOn) {
  open();
  for (int i = 0; i < 5; ++i) deliver(message(fmt::format("m{}", i), 1, 10, 10));
  catch_up();
  const std::shared_ptr<Fleet> first = std::move(fleet_);
  fleet_ = make_fleet();
  CurrentFleet readers(first);
  const std::uint64_t before = readers.version();
  EXPECT_THAT(readers.changed_since(before), IsEmpty());
  const std::shared_ptr<Fleet> next = beside(faster_);
  readers.exchange(next);
  EXPECT_GT(readers.version(), before);
  EXPECT_EQ(readers.changed_since(before).size(), 5U);
  const std::uint64_t now = readers.version();
  EXPECT_THAT(readers.changed_since(now), IsEmpty());
  deliver(message("m3", 2, 20, 20));
  while (next->apply() > 0) {
  }
  next->refresh(true);
  EXPECT_THAT(readers.changed_since(now), ElementsAre("m3"));
}

TEST(Misfits, AreNamed) {
  const auto of = [](GrowthTracker tracker) {
    return Population{std::make_shared<const GrowthTracker>(std::move(tracker)), "x", true, 0};
  };
  const Population present = of(GrowthTracker(1));
  EXPECT_EQ(misfit(present, of(GrowthTracker(2)), {"only"}), "");
  EXPECT_THAT(misfit(present, of(GrowthTracker(1, 900)), {}),
              HasSubstr("threshold is wear from below = 900 m, not wear from below = 1000 m"));
  EXPECT_THAT(misfit(present, of(GrowthTracker(1, 1000, "only")), {"a", "only"}),
              HasSubstr("'only' is not a unit of this study"));
  Population doubtful = of(GrowthTracker(2));
  doubtful.trusted = false;
  EXPECT_THAT(misfit(present, doubtful, {}), HasSubstr("not trusted"));
}

// A fit that has learned the readings of the store would count them twice.
TEST(Misfits, HaveLearnedReadingsOfTheStore) {
  const auto of = [](std::map<std::string, double> study) {
    auto tracker = std::make_shared<GrowthTracker>(1);
    tracker->set_study(std::move(study));
    return Population{std::move(tracker), "x", true, 0};
  };
  const Population present = of({{"a", 100}, {"lab", 50}});
  EXPECT_EQ(misfit(present, of({{"a", 100}, {"lab", 50}}), {"a", "b"}), "");
  // Readings of units that are not in the store.
  EXPECT_EQ(misfit(present, of({{"a", 100}, {"lab", 70}, {"lab 2", 9}}), {"a", "b"}), "");
  EXPECT_THAT(misfit(present, of({{"a", 100}, {"b", 7}}), {"a", "b"}),
              HasSubstr("it has learned readings of this store, of machine 'b'"));
  EXPECT_THAT(misfit(present, of({{"a", 120}}), {"a", "b"}), HasSubstr("machine 'a'"));
  EXPECT_THAT(misfit(present, of({{"a", 100}, {"b (part 2)", 7}}), {"a", "b"}),
              HasSubstr("machine 'b (part 2)'"));
  EXPECT_EQ(misfit(present, of({{"a", 100}, {"b (part 2)", 7}}), {"a"}), "");
}

// At a start the earlier fit is not there: the last reading of the study is one of the store.
TEST_F(Exchanges, StartsNoticeLearnedReadings) {
  source_.mapping = plain_mapping(tracker_, false);
  source_.mapping.unit = "machine";
  source_.mapping.sequence = "n";
  open();
  for (int n = 1; n <= 3; ++n) deliver(message("a", n, 10 * n, 10 * n));
  deliver(R"({"machine": "a", "event": "replaced", "by": "B", "n": 3, "time": 20})");
  const auto learned = [&](std::map<std::string, double> study) {
    GrowthTracker tracker(1);
    tracker.set_study(std::move(study));
    return learned_from(*store_, tracker);
  };
  EXPECT_EQ(learned({{"a", 15}, {"b", 10}, {"b (part 2)", 10}}), "");
  EXPECT_THAT(learned({{"a", 20 * (1 + 1e-12)}}), HasSubstr("machine 'a'"));
  EXPECT_EQ(learned({{"a", 30}}), "");  // that reading is of the second part, after 10 h
  EXPECT_THAT(learned({{"a (part 2)", 10}}), HasSubstr("machine 'a (part 2)'"));
}

TEST(MovedForecasts, OfUnknownOnesDoNotComeFirst) {
  MovedForecast unknown{"a", 0, "h", {}, {}}, known{"b", 0, "h", {}, {}};
  known.before = {Alarm::ok, true, {1, 2, 3}, 0};
  known.after = {Alarm::ok, true, {1, 2.1, 3}, 0};
  std::vector<MovedForecast> moved = {unknown, known};
  sort_by_change(moved);
  EXPECT_EQ(moved[0].unit, "b");
  EXPECT_EQ(change_of(unknown), 0);
  unknown.after = known.after;
  EXPECT_TRUE(std::isinf(change_of(unknown)));
}

// Two fleets are brought to the same reading, whatever has arrived meanwhile.
TEST_F(Exchanges, CompareForecastsOfTheSameReadings) {
  open();
  for (int n = 1; n <= 5; ++n) deliver(message("a", n, n, n));
  const auto next = beside(faster_);
  const std::int64_t last = next->place();
  for (int n = 6; n <= 9; ++n) deliver(message("a", n, n, n));
  while (fleet_->place() < last) ASSERT_GT(fleet_->apply(last), 0U);
  EXPECT_EQ(fleet_->apply(last), 0U);
  EXPECT_EQ(fleet_->place(), last);
  fleet_->refresh(true);
  EXPECT_EQ(fleet_->view("a")->quality.readings, 5U);
  EXPECT_EQ(next->view("a")->quality.readings, 5U);
  catch_up();
  EXPECT_EQ(fleet_->view("a")->quality.readings, 9U);
}

class ResultFolders : public ScratchTest {
 protected:
  void put(const std::string& state, const std::string& listed) {
    std::ofstream(folder() / "state.bin") << state;
    std::ofstream(folder() / "results.sha1") << sha1_of(listed) << "  state.bin\n";
  }
};

TEST_F(ResultFolders, AreWatched) {
  put("one", "one");
  ResultWatch watch(folder());
  EXPECT_FALSE(watch.changed());
  put("another", "another");
  EXPECT_FALSE(watch.changed());  // perhaps it is still being written
  EXPECT_TRUE(watch.changed());
  EXPECT_FALSE(watch.changed());
  std::filesystem::remove(folder() / "state.bin");
  EXPECT_FALSE(watch.changed());
  EXPECT_TRUE(watch.changed());
  EXPECT_EQ(written_ms(folder()), 0);
}

TEST_F(ResultFolders, AreWholeOrNot) {
  put("one", "one");
  EXPECT_EQ(incomplete_result(folder()), "");
  put("two", "one");
  EXPECT_THAT(incomplete_result(folder()), HasSubstr("half written: state.bin is not the one"));
  std::ofstream(folder() / "results.sha1") << sha1_of("x") << "  summary.json\n";
  EXPECT_THAT(incomplete_result(folder()), HasSubstr("does not list state.bin"));
  std::filesystem::remove(folder() / "results.sha1");
  EXPECT_EQ(incomplete_result(folder()), "");
  EXPECT_EQ(incomplete_result(folder() / "state.bin"), "");
}

// The whole way from a folder to a fleet that is ready; what does not fit never gets there.
TEST_F(Exchanges, AreMadeReadyBesideTheRunningFleet) {
  open();
  deliver(message("a", 1, 10, 10));
  catch_up();
  const auto result = folder() / "result";
  std::filesystem::create_directories(result);
  const auto put = [&](const std::string& content) {
    std::ofstream(result / "new") << content;
    std::filesystem::rename(result / "new", result / "state.bin");
  };
  put("first");
  std::atomic<int> read = 0, woken = 0;
  const auto reader = [&]() -> Population {
    ++read;
    std::ifstream file(result / "state.bin");
    std::string content;
    std::getline(file, content);
    if (content == "broken") throw InputError("state.bin is damaged");
    const double limit = content == "other" ? 900 : 1000;
    auto tracker = std::make_shared<GrowthTracker>(4, limit);
    if (content == "blind") tracker->set_counted(false);
    if (content == "learned") tracker->set_study({{"a", 10}});
    return {std::move(tracker), content, content != "doubtful", 7};
  };
  FitExchange exchange(
      {result, reader}, {std::make_shared<const GrowthTracker>(), "first", true, 1}, *fleet_,
      [&](const Population& population) -> std::shared_ptr<Fleet> {
        FleetSettings settings;
        settings.population = population.fingerprint;
        settings.beside = true;
        static std::vector<std::shared_ptr<const prognosis::Tracker>> alive;
        alive.push_back(population.tracker);
        return std::make_shared<Fleet>(*population.tracker, *store_, *tally_, quiet_, settings);
      },
      quiet_, [&] { ++woken; });
  const auto eventually = [](const auto& holds) {
    for (int i = 0; i < 400 && !holds(); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(25));
    return holds();
  };
  for (const char* content : {"broken", "other", "doubtful", "blind", "learned"}) {
    const int before = read;
    put(content);
    ASSERT_TRUE(eventually([&] { return read > before; })) << content;
  }
  const int before = read;
  exchange.request();  // asks, although nothing has changed
  ASSERT_TRUE(eventually([&] { return read > before; }));
  EXPECT_EQ(woken, 0);
  EXPECT_FALSE(exchange.ready());
  put("second");
  ASSERT_TRUE(eventually([&] { return woken > 0; }));
  const auto ready = exchange.ready();
  ASSERT_TRUE(ready);
  EXPECT_EQ(ready->population.fingerprint, "second");
  EXPECT_EQ(ready->fleet->fleet().units, 1U);
  EXPECT_FALSE(exchange.ready());
}

// A reload while the result is read is one when the monitor has begun.
TEST(MonitorSignalsTest, KnowOfAnEarlierHangup) {
  const HangupNote note;
  std::raise(SIGHUP);
  MonitorSignals signals;
  EXPECT_TRUE(signals.reload());
  EXPECT_FALSE(signals.reload());
  EXPECT_FALSE(signals.ends());
}

/// A whole monitor in a process of its own, over a folder of files and a folder of results.
class RunningMonitors : public FleetRig {
 protected:
  MonitorConfig config(const std::string& store) {
    MonitorConfig config;
    config.folder = folder();
    config.store = store;
    config.sequence = true;
    config.alarm = alarm_;
    SourceSettings files = source();
    files.kind = SourceKind::folder;
    files.folder = folder() / "incoming";
    files.mapping.event = "event";
    files.mapping.watched = prognosis::watched_columns(GrowthTracker());
    config.sources = {files};
    return config;
  }
  std::filesystem::path result() const { return folder() / "result"; }
  /// "2" is a fit with a mean rate of 2 m/h, "2 10" one whose study has m0 up to 10 h.
  void put_result(int rate) { put_result(std::to_string(rate)); }
  void put_result(const std::string& content) {
    std::filesystem::create_directories(result());
    write("result/new.bin", content);
    write("result/new.sha1", sha1_of(content) + "  state.bin\n");
    // One after the other: a monitor may look in between.
    std::filesystem::rename(result() / "new.bin", result() / "state.bin");
    std::filesystem::rename(result() / "new.sha1", result() / "results.sha1");
  }
  ResultSource source_of_results() const {
    return {result(), [file = result() / "state.bin"] {
              std::ifstream stream(file);
              int rate = 0;
              stream >> rate;
              if (!stream) throw InputError("state.bin is damaged");
              auto tracker = std::make_shared<GrowthTracker>(rate);
              double hours = 0;
              if (stream >> hours) tracker->set_study({{"m0", hours}});
              return Population{std::move(tracker), "fit-" + std::to_string(rate), true, 0};
            }};
  }
  pid_t start(const std::string& store, bool once = false) {
    const MonitorConfig own = config(store);
    const ResultSource from = source_of_results();
    const std::string log = (folder() / "log").string();
    const pid_t child = fork();
    if (child != 0) return child;
    if (!std::freopen(log.c_str(), "a", stderr)) _exit(4);
    try {
      run_monitor(
          own, from.read(), from, {once, 1}, [](const FleetReader&, const std::string&) {},
          [](const FleetReader&) {});
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%s\n", error.what());
      std::fflush(stderr);
      _exit(2);
    }
    _exit(0);
  }
  static int end(pid_t child, int signal) {
    if (signal) kill(child, signal);
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  template <class Holds>
  static bool eventually(const Holds& holds) {
    for (int i = 0; i < 1200; ++i) {
      if (holds()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(25));
    }
    return false;
  }
  std::unique_ptr<Store> look(const std::string& store) {
    return open_store(store, folder(), columns(), Access::read);
  }
  /// 0 while it cannot be read.
  std::uint64_t count(const std::string& store) {
    try {
      return look(store)->count();
    } catch (const std::exception&) {
      return 0;
    }
  }
  std::string population(const std::string& store) {
    try {
      const auto fits = look(store)->fits();
      return fits.empty() ? "" : fits.back().population;
    } catch (const std::exception&) {
      return {};
    }
  }
  /// All readings and all states of a fit, without when they came.
  std::string known(const std::string& store, int rate) {
    const auto at = look(store);
    const GrowthTracker tracker(rate);
    std::map<std::string, std::string> all;
    for (const StoredReading& each : at->after(0, SIZE_MAX / 2))
      all[each.unit] += fmt::format("{} {};", each.key, json_of(each.numbers));
    const EventsOfUnits events = events_of_units(*at, tracker);
    for (const Checkpoint& each : at->states("fit-" + std::to_string(rate))) {
      UnitRecord record = restored_record(each, tracker, events_of(events, each.unit));
      record.last_received_ms = 0;
      for (UnitMoment& moment : record.moments) moment.time_ms = 0;
      all[each.unit] += bytes_of(record);
    }
    std::string text;
    for (const auto& [unit, bits] : all) text += unit + bits;
    return text;
  }
  void send(int round) {
    std::ofstream file(folder() / "incoming" / "a.jsonl", std::ios::app);
    for (int i = 0; i < 8; ++i)
      file << message("m" + std::to_string(i), round, (10 + i) * round, 10.0 * round) << "\n";
  }
  /// One of each kind, of a reading so far.
  void send_events(int round, Rng& rng) {
    std::ofstream file(folder() / "incoming" / "a.jsonl", std::ios::app);
    for (const char* event :
         {R"("replaced", "time": 5)", R"("installed", "time": 5)", R"("repaired", "restored": 7)",
          R"("withdrawn")", R"("corrected", "wear": 11, "time": 12)", R"("sensor", "wear": 3)"})
      file << fmt::format(R"({{"machine": "m{}", "n": {}, "by": "x", "event": {}}})",
                          rng.bits() % 8, 1 + rng.bits() % static_cast<unsigned>(round), event)
           << "\n";
  }
};

TEST_F(RunningMonitors, TakeAnotherFit) {
  std::filesystem::create_directories(folder() / "incoming");
  put_result(1);
  send(1);
  const pid_t child = start("fleet.sqlite");
  ASSERT_TRUE(eventually([&] { return population("fleet.sqlite") == "fit-1"; }));
  ASSERT_TRUE(eventually([&] { return count("fleet.sqlite") == 8; }));
  std::this_thread::sleep_for(std::chrono::seconds(2));  // forecasts follow
  put_result(3);
  ASSERT_TRUE(eventually([&] { return population("fleet.sqlite") == "fit-3"; }));
  // Half written: refused, and the present one goes on.
  write("result/state.bin", "4");
  ASSERT_TRUE(eventually(
      [&] { return content(folder() / "log").find("half written") != std::string::npos; }));
  send(2);
  ASSERT_TRUE(eventually([&] { return count("fleet.sqlite") == 16; }));
  EXPECT_EQ(population("fleet.sqlite"), "fit-3");
  // SIGHUP looks at once, also at what has not changed.
  put_result(3);
  kill(child, SIGHUP);
  ASSERT_TRUE(eventually([&] {
    return content(folder() / "log").find("has the fit fit-3 that forecasts come from") !=
           std::string::npos;
  }));
  EXPECT_EQ(end(child, SIGTERM), 0);
  const auto fits = look("fleet.sqlite")->fits();
  ASSERT_EQ(fits.size(), 2U);
  EXPECT_EQ(look("fleet.sqlite")->moved(fits[1].number).size(), 8U);
  EXPECT_EQ(look("fleet.sqlite")->states("fit-3").size(), 8U);
  EXPECT_THAT(content(folder() / "log"), HasSubstr("8 units; the median remaining useful life of"));
}

// A restart with a fit that has learned the stored readings is refused, and nothing is written.
TEST_F(RunningMonitors, RefuseLearnedReadingsAtTheStart) {
  std::filesystem::create_directories(folder() / "incoming");
  put_result(1);
  send(1);
  ASSERT_EQ(end(start("fleet.sqlite", true), 0), 0) << content(folder() / "log");
  put_result("2 10");
  EXPECT_EQ(end(start("fleet.sqlite", true), 0), 2);
  EXPECT_THAT(
      content(folder() / "log"),
      HasSubstr("the result fit-2: it has learned readings of this store, of machine 'm0'"));
  EXPECT_EQ(population("fleet.sqlite"), "fit-1");
  EXPECT_EQ(look("fleet.sqlite")->states("fit-1").size(), 8U);
  EXPECT_EQ(end(start("new.sqlite", true), 0), 0) << content(folder() / "log");
  put_result("3 7");  // a study of its own
  EXPECT_EQ(end(start("fleet.sqlite", true), 0), 0) << content(folder() / "log");
  EXPECT_EQ(population("fleet.sqlite"), "fit-3");
}

// Killed at any moment of exchanges and events: readings, events and states are in the end what they are without.
TEST_F(RunningMonitors, LoseNothingAmongExchangesAndKills) {
  std::filesystem::create_directories(folder() / "incoming");
  const char* many = std::getenv("WEARWELL_KILLS");
  const int kills = many ? std::atoi(many) : 8;
  Rng rng(5, 1);
  for (int i = 1; i <= kills; ++i) {
    if (i == 1) put_result(1);
    const pid_t child = start("fleet.sqlite");
    send(i);
    send_events(i, rng);
    std::this_thread::sleep_for(std::chrono::duration<double>(0.4 * rng.uniform()));
    put_result(1 + i % 3);
    std::this_thread::sleep_for(std::chrono::duration<double>(2 * rng.uniform()));
    EXPECT_EQ(end(child, SIGKILL), -1);
  }
  put_result(5);
  const pid_t child = start("fleet.sqlite");
  const auto all = static_cast<std::uint64_t>(8 * kills);
  ASSERT_TRUE(eventually([&] { return count("fleet.sqlite") == all; }));
  put_result(6);
  ASSERT_TRUE(eventually([&] { return population("fleet.sqlite") == "fit-6"; }));
  EXPECT_EQ(end(child, SIGTERM), 0) << content(folder() / "log");
  EXPECT_EQ(end(start("undisturbed.sqlite", true), 0), 0) << content(folder() / "log");
  EXPECT_EQ(look("fleet.sqlite")->states("fit-6").size(), 8U);
  const auto events = look("fleet.sqlite")->events_after(0);
  EXPECT_GT(events.size(), 5U * static_cast<unsigned>(kills));  // some are the same
  EXPECT_EQ(events.size(), look("undisturbed.sqlite")->events_after(0).size());
  EXPECT_TRUE(known("fleet.sqlite", 6) == known("undisturbed.sqlite", 6));
}

}  // namespace
}  // namespace wearwell::monitor
