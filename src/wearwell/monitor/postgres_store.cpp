#include "wearwell/monitor/postgres_store.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <iterator>
#include <map>
#include <span>
#include <thread>

#include "wearwell/base/error.h"
#include "wearwell/monitor/alarm.h"
#include "wearwell/monitor/postgres_session.h"

// Longer than others: the tables of one store and all its statements.
namespace wearwell::monitor {
namespace {

constexpr const char* tables = R"(
  CREATE TABLE wearwell (name text PRIMARY KEY, value text NOT NULL);
  CREATE TABLE wearwell_reading (
    place bigint PRIMARY KEY, unit text NOT NULL, key bigint NOT NULL, time_ms bigint NOT NULL,
    received_ms bigint NOT NULL, numbers text NOT NULL, labels text NOT NULL, UNIQUE (unit, key));
  CREATE INDEX wearwell_reading_of_unit ON wearwell_reading (unit, place);
  CREATE TABLE wearwell_state (
    unit text PRIMARY KEY, population text NOT NULL, place bigint NOT NULL, bytes bytea NOT NULL);
  CREATE TABLE wearwell_alarm (
    number bigserial PRIMARY KEY, unit text NOT NULL, time_ms bigint NOT NULL, alarm text NOT NULL, risk double precision NOT NULL,
    place bigint NOT NULL DEFAULT 0);
  CREATE INDEX wearwell_alarm_of_unit ON wearwell_alarm (unit, number);
  CREATE TABLE wearwell_file (name text PRIMARY KEY, bytes bigint NOT NULL))";

constexpr const char* event_table = R"(
  CREATE TABLE wearwell_event (
    number bigserial PRIMARY KEY, unit text NOT NULL, event text NOT NULL, key bigint NOT NULL, received_ms bigint NOT NULL,
    author text NOT NULL, note text NOT NULL, content text NOT NULL, identity text NOT NULL UNIQUE))";

constexpr const char* fit_tables = R"(
  CREATE TABLE wearwell_fit (
    number bigserial PRIMARY KEY, population text NOT NULL, since_ms bigint NOT NULL, written_ms bigint NOT NULL,
    trusted boolean NOT NULL);
  CREATE TABLE wearwell_moved (fit bigint NOT NULL, unit text NOT NULL, content text NOT NULL, PRIMARY KEY (fit, unit));
  CREATE TABLE wearwell_sent (unit text PRIMARY KEY, alarm text NOT NULL, time_ms bigint NOT NULL))";

constexpr const char* removed_table = R"(
  CREATE TABLE wearwell_removed (
    unit text PRIMARY KEY, before_key bigint NOT NULL, readings bigint NOT NULL, done boolean NOT NULL))";

// Migrations from each version to the next, from 1 on. Never change an existing step: stores of its
// version exist.
constexpr const char* steps[] = {
    "ALTER TABLE wearwell_alarm ADD COLUMN place bigint NOT NULL DEFAULT 0", event_table,
    fit_tables, removed_table};
static_assert(std::size(steps) == store_version - 1);

constexpr const char* reading_columns = "place, unit, key, time_ms, received_ms, numbers, labels";

// An arbitrary advisory lock number; its holder writes.
constexpr std::int64_t writer_lock = 0x7765617277656c6c;

StoredReading reading_in(const pqxx::row& row) {
  return {row[0].as<std::int64_t>(), row[1].c_str(),
          row[2].as<std::int64_t>(), row[3].as<std::int64_t>(),
          row[4].as<std::int64_t>(), numbers_of(row[5].c_str()),
          texts_of(row[6].c_str())};
}

std::vector<UnitEvent> events_in(const pqxx::result& rows) {
  std::vector<UnitEvent> events;
  for (const auto& row : rows) {
    UnitEvent event{row[0].as<std::int64_t>(),
                    row[1].c_str(),
                    stored_event(row[2].c_str()),
                    row[3].as<std::int64_t>(),
                    row[4].as<std::int64_t>(),
                    row[5].c_str(),
                    row[6].c_str()};
    read_content(row[7].c_str(), event);
    events.push_back(std::move(event));
  }
  return events;
}

