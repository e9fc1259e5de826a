// What both stores promise: a reading once and for good, the order of storage, and what they refuse.
#include <gmock/gmock.h>
#include <unistd.h>

#include <limits>
#include <thread>

#include "monitor/fleet_rig.h"
#include "support/messages.h"
#include "support/servers.h"
#include "wearwell/base/error.h"
#include "wearwell/base/rng.h"
#include "wearwell/monitor/backup.h"

namespace wearwell::monitor {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

class Stores : public ScratchTest, public testing::WithParamInterface<const char*> {
 protected:
  void SetUp() override {
    if (GetParam() != std::string("postgres")) return;
    const std::string missing = PostgresServer::missing();
    if (!missing.empty()) GTEST_SKIP() << missing;
    server_ = std::make_unique<PostgresServer>(folder() / "postgres");
  }
  std::string url() const { return server_ ? server_->url() : "fleet.sqlite"; }
  std::unique_ptr<Store> open(const StoreColumns& columns = {{"wear", "time"}, {"site"}, true},
                              Access access = Access::write) {
    return open_store(url(), folder(), columns, access);
  }
  static StoredReading reading(const std::string& unit, std::int64_t key, double wear) {
    return {0, unit, key, 1000 * key, 1, {wear, std::nan("")}, {"a \"b\" ü"}};
  }
  static std::string shown(const std::vector<StoredReading>& readings) {
    std::string text;
    for (const StoredReading& each : readings)
      text += fmt::format("{} {} {} {} {};", each.unit, each.key, each.numbers[0],
                          std::isnan(each.numbers[1]), each.labels[0]);
    return text;
  }
  std::unique_ptr<PostgresServer> server_;
};

TEST_P(Stores, KeepAReadingOnce) {
  auto store = open();
  EXPECT_THAT(store->units(), IsEmpty());
  EXPECT_EQ(store->last_place(), 0);
  const double third = 1.0 / 3;
  EXPECT_THAT(store->add({reading("b", 2, third), reading("a", 1, 1e-300), reading("b", 2, third)}),
              ElementsAre(Kept::stored, Kept::stored, Kept::repeated));
  EXPECT_THAT(store->add({reading("b", 2, 0.5), reading("b", 3, 0.5), reading("a", 1, 1e-300)}),
              ElementsAre(Kept::contradicts, Kept::stored, Kept::repeated));
  const std::string all =
      "b 2 0.3333333333333333 true a \"b\" ü;a 1 1e-300 true a \"b\" ü;b 3 0.5 true a \"b\" ü;";
  EXPECT_EQ(shown(store->after(0, 100)), all);
  store = nullptr;
  store = open();
  EXPECT_EQ(shown(store->after(0, 100)), all);
  EXPECT_EQ(store->count(), 3U);
  EXPECT_TRUE(store->has_unit("b"));
  EXPECT_FALSE(store->has_unit("c"));
  UnitEvent installed;
  installed.unit = "c";
  installed.kind = EventKind::installed;
  store->add_events({installed});
  EXPECT_TRUE(store->has_unit("c"));
  EXPECT_THAT(store->units(), UnorderedElementsAre("a", "b", "c"));
  EXPECT_EQ(store->last_place(), store->after(0, 100).back().place);
  const auto first = store->after(0, 1);
  EXPECT_EQ(shown(store->after(first[0].place, 1)), "a 1 1e-300 true a \"b\" ü;");
  std::string of_b;
  store->of_unit("b", 0, INT64_MAX,
                 [&](const StoredReading& each) { of_b += std::to_string(each.key); });
  EXPECT_EQ(of_b, "23");
  store->of_unit("b", first[0].place, INT64_MAX,
                 [&](const StoredReading& each) { of_b += std::to_string(each.key); });
  EXPECT_EQ(of_b, "233");
}

// Whether a monitor could begin, without a trace: before there is a store, beside one that is written to, and where there can be none.
TEST_P(Stores, HaveAPlaceThatCanBeChecked) {
  EXPECT_NO_THROW(check_place(url(), folder()));
  EXPECT_THROW(open({{"wear", "time"}, {"site"}, true}, Access::copy), NoStoreYet);
  const auto store = open();
  EXPECT_NO_THROW(check_place(url(), folder()));
  if (server_) {
    ASSERT_EQ(server_
                  ->sql("create database other; create role reader login; revoke create on schema "
                        "public from public")
                  .exit_code,
              0);
    std::string reader = url();
    reader.replace(reader.find("wearwell@"), 8, "reader");
    EXPECT_NO_THROW(check_place(reader, folder()));  // the store is there
    reader.replace(reader.rfind('/'), reader.npos, "/other");
    server_->sql("\\c other\nrevoke create on schema public from public");
    EXPECT_THAT(message_of<StoreError>([&] { check_place(reader, folder()); }),
                HasSubstr("permission denied"));
    server_->kill();
    EXPECT_THROW(check_place(url(), folder()), StoreError);
    return;
  }
  EXPECT_THAT(message_of<InputError>([&] { check_place("none/fleet.sqlite", folder()); }),
              testing::AllOf(HasSubstr("cannot write to"), HasSubstr("none/.fleet.sqlite.lock"),
                             HasSubstr("No such file or directory")));
  std::filesystem::create_directory(folder() / "closed");
  std::filesystem::permissions(folder() / "closed", std::filesystem::perms(0555));
  constexpr uid_t other = 65534;  // root may write everywhere
  const uid_t me = geteuid();
  if (me == 0) {
    ASSERT_EQ(seteuid(other), 0);
  }
  const std::string refused =
      message_of<InputError>([&] { check_place("closed/fleet.sqlite", folder()); });
  ASSERT_EQ(seteuid(me), 0);
  EXPECT_THAT(refused, HasSubstr("Permission denied"));
}

TEST_P(Stores, KeepFitsAndWhatTheyMoved) {
  auto store = open();
  EXPECT_TRUE(store->fits().empty());
  const MovedForecast one{
      "b \"ü\"",
      7,
      "km",
      {Alarm::watch, true, {1, 2.5, std::numeric_limits<double>::infinity()}, 0.25},
      {Alarm::act, true, {0.5, 1.0 / 3, 4}, 0.75}};
  const MovedForecast other{
      "a", 0, "km", {Alarm::unknown, false, {}, 0}, {Alarm::ok, true, {1, 2, 3}, 0}};
  store->begin_fit({0, "first", 10, 5, true}, {});
  store->begin_fit({0, "second", 20, 0, false}, {one, other});
  store = nullptr;
  store = open();
  const auto fits = store->fits();
  ASSERT_EQ(fits.size(), 2U);
  EXPECT_EQ(fits[0].population, "first");
  EXPECT_EQ(fits[0].written_ms, 5);
  EXPECT_EQ(fits[1].since_ms, 20);
  EXPECT_TRUE(fits[0].trusted);
  EXPECT_FALSE(fits[1].trusted);
  EXPECT_TRUE(store->moved(fits[0].number).empty());
  const auto moved = store->moved(fits[1].number);
  ASSERT_EQ(moved.size(), 2U);
  EXPECT_EQ(content_of(moved[0]), content_of(other));
  EXPECT_EQ(content_of(moved[1]), content_of(one));
  EXPECT_EQ(moved[1].unit, one.unit);
  EXPECT_TRUE(std::isinf(moved[1].before.remaining.q95));
  EXPECT_FALSE(moved[0].before.known);
}

TEST_P(Stores, KeepWhatWasSent) {
  auto store = open();
  EXPECT_TRUE(store->sent_alarms().empty());
  store->note_sent("a", {Alarm::act, false}, 5);
  store->note_sent("b", {Alarm::unknown, true}, 6);
  store->note_sent("a", {Alarm::watch, false}, 7);
  store = nullptr;
  store = open();
  EXPECT_EQ(store->sent_alarms(),
            (std::map<std::string, SentAlarm>{{"a", {Alarm::watch, false}},
                                              {"b", {Alarm::unknown, true}}}));
}

TEST_P(Stores, ReadTheEventsOfOneUnit) {
  auto store = open();
  UnitEvent event{0, "a", EventKind::acknowledged, 0, 5, "J. Doe", "seen"};
  event.alarm_ms = 77;
  UnitEvent other{0, "b", EventKind::withdrawn, 3, 6, "J. Doe", ""};
  EXPECT_THAT(store->add_events({event, other, event}),
              ElementsAre(Kept::stored, Kept::stored, Kept::repeated));
  ASSERT_EQ(store->events_of("a").size(), 1U);
  EXPECT_EQ(store->events_of("a")[0].alarm_ms, 77);
  EXPECT_EQ(store->events_of("a")[0].kind, EventKind::acknowledged);
  EXPECT_EQ(store->events_of("b")[0].number, 2);
  EXPECT_TRUE(store->events_of("c").empty());
}

// A copy while another connection writes has all of one moment, and is a store.
TEST_P(Stores, AreBackedUpWhileTheyAreInUse) {
  const StoreColumns columns{{"wear", "time"}, {"site"}, true};
  auto store = open(columns);
  for (int i = 1; i <= 200; ++i) store->add({reading("a", i, i)});
  const auto target = folder() / "copy.sqlite";
  if (server_) {
    EXPECT_THAT(message_of<InputError>([&] { backup_store(url(), folder(), columns, target); }),
                HasSubstr("use pg_dump"));
    return;
  }
  {
    std::jthread writer([&](const std::stop_token& stop) {
      for (int i = 201; !stop.stop_requested(); ++i) store->add({reading("a", i, i)});
    });
    backup_store(url(), folder(), columns, target);
  }
  const auto copy = open_store("copy.sqlite", folder(), columns, Access::write);
  const auto readings = copy->after(0, SIZE_MAX / 2);
  ASSERT_GE(readings.size(), 200U);
  for (std::size_t i = 0; i < readings.size(); ++i)
    EXPECT_EQ(readings[i].key, static_cast<std::int64_t>(i) + 1);
  EXPECT_LE(readings.size(), store->count());
  EXPECT_THAT(message_of<InputError>([&] { backup_store(url(), folder(), columns, target); }),
              HasSubstr("exists already"));
  EXPECT_THAT(
      message_of<InputError>([&] { backup_store("none", folder(), columns, folder() / "x"); }),
      HasSubstr("is not a store yet"));
  EXPECT_FALSE(std::filesystem::exists(folder() / "x"));
}

TEST_P(Stores, KeepStatesOfOnePopulation) {
  auto store = open();
  const std::string bytes("\0\xff'\\x", 5);
  store->save("p", {{"a", 3, bytes}, {"b", 4, ""}}, 4);
  store->save("p", {{"b", 7, "new"}}, 7);
  const auto states = store->states("p");
  ASSERT_EQ(states.size(), 2U);
  for (const Checkpoint& each : states) {
    EXPECT_EQ(each.bytes, each.unit == "a" ? bytes : "new");
    EXPECT_EQ(each.place, each.unit == "a" ? 3 : 7);
  }
  EXPECT_EQ(store->all_up_to("p"), 7);
  EXPECT_EQ(store->all_up_to("another"), 0);
  EXPECT_TRUE(store->states("another").empty());
}

TEST_P(Stores, KeepAlarmsAndFiles) {
  auto store = open();
  store->log({{"a", 1, Alarm::watch, 0.1}, {"b", 2, Alarm::act, 0.5}, {"a", 3, Alarm::ok, 0.01}});
  std::map<std::string, std::string> last;
  for (const AlarmChange& each : store->alarms()) last[each.unit] = name(each.alarm);
  EXPECT_EQ(last, (std::map<std::string, std::string>{{"a", "ok"}, {"b", "act"}}));
  store->note_file("x", 5);
  store->note_file("x", 9);
  EXPECT_EQ(store->files(), (std::map<std::string, std::int64_t>{{"x", 9}}));
}

// What is removed stays away when it is sent again, and what would change its meaning is refused.
TEST_P(Stores, RemoveReadingsForGood) {
  auto store = open();
  for (int n = 1; n <= 6; ++n) store->add({reading("a", n, n)});
  UnitEvent replaced{0, "a", EventKind::replaced, 4, 7, "x", ""};
  replaced.use = 0;
  UnitEvent noted{0, "a", EventKind::acknowledged, 0, 8, "x", ""};
  ASSERT_THAT(store->add_events({replaced, noted}), ElementsAre(Kept::stored, Kept::stored));
  store->save("p", {{"a", 6, "state"}, {"b", 6, "other"}}, 6);
  std::vector<std::int64_t> places;
  for (const StoredReading& each : store->after(0, 100)) places.push_back(each.place);
  // Another event came after the choice: nothing is done.
  EXPECT_FALSE(store->remove({"a", 4, 1, {places[0]}, false, true}));
  EXPECT_EQ(store->count(), 6U);
  EXPECT_TRUE(store->removed().empty());
  EXPECT_TRUE(store->remove({"a", 4, 2, {places[0]}, false, false}));
  EXPECT_EQ(store->states("p").size(), 2U);
  EXPECT_TRUE(store->remove({"a", 4, 2, {places[1]}, true, true}));
  ASSERT_EQ(store->states("p").size(), 1U);
  EXPECT_EQ(store->states("p")[0].unit, "b");
  for (const bool reopened : {false, true}) {
    if (reopened) {
      store = nullptr;
      store = open();
    }
    EXPECT_EQ(store->count(), reopened ? 5U : 4U);  // with that of "b"
    EXPECT_EQ(store->removed().at("a").count, 2U);
    EXPECT_EQ(store->removed().at("a").before_key, 4);
    EXPECT_TRUE(store->removed().at("a").done);
    EXPECT_THAT(store->add({reading("a", 1, 1), reading("a", 3, 3), reading("a", 3, 9),
                            reading("a", 4, 4), reading("b", 1, 1)}),
                ElementsAre(Kept::too_old, Kept::repeated, Kept::contradicts, Kept::repeated,
                            reopened ? Kept::repeated : Kept::stored));
    EXPECT_THAT(store->add({reading("a", 2, 2)}), ElementsAre(Kept::too_old));
    UnitEvent cancelled{0, "a", EventKind::cancelled, 0, 9, "x", "again"};
    cancelled.cancels = 1;
    UnitEvent acknowledgement_cancelled = cancelled;
    acknowledgement_cancelled.cancels = 2;
    const UnitEvent withdrawn{0, "a", EventKind::withdrawn, 3, 9, "x", ""};
    const UnitEvent later{0, "a", EventKind::withdrawn, 4, 9, "x", ""};
    EXPECT_THAT(
        store->add_events({cancelled, withdrawn, replaced, later, acknowledgement_cancelled}),
        ElementsAre(Kept::too_old, Kept::too_old, Kept::repeated,
                    reopened ? Kept::repeated : Kept::stored,
                    reopened ? Kept::repeated : Kept::stored));
  }
}

// The place of the last reading is not given again: states would take another one for it.
TEST_P(Stores, NeverRemoveTheLastReading) {
  auto store = open();
  store->add({reading("a", 1, 1), reading("a", 2, 2)});
  const auto all = store->after(0, 10);
  EXPECT_TRUE(store->remove({"a", 3, 0, {all[0].place, all[1].place}, true, true}));
  EXPECT_EQ(store->removed().at("a").count, 1U);
  store->add({reading("b", 1, 1)});
  const auto left = store->after(0, 10);
  ASSERT_EQ(left.size(), 2U);
  EXPECT_EQ(left[0].key, 2);
  EXPECT_GT(left[1].place, all[1].place);
}

TEST_P(Stores, RemoveEarlierForecasts) {
  auto store = open();
  store->log({{"a", 1, Alarm::watch, 0.1}, {"b", 2, Alarm::act, 0.5}, {"a", 3, Alarm::ok, 0.01}});
  const MovedForecast moved{"a", 1, "km", {}, {}};
  store->begin_fit({0, "first", 10, 5, true}, {moved});
  store->begin_fit({0, "second", 20, 5, true}, {moved});
  store->begin_fit({0, "third", 30, 5, true}, {moved});
  EXPECT_EQ(store->remove_forecasts(1), 0U);
  // Of "a" the last alarm stays, of "b" the only one; of the fits the last one's forecasts.
  EXPECT_EQ(store->remove_forecasts(15), 2U);
  EXPECT_EQ(store->alarms().size(), 2U);
  EXPECT_EQ(store->remove_forecasts(100), 1U);
  EXPECT_EQ(store->fits().size(), 3U);
  EXPECT_EQ(store->moved(store->fits()[2].number).size(), 1U);
  EXPECT_TRUE(store->moved(store->fits()[0].number).empty());
}

TEST_P(Stores, KeepEventsInTheirOrder) {
  auto store = open();
  UnitEvent replaced{0, "b", EventKind::replaced, 5, 77, "A. \"Smith\" ü", "new\tbearing"};
  replaced.use = 1.0 / 3;
  UnitEvent corrected{0, "a", EventKind::corrected, 1, 78, "x", ""};
  corrected.numbers = {1e-300, std::nan("")};
  corrected.labels = {"a \"b\" ü"};
  UnitEvent cancelled{0, "b", EventKind::cancelled, 0, 79, "x", ""};
  cancelled.cancels = 1;
  EXPECT_THAT(store->add_events({replaced, corrected, replaced}),
              ElementsAre(Kept::stored, Kept::stored, Kept::repeated));
  EXPECT_THAT(store->add_events({corrected, cancelled}), ElementsAre(Kept::repeated, Kept::stored));
  store = nullptr;
  store = open();
  const auto events = store->events_after(0);
  ASSERT_EQ(events.size(), 3U);
  EXPECT_EQ(events[0].use, 1.0 / 3);
  EXPECT_EQ(events[0].author, replaced.author);
  EXPECT_EQ(events[0].note, replaced.note);
  EXPECT_EQ(events[0].key, 5);
  EXPECT_EQ(events[0].received_ms, 77);
  EXPECT_EQ(events[1].kind, EventKind::corrected);
  EXPECT_EQ(events[1].numbers[0], 1e-300);
  EXPECT_TRUE(std::isnan(events[1].numbers[1]));
  EXPECT_EQ(events[1].labels, corrected.labels);
  EXPECT_TRUE(std::isnan(events[1].use));
  EXPECT_EQ(events[2].cancels, 1);
  EXPECT_EQ(store->events_after(events[0].number).size(), 2U);
  // As long as names, notes and labels may be.
  UnitEvent longest = corrected;
  longest.unit = std::string(200, 'u');
  longest.note = std::string(1000, 'n');
  longest.labels = std::vector<std::string>(40, std::string(200, 'l'));
  EXPECT_THAT(store->add_events({longest, longest}), ElementsAre(Kept::stored, Kept::repeated));
  // A sensor's offset, and readings as they were stored.
  UnitEvent sensor{0, "a", EventKind::sensor, 3, 80, "x", ""};
  sensor.offset = -2.5e-6;
  store->add_events({sensor});
  EXPECT_EQ(store->events_after(events[2].number)[1].offset, -2.5e-6);
  store->add({reading("a", 3, 0.5)});
  ASSERT_TRUE(store->reading("a", 3));
  EXPECT_EQ(store->reading("a", 3)->numbers[0], 0.5);
  EXPECT_FALSE(store->reading("a", 4));
  EXPECT_FALSE(store->reading("b", 3));
}

TEST_P(Stores, AreOfOneMonitor) {
  const auto store = open();
  EXPECT_THAT(message_of<InputError>([&] { open(); }),
              HasSubstr("in use by another wearwell monitor"));
  EXPECT_EQ(open({{"wear", "time"}, {"site"}, true}, Access::read)->count(), 0U);
}

TEST_P(Stores, AreNotReadAsSomethingElse) {
  EXPECT_THAT(message_of<InputError>([&] {
                open({{"wear", "time"}, {"site"}, true}, Access::read);
              }),
              HasSubstr("store yet"));
  open();
  EXPECT_THAT(message_of<InputError>([&] {
                open({{"wear", "force"}, {"site"}, true});
              }),
              HasSubstr("use another store"));
  EXPECT_THAT(message_of<InputError>([&] {
                open({{"wear", "time"}, {"site"}, false});
              }),
              HasSubstr("identifies readings by their sequence numbers"));
}

TEST_P(Stores, KeepManyWithRepeatsAmongThem) {
  auto store = open();
  Rng rng(3, 1);
  std::map<std::pair<std::string, std::int64_t>, double> expected;
  for (int batch = 0; batch < 5; ++batch) {
    std::vector<StoredReading> readings;
    std::vector<Kept> wanted;
    for (int i = 0; i < 2500; ++i) {
      const std::string unit(1, static_cast<char>('a' + rng.bits() % 5));
      const auto key = static_cast<std::int64_t>(rng.bits() % 2000);
      const double wear = static_cast<double>(rng.bits() % 2);
      readings.push_back(reading(unit, key, wear));
      const auto [at, fresh] = expected.try_emplace({unit, key}, wear);
      wanted.push_back(fresh                ? Kept::stored
                       : at->second == wear ? Kept::repeated
                                            : Kept::contradicts);
    }
    EXPECT_EQ(store->add(readings), wanted);
  }
  EXPECT_EQ(store->count(), expected.size());
}

// A store as version 1 had it: the tables, a reading, a state and an alarm.
class OldStores : public Stores {
 protected:
  // What both databases understand, with their words for some types.
  std::string old_tables() const {
    const bool server = server_ != nullptr;
    const std::string prefix = server ? "wearwell_" : "", bytes = server ? "bytea" : "BLOB",
                      number = server ? "bigserial" : "INTEGER",
                      value = server ? "'\\x6f6c64'" : "x'6f6c64'";
    return fmt::format(R"(
      CREATE TABLE wearwell (name text PRIMARY KEY, value text NOT NULL);
      CREATE TABLE {0}reading (
        place {3} PRIMARY KEY, unit text NOT NULL, key bigint NOT NULL, time_ms bigint NOT NULL,
        received_ms bigint NOT NULL, numbers text NOT NULL, labels text NOT NULL, UNIQUE (unit, key));
      CREATE TABLE {0}state (
        unit text PRIMARY KEY, population text NOT NULL, place bigint NOT NULL, bytes {1} NOT NULL);
      CREATE TABLE {0}alarm (
        number {2} PRIMARY KEY, unit text NOT NULL, time_ms bigint NOT NULL, alarm text NOT NULL, risk double precision NOT NULL);
      CREATE INDEX {0}alarm_of_unit ON {0}alarm (unit, number);
      CREATE TABLE {0}file (name text PRIMARY KEY, bytes bigint NOT NULL);
      INSERT INTO wearwell VALUES ('version', '1'), ('numbers', '["wear","time"]'),
        ('labels', '["site"]'), ('keys', 'sequence'), ('population', 'p'), ('all_up_to', '7');
      INSERT INTO {0}reading VALUES (7, 'a', 3, 3000, 1, '[0.25,null]', '["x"]');
      INSERT INTO {0}state VALUES ('a', 'p', 7, {4});
      INSERT INTO {0}alarm (unit, time_ms, alarm, risk) VALUES ('a', 5, 'watch', 0.125);)",
                       prefix, bytes, number, server ? "bigint" : "INTEGER", value);
  }
  void run(const std::string& sql) const {
    write("old.sql", sql);
    const std::string file = (folder() / "old.sql").string();
    const CommandResult done = run_command(
        server_ ? fmt::format("psql -q -v ON_ERROR_STOP=1 '{}' -f '{}'", server_->url(), file)
                : fmt::format("sqlite3 '{}' < '{}'", (folder() / url()).string(), file));
    ASSERT_EQ(done.exit_code, 0) << done.err;
  }
  bool tools() const {
    return run_command(server_ ? "command -v psql" : "command -v sqlite3").exit_code == 0;
  }
};

