// What need not be kept is removed: parts that are long out of service, but nothing that the state of a part in service, a table of
// lives or the last alarm follows from; also when it is killed in the middle.
#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <thread>

#include "monitor/fleet_rig.h"
#include "wearwell/base/rng.h"
#include "wearwell/monitor/export_lives.h"
#include "wearwell/monitor/retention.h"
#include "wearwell/monitor/time_text.h"

namespace wearwell::monitor {
namespace {

using testing::HasSubstr;

constexpr double day_s = 86400;

class Retained : public FleetRig {
 protected:
  Retained() { source_.mapping = mapping(); }
  static ReadingMapping mapping() {
    static const GrowthTracker tracker;
    ReadingMapping mapping = plain_mapping(tracker, false);
    mapping.unit = "machine";
    mapping.sequence = "n";
    return mapping;
  }
  static std::int64_t days_ago(double days) {
    static const std::int64_t now = unix_ms_now();  // the same bits in each store
    return now - static_cast<std::int64_t>(1000 * day_s * days);
  }
  /// Readings `first` to `last` that arrived so long ago, of wear at 1.1 m/h from the use 0 on.
  void put(const std::string& unit, int first, int last, double days) {
    std::vector<StoredReading> readings;
    for (int n = first; n <= last; ++n) {
      const double hours = 10.0 * (n - first + 1);
      readings.push_back({0, unit, n, 0, days_ago(days), {1.1 * hours, 3600 * hours}, {}});
    }
    store_->add(readings);
  }
  void put_event(const std::string& unit, EventKind kind, std::int64_t key, double hours,
                 double days) {
    UnitEvent event{0, unit, kind, key, days_ago(days), "A. Smith", ""};
    event.use = 3600 * hours;
    store_->add_events({event});
  }
  /// Removes all that is older than 100 days.
  void remove_old() {
    Retention retention(100 * day_s, *store_, tracker_, quiet_);
    while (retention.round(*fleet_)) {
    }
  }
  std::vector<std::int64_t> keys(const std::string& unit) {
    std::vector<std::int64_t> keys;
    store_->of_unit(unit, 0, INT64_MAX,
                    [&](const StoredReading& each) { keys.push_back(each.key); });
    return keys;
  }
  std::map<std::string, std::string> states() {
    fleet_->save();
    std::map<std::string, std::string> all;
    for (const Checkpoint& each : store_->states("population")) all[each.unit] = each.bytes;
    return all;
  }
  /// The states from the readings and events alone.
  std::map<std::string, std::string> rebuilt_states() {
    std::vector<Checkpoint> damaged;
    for (const auto& [unit, bytes] : states()) damaged.push_back({unit, 0, "damaged"});
    store_->save("population", damaged, 0);
    open();
    catch_up();
    return states();
  }
  std::string lives() {
    std::uint64_t count = 0;
    return lives_as_csv(*store_, tracker_, count);
  }
  void put_fleet() {
    put("replaced", 1, 30, 400);
    put_event("replaced", EventKind::replaced, 31, 0, 390);
    put("replaced", 31, 40, 380);
    put("failed", 1, 20, 400);
    put_event("failed", EventKind::failed, 20, 205, 390);
    put("failed lately", 1, 20, 400);
    put_event("failed lately", EventKind::failed, 20, 205, 10);
    put("late", 1, 20, 400);
    put_event("late", EventKind::failed, 25, 205, 390);
    put("late", 21, 21, 10);  // of the part that has failed, but it has just come
    put("in service", 1, 50, 400);
  }
};

TEST_F(Retained, OnlyPartsThatAreLongOutOfServiceGo) {
  open();
  put_fleet();
  catch_up();
  const auto before = states();
  const std::string table = lives();
  const RemovedCounts expected = count_old(*store_, tracker_, 100 * day_s);
  EXPECT_EQ(expected.units, 2U);
  EXPECT_EQ(expected.parts, 2U);
  EXPECT_EQ(expected.readings, 29U + 19U);
  EXPECT_EQ(removed_text(expected), "48 readings of 2 parts out of service");
  remove_old();
  catch_up();
  EXPECT_THAT(keys("replaced"), testing::ElementsAre(30, 31, 32, 33, 34, 35, 36, 37, 38, 39, 40));
  EXPECT_THAT(keys("failed"), testing::ElementsAre(20));
  EXPECT_EQ(keys("failed lately").size(), 20U);
  EXPECT_EQ(keys("late").size(), 21U);
  EXPECT_EQ(keys("in service").size(), 50U);
  EXPECT_EQ(lives(), table);
  const auto after = states();
  for (const char* unit : {"replaced", "failed lately", "late", "in service"})
    EXPECT_TRUE(after.at(unit) == before.at(unit)) << unit;
  EXPECT_EQ(fleet_->view("failed")->quality.readings, 1U);
  EXPECT_EQ(fleet_->view("failed")->service, Service::failed);
  EXPECT_TRUE(rebuilt_states() == after);
  // Nothing is left to remove, and another fit finds the same.
  EXPECT_EQ(count_old(*store_, tracker_, 100 * day_s).readings, 0U);
  EXPECT_EQ(count_old(*store_, tracker_, 5 * day_s).units, 2U);  // those that have failed lately
}

// A part that fails when the store keeps nothing of it, and its successor.
TEST_F(Retained, AUnitGoesOnAfterItsRemoval) {
  open();
  put("a", 1, 20, 400);
  put_event("a", EventKind::failed, 20, 205, 390);
  put("b", 1, 3, 400);
  catch_up();
  remove_old();
  EXPECT_EQ(keys("a").size(), 1U);
  const auto report = [&](const std::string& event, const std::string& more) {
    return deliver(
        fmt::format(R"({{"machine": "a", "event": "{}", "by": "A. Smith", {}}})", event, more));
  };
  const Delivery again = deliver(message("a", 5, 55, 50));
  EXPECT_EQ(again.refused, 1U);
  EXPECT_THAT(again.problem, HasSubstr("readings were removed, out of service for longer than"));
  EXPECT_EQ(deliver(message("a", 20, 1.1 * 200, 200)).repeated, 1U);
  EXPECT_EQ(report("cancelled", R"("number": 1)").refused, 1U);
  EXPECT_THAT(report("removed", R"("n": 10, "time": 10)").problem, HasSubstr("an event of a part"));
  EXPECT_EQ(report("replaced", R"("n": 21, "time": 0)").events, 1U);
  for (int n = 21; n <= 40; ++n) {
    deliver(message("a", n, 11.0 * (n - 20), 10.0 * (n - 20)));
    deliver(message("new", n, 11.0 * (n - 20), 10.0 * (n - 20)));
  }
  catch_up();
  EXPECT_EQ(fleet_->view("a")->part, 2);
  EXPECT_EQ(fleet_->view("a")->quality.readings, 20U);
  EXPECT_EQ(fleet_->view("a")->remaining.q05, fleet_->view("new")->remaining.q05);
  const auto now = states();
  EXPECT_TRUE(rebuilt_states() == now);
}

// An event that the fleet does not know yet may put a part back into service.
TEST_F(Retained, AnEventThatHasJustComeKeepsTheReadings) {
  open();
  put("a", 1, 20, 400);
  put_event("a", EventKind::failed, 20, 205, 390);
  put("b", 1, 3, 400);
  catch_up();
  UnitEvent cancelled{0, "a", EventKind::cancelled, 0, days_ago(0), "A. Smith", ""};
  cancelled.cancels = 1;
  store_->add_events({cancelled});
  remove_old();
  EXPECT_EQ(keys("a").size(), 20U);
  catch_up();
  EXPECT_EQ(fleet_->view("a")->service, Service::in_service);
  remove_old();
  EXPECT_EQ(keys("a").size(), 20U);
}

TEST_F(Retained, NothingGoesWithoutATime) {
  open();
  put_fleet();
  catch_up();
  Retention retention({}, *store_, tracker_, quiet_);
  EXPECT_FALSE(retention.round(*fleet_));
  EXPECT_EQ(store_->count(), 151U);
}

// Killed at any moment, the next one goes on, and in the end the store is the one that was never killed.
TEST_F(Retained, KilledInTheMiddleItLosesNothing) {
  const auto fill = [&] {
    open();
    put_fleet();
    put("long", 1, 5000, 400);
    put_event("long", EventKind::replaced, 5001, 0, 390);
    put("long", 5001, 5010, 380);
    put("longer", 1, 3000, 400);
    put_event("longer", EventKind::removed, 3000, 0, 390);
    put("in service", 51, 52, 380);
    catch_up();
    return states();
  };
  const auto before = fill();
  remove_old();
  catch_up();
  const auto expected = states();
  const std::uint64_t left = store_->count();
  close();
  for (const char* end : {"", "-wal", "-shm"})
    std::filesystem::remove(folder() / (std::string("fleet.sqlite") + end));
  fill();
  close();
  Rng rng(5, 1);
  std::set<std::uint64_t> counts;
  constexpr double longest[] = {3e4, 2e5,
                                2e6};  // microseconds until a kill: a busy machine starts late
  for (int kill_number = 0; kill_number < 12; ++kill_number) {
    const pid_t child = fork();
    if (child == 0) {
      open();
      remove_old();
      catch_up();
      fleet_->save();
      _exit(0);
    }
    std::this_thread::sleep_for(std::chrono::microseconds(
        static_cast<std::int64_t>(rng.uniform(0, longest[kill_number / 4]))));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    // What is there now is consistent: states that are stored follow from readings that are stored.
    open();
    counts.insert(store_->count());
    catch_up();
    const auto now = states();
    for (const char* unit : {"replaced", "long", "in service", "late"})
      EXPECT_TRUE(now.at(unit) == before.at(unit)) << unit;
    EXPECT_TRUE(rebuilt_states() == now) << kill_number;
    close();
  }
  EXPECT_GT(counts.size(), 1U);
  open();
  remove_old();
  catch_up();
  EXPECT_EQ(store_->count(), left);
  EXPECT_TRUE(states() == expected);
}

}  // namespace
}  // namespace wearwell::monitor