std::map<std::string, RemovedReadings> removed_in(pqxx::work& work) {
  std::map<std::string, RemovedReadings> removed;
  for (const auto& row : work.exec("SELECT unit, before_key, readings, done FROM wearwell_removed"))
    removed[row[0].c_str()] = {row[1].as<std::int64_t>(), row[2].as<std::uint64_t>(),
                               row[3].as<bool>()};
  return removed;
}

std::string value_of(pqxx::work& work, const char* name) {
  const pqxx::result rows = work.exec_params("SELECT value FROM wearwell WHERE name = $1", name);
  return rows.empty() ? std::string() : rows[0][0].c_str();
}

void put(pqxx::work& work, const char* name, const std::string& value) {
  work.exec_params(
      "INSERT INTO wearwell VALUES ($1, $2) ON CONFLICT (name) DO UPDATE SET value = "
      "excluded.value",
      name, value);
}

// As in SQLite: from each name to the next in the index.
constexpr const char* unit_names_there =
    "WITH RECURSIVE named (unit) AS (SELECT min(unit) FROM wearwell_reading UNION ALL SELECT "
    "(SELECT "
    "min(unit) FROM wearwell_reading WHERE unit > named.unit) FROM named WHERE named.unit IS NOT "
    "NULL) "
    "SELECT unit FROM named WHERE unit IS NOT NULL UNION SELECT unit FROM wearwell_event";

class PostgresStore : public Store {
 public:
  PostgresStore(const std::string& url, const StoreColumns& columns, Access access,
                const StoreNotice& reported);

  std::vector<Kept> add(const std::vector<StoredReading>& readings) override;
  std::vector<StoredReading> after(std::int64_t place, std::size_t count) override;
  void of_unit(const std::string& unit, std::int64_t after, std::int64_t last,
               const std::function<void(const StoredReading&)>& visit) override;
  std::optional<StoredReading> reading(const std::string& unit, std::int64_t key) override;
  std::uint64_t count() override;
  bool has_unit(const std::string& unit) override;
  std::vector<std::string> units() override;
  std::int64_t last_place() override;
  std::vector<Kept> add_events(const std::vector<UnitEvent>& events) override;
  std::vector<UnitEvent> events_after(std::int64_t number) override;
  std::vector<UnitEvent> events_of(const std::string& unit) override;
  void save(const std::string& population, const std::vector<Checkpoint>& states,
            std::int64_t all_up_to) override;
  std::vector<Checkpoint> states(const std::string& population) override;
  std::int64_t all_up_to(const std::string& population) override;
  void log(const std::vector<AlarmChange>& changes) override;
  std::vector<AlarmChange> alarms() override;
  std::vector<StoredFit> fits() override;
  void begin_fit(const StoredFit& fit, const std::vector<MovedForecast>& moved) override;
  std::vector<MovedForecast> moved(std::int64_t fit) override;
  std::map<std::string, SentAlarm> sent_alarms() override;
  void note_sent(const std::string& unit, const SentAlarm& sent, std::int64_t time_ms) override;
  bool remove(const Removal& removal) override;
  std::map<std::string, RemovedReadings> removed() override;
  std::uint64_t remove_forecasts(std::int64_t before_ms) override;
  void note_file(const std::string& file, std::int64_t bytes) override;
  std::map<std::string, std::int64_t> files() override;

 private:
  const std::map<std::string, RemovedReadings>& known_removed(pqxx::work& work);
  bool is_too_old(pqxx::work& work, const UnitEvent& event);
  void begin_writing(pqxx::connection& connection);
  void migrate(int from);
  void add_piece(pqxx::work& work, std::span<const StoredReading> readings,
                 std::vector<Kept>& kept);
  void compare(pqxx::work& work, std::span<const StoredReading> readings, std::span<Kept> kept);

  const std::string name_;
  bool in_use_ = false;    ///< by another, when the writer last connected
  std::int64_t next_ = 0;  ///< place; of the writer's connection
  std::optional<std::map<std::string, RemovedReadings>> removed_;  ///< of the writer's connection
  PostgresSession write_, read_;
};