TEST_P(OldStores, AreBroughtUpToDateOnce) {
  if (!tools()) GTEST_SKIP() << "psql or sqlite3 is not installed";
  run(old_tables());
  const StoreColumns columns{{"wear", "time"}, {"site"}, true};
  // Who only reads changes nothing, and another result's columns neither.
  EXPECT_THAT(message_of<InputError>([&] { open(columns, Access::read); }),
              HasSubstr("is a store of version 1, and this wearwell reads version 5"));
  // A backup before the upgrade is one of the old version.
  if (!server_) {
    backup_store(url(), folder(), columns, folder() / "before.sqlite");
    EXPECT_THAT(message_of<InputError>(
                    [&] { open_store("before.sqlite", folder(), columns, Access::read); }),
                HasSubstr("is a store of version 1"));
    std::size_t left = 0;
    for (const auto& each : std::filesystem::directory_iterator(folder()))
      left += each.path().string().find(".unfinished") != std::string::npos;
    EXPECT_EQ(left, 0U);
  }
  EXPECT_THAT(message_of<InputError>([&] {
                open({{"wear"}, {"site"}, true});
              }),
              HasSubstr("use another store"));
  std::vector<std::string> reported;
  const auto tell = [&](const std::string& what) { reported.push_back(what); };
  auto store = open_store(url(), folder(), columns, Access::write, tell);
  EXPECT_THAT(reported, ElementsAre(HasSubstr("had version 1 and is now upgraded to version 5")));
  EXPECT_EQ(shown(store->after(0, 10)), "a 3 0.25 true x;");
  ASSERT_EQ(store->states("p").size(), 1U);
  EXPECT_EQ(store->states("p")[0].bytes, "old");
  EXPECT_EQ(store->all_up_to("p"), 7);
  ASSERT_EQ(store->alarms().size(), 1U);
  EXPECT_EQ(store->alarms()[0].risk, 0.125);
  EXPECT_EQ(store->alarms()[0].place, 0);
  // And goes on as one that was begun anew.
  EXPECT_THAT(store->add_events({{0, "a", EventKind::withdrawn, 3, 5, "x", ""}}),
              ElementsAre(Kept::stored));
  store->log({{"a", 9, Alarm::act, 0.5, 8}});
  EXPECT_EQ(store->alarms()[0].place, 8);
  EXPECT_THAT(store->add({reading("a", 4, 1)}), ElementsAre(Kept::stored));
  store->begin_fit({0, "p", 5, 0, true}, {});
  store->note_sent("a", {Alarm::act, false}, 9);
  EXPECT_EQ(store->fits().size(), 1U);
  EXPECT_EQ(store->sent_alarms().size(), 1U);
  EXPECT_GT(store->after(7, 1)[0].place, 7);
  store = nullptr;
  store = open_store(url(), folder(), columns, Access::write, tell);
  EXPECT_EQ(reported.size(), 1U);
  EXPECT_EQ(open(columns, Access::read)->count(), 2U);
}