PostgresStore::PostgresStore(const std::string& url, const StoreColumns& columns, Access access,
                             const StoreNotice& reported)
    : name_(shown_url(url)),
      write_(url, [this](pqxx::connection& connection) { begin_writing(connection); }),
      read_(url, [](pqxx::connection&) {}) {
  std::string version;
  StoreColumns there;
  const auto look = [&](pqxx::work& work) {
    const bool fresh = work.exec1("SELECT to_regclass('wearwell') IS NULL")[0].as<bool>();
    if (fresh && access != Access::write) return;
    if (fresh) {
      work.exec(tables);
      work.exec(event_table);
      work.exec(fit_tables);
      work.exec(removed_table);
      put(work, "version", fmt::format("{}", store_version));
      put(work, "numbers", json_of(columns.numbers));
      put(work, "labels", json_of(columns.labels));
      put(work, "keys", columns.sequence ? "sequence" : "time");
    }
    version = value_of(work, "version");
    there = {texts_of(value_of(work, "numbers")), texts_of(value_of(work, "labels")),
             value_of(work, "keys") == "sequence"};
  };
  // The server may take a moment to notice that a killed monitor has gone.
  constexpr int patience = 50;
  for (int i = 0;; ++i) {
    try {
      (access == Access::write ? write_ : read_).run(look);
      break;
    } catch (const StoreError& error) {
      if (!in_use_) throw;
      if (i == patience) throw InputError(error.what());
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  if (version.empty())
    throw NoStoreYet(fmt::format("{} has no store yet: no monitor has run", name_));
  const int number = check_store(name_, version, there, columns, access);
  if (number == store_version || access != Access::write) return;
  migrate(number);
  if (reported) reported(migrated_text(name_, number));
}

// All steps, or none.
void PostgresStore::migrate(int from) {
  write_.run([&](pqxx::work& work) {
    for (int version = from; version < store_version; ++version) work.exec(steps[version - 1]);
    put(work, "version", fmt::format("{}", store_version));
  });
}

void PostgresStore::begin_writing(pqxx::connection& connection) {
  pqxx::nontransaction work(connection);
  in_use_ = !work.exec1(fmt::format("SELECT pg_try_advisory_lock({})", writer_lock))[0].as<bool>();
  if (in_use_) throw StoreError(fmt::format("{} is in use by another wearwell monitor", name_));
  next_ = 0;  // to be looked up
  removed_.reset();
}

std::vector<Kept> PostgresStore::add(const std::vector<StoredReading>& readings) {
  constexpr std::size_t at_once = 1000;
  std::vector<Kept> kept;
  write_.run([&](pqxx::work& work) {
    kept.clear();
    if (next_ == 0)
      next_ = work.exec1("SELECT coalesce(max(place), 0) + 1 FROM wearwell_reading")[0]
                  .as<std::int64_t>();
    for (std::size_t from = 0; from < readings.size(); from += at_once)
      add_piece(work, std::span(readings).subspan(from, std::min(at_once, readings.size() - from)),
                kept);
  });
  return kept;
}

void PostgresStore::add_piece(pqxx::work& work, std::span<const StoredReading> readings,
                              std::vector<Kept>& kept) {
  const auto& removed = known_removed(work);
  const auto is_old = [&](const StoredReading& each) {
    const auto found = removed.find(each.unit);
    return found != removed.end() && each.key < found->second.before_key;
  };
  std::string values;
  const std::size_t first = kept.size();
  kept.resize(first + readings.size(), Kept::repeated);
  for (const StoredReading& each : readings) {
    if (is_old(each)) {
      kept[first + static_cast<std::size_t>(&each - readings.data())] = Kept::too_old;
      continue;
    }
    values += fmt::format("{}({},{},{},{},{},{},{})", values.empty() ? "" : ",",
                          next_ + static_cast<std::int64_t>(&each - readings.data()),
                          work.quote(each.unit), each.key, each.time_ms, each.received_ms,
                          work.quote(json_of(each.numbers)), work.quote(json_of(each.labels)));
  }
  pqxx::result stored;
  if (!values.empty())
    stored = work.exec(
        fmt::format("INSERT INTO wearwell_reading VALUES {} ON CONFLICT (unit, key) DO NOTHING "
                    "RETURNING place",
                    values));
  for (const auto& row : stored)
    kept[first + static_cast<std::size_t>(row[0].as<std::int64_t>() - next_)] = Kept::stored;
  next_ += static_cast<std::int64_t>(readings.size());
  if (stored.size() < readings.size()) compare(work, readings, std::span(kept).subspan(first));
}

// Existing ones: with the same values, or with others.
void PostgresStore::compare(pqxx::work& work, std::span<const StoredReading> readings,
                            std::span<Kept> kept) {
  std::string keys;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    if (kept[i] != Kept::stored)
      keys += fmt::format("{}({},{})", keys.empty() ? "" : ",", work.quote(readings[i].unit),
                          readings[i].key);
  }
  std::map<std::pair<std::string, std::int64_t>, std::string> there;
  for (const auto& row : work.exec(fmt::format(
           "SELECT unit, key, numbers || labels FROM wearwell_reading WHERE (unit, key) IN ({})",
           keys)))
    there[{row[0].c_str(), row[1].as<std::int64_t>()}] = row[2].c_str();
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const StoredReading& each = readings[i];
    if (kept[i] == Kept::stored) continue;
    const auto found = there.find({each.unit, each.key});
    if (found == there.end()) continue;  // too old
    kept[i] = found->second == json_of(each.numbers) + json_of(each.labels) ? Kept::repeated
                                                                            : Kept::contradicts;
  }
}

std::vector<StoredReading> PostgresStore::after(std::int64_t place, std::size_t count) {
  std::vector<StoredReading> readings;
  read_.run([&](pqxx::work& work) {
    readings.clear();
    for (const auto& row : work.exec(
             fmt::format("SELECT {} FROM wearwell_reading WHERE place > {} ORDER BY place LIMIT {}",
                         reading_columns, place, count)))
      readings.push_back(reading_in(row));
  });
  return readings;
}

void PostgresStore::of_unit(const std::string& unit, std::int64_t after, std::int64_t last,
                            const std::function<void(const StoredReading&)>& visit) {
  std::vector<StoredReading> readings;
  read_.run([&](pqxx::work& work) {
    for (const auto& row : work.exec(fmt::format(
             "SELECT {} FROM wearwell_reading WHERE unit = {} AND place > {} AND place <= {} ORDER "
             "BY place",
             reading_columns, work.quote(unit), after, last)))
      readings.push_back(reading_in(row));
  });
  for (const StoredReading& each : readings) visit(each);
}

std::optional<StoredReading> PostgresStore::reading(const std::string& unit, std::int64_t key) {
  std::optional<StoredReading> found;
  read_.run([&](pqxx::work& work) {
    found.reset();
    for (const auto& row :
         work.exec(fmt::format("SELECT {} FROM wearwell_reading WHERE unit = {} AND key = {}",
                               reading_columns, work.quote(unit), key)))
      found = reading_in(row);
  });
  return found;
}

std::vector<Kept> PostgresStore::add_events(const std::vector<UnitEvent>& events) {
  std::vector<Kept> kept;
  write_.run([&](pqxx::work& work) {
    kept.clear();
    for (const UnitEvent& each : events) {
      if (is_too_old(work, each)) {
        kept.push_back(Kept::too_old);
        continue;
      }
      const pqxx::result stored = work.exec_params(
          "INSERT INTO wearwell_event (unit, event, key, received_ms, author, note, content, "
          "identity) VALUES ($1, $2, $3, $4, $5, $6, $7, $8) ON CONFLICT DO NOTHING RETURNING "
          "number",
          each.unit, name(each.kind), each.key, each.received_ms, each.author, each.note,
          content_of(each), identity_of(each));
      kept.push_back(stored.empty() ? Kept::repeated : Kept::stored);
    }
  });
  return kept;
}