// What cannot be brought up to date whole stays as it was.
TEST_P(OldStores, StayAsTheyWereWhereAStepFails) {
  if (!tools()) GTEST_SKIP() << "psql or sqlite3 is not installed";
  run(old_tables());
  run(server_ ? "ALTER TABLE wearwell_alarm RENAME TO elsewhere;"
              : "ALTER TABLE alarm RENAME TO elsewhere;");
  EXPECT_THROW(open(), StoreError);
  run(server_ ? "ALTER TABLE elsewhere RENAME TO wearwell_alarm;"
              : "ALTER TABLE elsewhere RENAME TO alarm;");
  EXPECT_THAT(message_of<InputError>([&] {
                open({{"wear", "time"}, {"site"}, true}, Access::read);
              }),
              HasSubstr("is a store of version 1"));
  EXPECT_EQ(open()->alarms().size(), 1U);
}

TEST_P(OldStores, OfLaterVersionsAreRefused) {
  if (!tools()) GTEST_SKIP() << "psql or sqlite3 is not installed";
  run(old_tables());
  for (const char* version : {"6", "0", "-1", "2.5", "", "two"}) {
    run(fmt::format("UPDATE wearwell SET value = '{}' WHERE name = 'version';", version));
    if (server_ && !*version) continue;  // no store at all
    EXPECT_THAT(message_of<InputError>([&] { open(); }),
                HasSubstr(fmt::format("is a store of version '{}'; this wearwell reads versions 1 "
                                      "to 5",
                                      version)));
  }
}

INSTANTIATE_TEST_SUITE_P(, OldStores, testing::Values("sqlite", "postgres"),
                         [](const auto& each) { return std::string(each.param); });
INSTANTIATE_TEST_SUITE_P(, Stores, testing::Values("sqlite", "postgres"),
                         [](const auto& each) { return std::string(each.param); });

TEST_F(ScratchTest, AFileThatIsNoStoreIsRefused) {
  write("text.sqlite", std::string(5000, 'x'));
  EXPECT_THAT(message_of<InputError>([&] { open_store("text.sqlite", folder(), {}); }),
              HasSubstr("not a database"));
  const std::string other = (folder() / "other.sqlite").string();
  if (run_command("sqlite3 '" + other + "' 'create table t (a)'").exit_code != 0) GTEST_SKIP();
  EXPECT_THAT(message_of<InputError>([&] { open_store("other.sqlite", folder(), {}); }),
              HasSubstr("not a store of wearwell"));
}

}  // namespace
}  // namespace wearwell::monitor