const std::map<std::string, RemovedReadings>& PostgresStore::known_removed(pqxx::work& work) {
  if (!removed_) removed_ = removed_in(work);
  return *removed_;
}

// An event that is there already is a repeat, whatever was removed since.
bool PostgresStore::is_too_old(pqxx::work& work, const UnitEvent& event) {
  const auto& removed = known_removed(work);
  const auto found = removed.find(event.unit);
  if (found == removed.end()) return false;
  if (!work.exec_params("SELECT 1 FROM wearwell_event WHERE identity = $1", identity_of(event))
           .empty())
    return false;
  std::optional<UnitEvent> cancelled;
  if (event.kind == EventKind::cancelled) {
    const std::vector<UnitEvent> others = events_in(work.exec_params(
        "SELECT number, unit, event, key, received_ms, author, note, content FROM wearwell_event "
        "WHERE number = $1 AND unit = $2",
        event.cancels, event.unit));
    if (!others.empty()) cancelled = others.front();
  }
  return is_among_removed(event, cancelled, found->second.before_key);
}

bool PostgresStore::remove(const Removal& removal) {
  bool is_present = false;
  write_.run([&](pqxx::work& work) {
    // Events of this unit wait until this is done: they are written by this connection alone.
    is_present =
        work.exec_params1("SELECT coalesce(max(number), 0) FROM wearwell_event WHERE unit = $1",
                          removal.unit)[0]
            .as<std::int64_t>() == removal.last_event;
    if (!is_present) return;
    const auto& removed = known_removed(work);
    const auto found = removed.find(removal.unit);
    RemovedReadings now = found == removed.end() ? RemovedReadings() : found->second;
    if (!removal.places.empty())
      now.count += work.exec(fmt::format("DELETE FROM wearwell_reading WHERE place IN ({}) AND "
                                         "place < (SELECT max(place) FROM wearwell_reading)",
                                         fmt::join(removal.places, ",")))
                       .affected_rows();
    now.before_key = removal.before_key;
    now.done = removal.done;
    work.exec_params(
        "INSERT INTO wearwell_removed VALUES ($1, $2, $3, $4) ON CONFLICT (unit) DO UPDATE SET "
        "before_key = excluded.before_key, readings = excluded.readings, done = excluded.done",
        removal.unit, now.before_key, static_cast<std::int64_t>(now.count), now.done);
    if (removal.drops_state)
      work.exec_params("DELETE FROM wearwell_state WHERE unit = $1", removal.unit);
    (*removed_)[removal.unit] = now;  // looked up again if the transaction fails
  });
  return is_present;
}

std::map<std::string, RemovedReadings> PostgresStore::removed() {
  std::map<std::string, RemovedReadings> removed;
  read_.run([&](pqxx::work& work) { removed = removed_in(work); });
  return removed;
}

std::uint64_t PostgresStore::remove_forecasts(std::int64_t before_ms) {
  std::uint64_t count = 0;
  write_.run([&](pqxx::work& work) {
    count = 0;
    for (const char* sql :
         {"DELETE FROM wearwell_alarm WHERE time_ms < $1 AND number NOT IN (SELECT max(number) "
          "FROM "
          "wearwell_alarm GROUP BY unit)",
          "DELETE FROM wearwell_moved WHERE fit IN (SELECT number FROM wearwell_fit WHERE since_ms "
          "< $1 AND number < (SELECT max(number) FROM wearwell_fit))"})
      count += work.exec_params(sql, before_ms).affected_rows();
  });
  return count;
}

std::vector<UnitEvent> PostgresStore::events_after(std::int64_t number) {
  std::vector<UnitEvent> events;
  read_.run([&](pqxx::work& work) {
    events = events_in(
        work.exec_params("SELECT number, unit, event, key, received_ms, author, note, content FROM "
                         "wearwell_event WHERE number > $1 ORDER BY number",
                         number));
  });
  return events;
}

std::vector<UnitEvent> PostgresStore::events_of(const std::string& unit) {
  std::vector<UnitEvent> events;
  read_.run([&](pqxx::work& work) {
    events = events_in(
        work.exec_params("SELECT number, unit, event, key, received_ms, author, note, content FROM "
                         "wearwell_event WHERE unit = $1 ORDER BY number",
                         unit));
  });
  return events;
}

std::vector<StoredFit> PostgresStore::fits() {
  std::vector<StoredFit> fits;
  read_.run([&](pqxx::work& work) {
    fits.clear();
    for (const auto& row : work.exec(
             "SELECT number, population, since_ms, written_ms, trusted FROM wearwell_fit ORDER BY "
             "number"))
      fits.push_back({row[0].as<std::int64_t>(), row[1].c_str(), row[2].as<std::int64_t>(),
                      row[3].as<std::int64_t>(), row[4].as<bool>()});
  });
  return fits;
}

void PostgresStore::begin_fit(const StoredFit& fit, const std::vector<MovedForecast>& moved) {
  write_.run([&](pqxx::work& work) {
    const auto number =
        work.exec_params1(
                "INSERT INTO wearwell_fit (population, since_ms, written_ms, trusted) VALUES ($1, "
                "$2, $3, $4) RETURNING number",
                fit.population, fit.since_ms, fit.written_ms, fit.trusted)[0]
            .as<std::int64_t>();
    constexpr std::size_t at_once = 1000;
    for (std::size_t from = 0; from < moved.size(); from += at_once) {
      std::string values;
      for (const MovedForecast& each :
           std::span(moved).subspan(from, std::min(at_once, moved.size() - from)))
        values += fmt::format("{}({},{},{})", values.empty() ? "" : ",", number,
                              work.quote(each.unit), work.quote(content_of(each)));
      work.exec(fmt::format("INSERT INTO wearwell_moved VALUES {}", values));
    }
  });
}

std::vector<MovedForecast> PostgresStore::moved(std::int64_t fit) {
  std::vector<MovedForecast> moved;
  read_.run([&](pqxx::work& work) {
    moved.clear();
    for (const auto& row : work.exec_params(
             "SELECT unit, content FROM wearwell_moved WHERE fit = $1 ORDER BY unit", fit))
      moved.push_back(moved_forecast(row[0].c_str(), row[1].c_str()));
  });
  return moved;
}

std::map<std::string, SentAlarm> PostgresStore::sent_alarms() {
  std::map<std::string, SentAlarm> sent;
  read_.run([&](pqxx::work& work) {
    for (const auto& row : work.exec("SELECT unit, alarm FROM wearwell_sent"))
      sent[row[0].c_str()] = sent_alarm(row[1].c_str());
  });
  return sent;
}

void PostgresStore::note_sent(const std::string& unit, const SentAlarm& alarm,
                              std::int64_t time_ms) {
  write_.run([&](pqxx::work& work) {
    work.exec_params(
        "INSERT INTO wearwell_sent VALUES ($1, $2, $3) ON CONFLICT (unit) DO UPDATE SET alarm = "
        "excluded.alarm, time_ms = excluded.time_ms",
        unit, text_of(alarm), time_ms);
  });
}

std::uint64_t PostgresStore::count() {
  std::uint64_t number = 0;
  read_.run([&](pqxx::work& work) {
    number = work.exec1("SELECT count(*) FROM wearwell_reading")[0].as<std::uint64_t>();
  });
  return number;
}

bool PostgresStore::has_unit(const std::string& unit) {
  bool has = false;
  read_.run([&](pqxx::work& work) {
    has = work.exec_params(
                  "SELECT EXISTS (SELECT 1 FROM wearwell_reading WHERE unit = $1) OR EXISTS "
                  "(SELECT 1 FROM wearwell_event WHERE unit = $1)",
                  unit)[0][0]
              .as<bool>();
  });
  return has;
}

std::vector<std::string> PostgresStore::units() {
  std::vector<std::string> units;
  read_.run([&](pqxx::work& work) {
    units.clear();
    for (const auto& row : work.exec(unit_names_there)) units.push_back(row[0].as<std::string>());
  });
  return units;
}

std::int64_t PostgresStore::last_place() {
  std::int64_t last = 0;
  read_.run([&](pqxx::work& work) {
    last = work.exec1("SELECT coalesce(max(place), 0) FROM wearwell_reading")[0].as<std::int64_t>();
  });
  return last;
}

void PostgresStore::save(const std::string& population, const std::vector<Checkpoint>& states,
                         std::int64_t all_up_to) {
  write_.run([&](pqxx::work& work) {
    for (const Checkpoint& each : states)
      work.exec(fmt::format(
          "INSERT INTO wearwell_state VALUES ({}, {}, {}, {}) ON CONFLICT (unit) DO UPDATE SET "
          "population = excluded.population, place = excluded.place, bytes = excluded.bytes",
          work.quote(each.unit), work.quote(population), each.place, work.quote_raw(each.bytes)));
    put(work, "population", population);
    put(work, "all_up_to", fmt::format("{}", all_up_to));
  });
}

std::vector<Checkpoint> PostgresStore::states(const std::string& population) {
  std::vector<Checkpoint> states;
  read_.run([&](pqxx::work& work) {
    for (const auto& row : work.exec_params(
             "SELECT unit, place, bytes FROM wearwell_state WHERE population = $1", population))
      states.push_back(
          {row[0].c_str(), row[1].as<std::int64_t>(), pqxx::binarystring(row[2]).str()});
  });
  return states;
}

std::int64_t PostgresStore::all_up_to(const std::string& population) {
  std::int64_t place = 0;
  read_.run([&](pqxx::work& work) {
    const std::string at = value_of(work, "all_up_to");
    if (!at.empty() && value_of(work, "population") == population) place = std::stoll(at);
  });
  return place;
}

void PostgresStore::log(const std::vector<AlarmChange>& changes) {
  if (changes.empty()) return;
  write_.run([&](pqxx::work& work) {
    for (const AlarmChange& each : changes)
      work.exec_params(
          "INSERT INTO wearwell_alarm (unit, time_ms, alarm, risk, place) VALUES ($1, $2, $3, $4, "
          "$5)",
          each.unit, each.time_ms, name(each.alarm), each.risk, each.place);
  });
}

std::vector<AlarmChange> PostgresStore::alarms() {
  std::vector<AlarmChange> changes;
  read_.run([&](pqxx::work& work) {
    for (const auto& row : work.exec("SELECT DISTINCT ON (unit) unit, time_ms, alarm, risk, place "
                                     "FROM wearwell_alarm ORDER "
                                     "BY unit, number DESC"))
      changes.push_back({row[0].c_str(), row[1].as<std::int64_t>(), alarm_named(row[2].c_str()),
                         row[3].as<double>(), row[4].as<std::int64_t>()});
  });
  return changes;
}

void PostgresStore::note_file(const std::string& file, std::int64_t bytes) {
  write_.run([&](pqxx::work& work) {
    work.exec_params(
        "INSERT INTO wearwell_file VALUES ($1, $2) ON CONFLICT (name) DO UPDATE SET bytes = "
        "excluded.bytes",
        file, bytes);
  });
}

std::map<std::string, std::int64_t> PostgresStore::files() {
  std::map<std::string, std::int64_t> files;
  read_.run([&](pqxx::work& work) {
    for (const auto& row : work.exec("SELECT name, bytes FROM wearwell_file"))
      files[row[0].c_str()] = row[1].as<std::int64_t>();
  });
  return files;
}

/// Ends a transaction without its changes.
struct RolledBack {};

}  // namespace

void check_postgres_place(const std::string& url) {
  PostgresSession session(url, [](pqxx::connection&) {});
  try {
    session.run([](pqxx::work& work) {
      if (!work.exec1("SELECT to_regclass('wearwell') IS NULL")[0].as<bool>()) return;
      work.exec(tables);
      throw RolledBack{};
    });
  } catch (const RolledBack&) {
  }
}

std::unique_ptr<Store> open_postgres_store(const std::string& url, const StoreColumns& columns,
                                           Access access, const StoreNotice& reported) {
  return std::make_unique<PostgresStore>(url, columns, access, reported);
}

}  // namespace wearwell::monitor
