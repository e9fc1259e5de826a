#include "wearwell/monitor/sqlite_store.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <iterator>
#include <mutex>
#include <optional>

#include "wearwell/base/disk.h"
#include "wearwell/base/error.h"
#include "wearwell/base/lock_file.h"
#include "wearwell/monitor/alarm.h"
#include "wearwell/monitor/sqlite_session.h"

// Longer than others: the tables of one store and all its statements.
namespace wearwell::monitor {
namespace {

constexpr const char* tables = R"(
  CREATE TABLE wearwell (name TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
  CREATE TABLE reading (
    place INTEGER PRIMARY KEY, unit TEXT NOT NULL, key INTEGER NOT NULL, time_ms INTEGER NOT NULL,
    received_ms INTEGER NOT NULL, numbers TEXT NOT NULL, labels TEXT NOT NULL, UNIQUE (unit, key));
  CREATE TABLE state (
    unit TEXT PRIMARY KEY, population TEXT NOT NULL, place INTEGER NOT NULL, bytes BLOB NOT NULL);
  CREATE TABLE alarm (
    number INTEGER PRIMARY KEY, unit TEXT NOT NULL, time_ms INTEGER NOT NULL, alarm TEXT NOT NULL, risk REAL NOT NULL,
    place INTEGER NOT NULL DEFAULT 0);
  CREATE INDEX alarm_of_unit ON alarm (unit, number);
  CREATE TABLE file (name TEXT PRIMARY KEY, bytes INTEGER NOT NULL) WITHOUT ROWID;)";

constexpr const char* event_table = R"(
  CREATE TABLE event (
    number INTEGER PRIMARY KEY, unit TEXT NOT NULL, event TEXT NOT NULL, key INTEGER NOT NULL, received_ms INTEGER NOT NULL,
    author TEXT NOT NULL, note TEXT NOT NULL, content TEXT NOT NULL, identity TEXT NOT NULL UNIQUE);)";

constexpr const char* fit_tables = R"(
  CREATE TABLE fit (
    number INTEGER PRIMARY KEY, population TEXT NOT NULL, since_ms INTEGER NOT NULL, written_ms INTEGER NOT NULL,
    trusted INTEGER NOT NULL);
  CREATE TABLE moved (fit INTEGER NOT NULL, unit TEXT NOT NULL, content TEXT NOT NULL, PRIMARY KEY (fit, unit)) WITHOUT ROWID;
  CREATE TABLE sent (unit TEXT PRIMARY KEY, alarm TEXT NOT NULL, time_ms INTEGER NOT NULL) WITHOUT ROWID;)";

constexpr const char* removed_table = R"(
  CREATE TABLE removed (
    unit TEXT PRIMARY KEY, before_key INTEGER NOT NULL, readings INTEGER NOT NULL, done INTEGER NOT NULL) WITHOUT ROWID;)";

// Migrations from each version to the next. Never change an existing step: stores of it exist.
constexpr const char* steps[] = {"ALTER TABLE alarm ADD COLUMN place INTEGER NOT NULL DEFAULT 0",
                                 event_table, fit_tables, removed_table};
static_assert(std::size(steps) == store_version - 1);

constexpr const char* reading_columns = "place, unit, key, time_ms, received_ms, numbers, labels";

StoredReading reading_in(const SqliteStatement& row) {
  return {row.integer(0),       row.text(1),    row.integer(2),
          row.integer(3),       row.integer(4), numbers_of(row.text(5)),
          texts_of(row.text(6))};
}

constexpr const char* event_columns =
    "number, unit, event, key, received_ms, author, note, content";

std::vector<UnitEvent> events_in(SqliteStatement& select) {
  std::vector<UnitEvent> events;
  while (select.next()) {
    UnitEvent event{select.integer(0), select.text(1),    stored_event(select.text(2)),
                    select.integer(3), select.integer(4), select.text(5),
                    select.text(6)};
    read_content(select.text(7), event);
    events.push_back(std::move(event));
  }
  return events;
}

// From each name to the next in the index, not through all readings.
constexpr const char* unit_names =
    "WITH RECURSIVE named (unit) AS (SELECT min(unit) FROM reading UNION ALL SELECT (SELECT "
    "min(unit) FROM reading WHERE unit > named.unit) FROM named WHERE named.unit IS NOT NULL) "
    "SELECT unit FROM named WHERE unit IS NOT NULL UNION SELECT unit FROM event";

class SqliteStore : public Store {
 public:
  SqliteStore(const std::filesystem::path& file, const StoreColumns& columns, Access access,
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
  bool is_too_old(const UnitEvent& event, const std::string& identity);
  void begin_tables(const StoreColumns& columns);
  int check(const StoreColumns& columns, Access access);
  void migrate(int from);
  std::string value(const char* name);
  void put(const char* name, const std::string& value);

  const std::string name_;
  std::optional<LockFile> lock_;
  // Readers continue while a commit waits for the disk.
  std::mutex write_lock_, read_lock_;
  SqliteSession write_, read_;
  std::unique_ptr<SqliteStatement> insert_, existing_, of_unit_;
  std::map<std::string, RemovedReadings> removed_;  // of a writer
};

/// A writing monitor is the only writer; a reader must find a store.
std::optional<LockFile> locked(const std::filesystem::path& file, Access access) {
  if (access != Access::write) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file, ignored))
      throw NoStoreYet(fmt::format("{} is not a store yet: no monitor has run", file.string()));
    return {};
  }
  return std::optional<LockFile>(std::in_place, file, [&] {
    throw InputError(fmt::format("{} is in use by another wearwell monitor", file.string()));
  });
}

SqliteStore::SqliteStore(const std::filesystem::path& file, const StoreColumns& columns,
                         Access access, const StoreNotice& reported)
    : name_(file.string()), lock_(locked(file, access)), write_(file), read_(file) {
  try {
    write_.run("PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL;");
    SqliteStatement there(write_, "SELECT count(*) FROM sqlite_master");
    there.next();
    const bool fresh = there.integer(0) == 0;
    there.reset();
    if (fresh && access == Access::write) begin_tables(columns);
  } catch (const StoreError& error) {
    const int code = sqlite3_errcode(write_.get()) & 0xff;
    if (code == SQLITE_NOTADB || code == SQLITE_CANTOPEN || code == SQLITE_READONLY)
      throw InputError(fmt::format("store.url: {}", error.what()));
    throw;
  }
  const int version = check(columns, access);
  if (version < store_version && access == Access::write) {
    migrate(version);
    if (reported) reported(migrated_text(name_, version));
  }
  insert_ = std::make_unique<SqliteStatement>(
      write_,
      "INSERT INTO reading (unit, key, time_ms, received_ms, numbers, labels) VALUES (?, ?, ?, ?, "
      "?, ?) ON CONFLICT DO NOTHING");
  existing_ = std::make_unique<SqliteStatement>(
      write_, "SELECT numbers, labels FROM reading WHERE unit = ? AND key = ?");
  of_unit_ = std::make_unique<SqliteStatement>(
      read_,
      fmt::format(
          "SELECT {} FROM reading WHERE unit = ? AND place > ? AND place <= ? ORDER BY place",
          reading_columns));
  if (access == Access::write) removed_ = removed();
}

void SqliteStore::begin_tables(const StoreColumns& columns) {
  SqliteTransaction transaction(write_);
  write_.run(tables);
  write_.run(event_table);
  write_.run(fit_tables);
  write_.run(removed_table);
  put("version", fmt::format("{}", store_version));
  put("numbers", json_of(columns.numbers));
  put("labels", json_of(columns.labels));
  put("keys", columns.sequence ? "sequence" : "time");
  transaction.commit();
}

// All steps, or none.
void SqliteStore::migrate(int from) {
  SqliteTransaction transaction(write_);
  for (int version = from; version < store_version; ++version) write_.run(steps[version - 1]);
  put("version", fmt::format("{}", store_version));
  transaction.commit();
}

int SqliteStore::check(const StoreColumns& columns, Access access) {
  std::string version;
  try {
    version = value("version");
  } catch (const StoreError&) {
    throw InputError(fmt::format("{} is a database, but not a store of wearwell", name_));
  }
  return check_store(
      name_, version,
      {texts_of(value("numbers")), texts_of(value("labels")), value("keys") == "sequence"}, columns,
      access);
}

std::string SqliteStore::value(const char* name) {
  SqliteStatement select(write_, "SELECT value FROM wearwell WHERE name = ?");
  select.bind(1, std::string_view(name));
  return select.next() ? select.text(0) : std::string();
}

void SqliteStore::put(const char* name, const std::string& value) {
  SqliteStatement insert(write_, "INSERT OR REPLACE INTO wearwell VALUES (?, ?)");
  insert.bind(1, std::string_view(name)).bind(2, std::string_view(value)).run();
}

std::vector<Kept> SqliteStore::add(const std::vector<StoredReading>& readings) {
  const std::lock_guard lock(write_lock_);
  std::vector<Kept> kept;
  kept.reserve(readings.size());
  SqliteTransaction transaction(write_);
  for (const StoredReading& each : readings) {
    const std::string numbers = json_of(each.numbers), labels = json_of(each.labels);
    const auto removed = removed_.find(each.unit);
    if (removed != removed_.end() && each.key < removed->second.before_key) {
      existing_->bind(1, std::string_view(each.unit)).bind(2, each.key);
      kept.push_back(!existing_->next() ? Kept::too_old
                     : existing_->text(0) == numbers && existing_->text(1) == labels
                         ? Kept::repeated
                         : Kept::contradicts);
      existing_->reset();
      continue;
    }
    insert_->bind(1, std::string_view(each.unit)).bind(2, each.key).bind(3, each.time_ms);
    insert_->bind(4, each.received_ms).bind(5, std::string_view(numbers));
    insert_->bind(6, std::string_view(labels)).run();
    if (write_.changes() == 1) {
      kept.push_back(Kept::stored);
      continue;
    }
    existing_->bind(1, std::string_view(each.unit)).bind(2, each.key);
    const bool same =
        existing_->next() && existing_->text(0) == numbers && existing_->text(1) == labels;
    existing_->reset();
    kept.push_back(same ? Kept::repeated : Kept::contradicts);
  }
  transaction.commit();
  return kept;
}

std::vector<StoredReading> SqliteStore::after(std::int64_t place, std::size_t count) {
  const std::lock_guard lock(read_lock_);
  SqliteStatement select(
      read_, fmt::format("SELECT {} FROM reading WHERE place > ? ORDER BY place LIMIT ?",
                         reading_columns));
  select.bind(1, place).bind(2, static_cast<std::int64_t>(count));
  std::vector<StoredReading> readings;
  while (select.next()) readings.push_back(reading_in(select));
  return readings;
}

void SqliteStore::of_unit(const std::string& unit, std::int64_t after, std::int64_t last,
                          const std::function<void(const StoredReading&)>& visit) {
  std::vector<StoredReading> readings;
  {
    const std::lock_guard lock(read_lock_);
    of_unit_->bind(1, std::string_view(unit)).bind(2, after).bind(3, last);
    while (of_unit_->next()) readings.push_back(reading_in(*of_unit_));
    of_unit_->reset();
  }
  for (const StoredReading& each : readings) visit(each);
}

std::optional<StoredReading> SqliteStore::reading(const std::string& unit, std::int64_t key) {
  const std::lock_guard lock(read_lock_);
  SqliteStatement select(
      read_, fmt::format("SELECT {} FROM reading WHERE unit = ? AND key = ?", reading_columns));
  select.bind(1, std::string_view(unit)).bind(2, key);
  if (!select.next()) return {};
  return reading_in(select);
}

std::vector<Kept> SqliteStore::add_events(const std::vector<UnitEvent>& events) {
  const std::lock_guard lock(write_lock_);
  std::vector<Kept> kept;
  SqliteTransaction transaction(write_);
  SqliteStatement insert(write_,
                         "INSERT INTO event (unit, event, key, received_ms, author, note, content, "
                         "identity) VALUES (?, ?, ?, ?, ?, ?, ?, ?) ON CONFLICT DO NOTHING");
  for (const UnitEvent& each : events) {
    const std::string content = content_of(each), identity = identity_of(each);
    if (is_too_old(each, identity)) {
      kept.push_back(Kept::too_old);
      continue;
    }
    insert.bind(1, std::string_view(each.unit)).bind(2, std::string_view(name(each.kind)));
    insert.bind(3, each.key).bind(4, each.received_ms).bind(5, std::string_view(each.author));
    insert.bind(6, std::string_view(each.note)).bind(7, std::string_view(content));
    insert.bind(8, std::string_view(identity)).run();
    kept.push_back(write_.changes() == 1 ? Kept::stored : Kept::repeated);
  }
  transaction.commit();
  return kept;
}

// An event that is there already is a repeat, whatever was removed since.
bool SqliteStore::is_too_old(const UnitEvent& event, const std::string& identity) {
  const auto removed = removed_.find(event.unit);
  if (removed == removed_.end()) return false;
  SqliteStatement same(write_, "SELECT 1 FROM event WHERE identity = ?");
  if (same.bind(1, std::string_view(identity)).next()) return false;
  std::optional<UnitEvent> cancelled;
  if (event.kind == EventKind::cancelled) {
    SqliteStatement select(
        write_, fmt::format("SELECT {} FROM event WHERE number = ? AND unit = ?", event_columns));
    select.bind(1, event.cancels).bind(2, std::string_view(event.unit));
    const std::vector<UnitEvent> found = events_in(select);
    if (!found.empty()) cancelled = found.front();
  }
  return is_among_removed(event, cancelled, removed->second.before_key);
}

bool SqliteStore::remove(const Removal& removal) {
  const std::lock_guard lock(write_lock_);
  SqliteTransaction transaction(write_);
  SqliteStatement last(write_, "SELECT coalesce(max(number), 0) FROM event WHERE unit = ?");
  last.bind(1, std::string_view(removal.unit)).next();
  if (last.integer(0) != removal.last_event) return false;
  last.reset();
  const auto before = removed_.find(removal.unit);
  RemovedReadings now = before == removed_.end() ? RemovedReadings() : before->second;
  SqliteStatement erase(
      write_, "DELETE FROM reading WHERE place = ? AND place < (SELECT max(place) FROM reading)");
  for (const std::int64_t each : removal.places) {
    erase.bind(1, each).run();
    now.count += static_cast<std::uint64_t>(write_.changes());
  }
  now.before_key = removal.before_key;
  now.done = removal.done;
  SqliteStatement note(write_, "INSERT OR REPLACE INTO removed VALUES (?, ?, ?, ?)");
  note.bind(1, std::string_view(removal.unit)).bind(2, now.before_key);
  note.bind(3, static_cast<std::int64_t>(now.count)).bind(4, std::int64_t{now.done}).run();
  if (removal.drops_state) {
    SqliteStatement drop(write_, "DELETE FROM state WHERE unit = ?");
    drop.bind(1, std::string_view(removal.unit)).run();
  }
  transaction.commit();
  removed_[removal.unit] = now;
  return true;
}

std::map<std::string, RemovedReadings> SqliteStore::removed() {
  const std::lock_guard lock(read_lock_);
  SqliteStatement select(read_, "SELECT unit, before_key, readings, done FROM removed");
  std::map<std::string, RemovedReadings> removed;
  while (select.next())
    removed[select.text(0)] = {select.integer(1), static_cast<std::uint64_t>(select.integer(2)),
                               select.integer(3) != 0};
  return removed;
}

std::uint64_t SqliteStore::remove_forecasts(std::int64_t before_ms) {
  const std::lock_guard lock(write_lock_);
  SqliteTransaction transaction(write_);
  std::uint64_t count = 0;
  for (const char* sql :
       {"DELETE FROM alarm WHERE time_ms < ? AND number NOT IN (SELECT max(number) FROM alarm "
        "GROUP "
        "BY unit)",
        "DELETE FROM moved WHERE fit IN (SELECT number FROM fit WHERE since_ms < ? AND number < "
        "(SELECT max(number) FROM fit))"}) {
    SqliteStatement(write_, sql).bind(1, before_ms).run();
    count += static_cast<std::uint64_t>(write_.changes());
  }
  transaction.commit();
  return count;
}

std::vector<UnitEvent> SqliteStore::events_after(std::int64_t number) {
  const std::lock_guard lock(read_lock_);
  SqliteStatement select(
      read_, fmt::format("SELECT {} FROM event WHERE number > ? ORDER BY number", event_columns));
  select.bind(1, number);
  return events_in(select);
}

std::vector<UnitEvent> SqliteStore::events_of(const std::string& unit) {
  const std::lock_guard lock(read_lock_);
  SqliteStatement select(
      read_, fmt::format("SELECT {} FROM event WHERE unit = ? ORDER BY number", event_columns));
  select.bind(1, std::string_view(unit));
  return events_in(select);
}

std::uint64_t SqliteStore::count() {
  const std::lock_guard lock(read_lock_);
  SqliteStatement select(read_, "SELECT count(*) FROM reading");
  return select.next() ? static_cast<std::uint64_t>(select.integer(0)) : 0;
}

bool SqliteStore::has_unit(const std::string& unit) {
  const std::lock_guard lock(read_lock_);
  SqliteStatement select(read_,
                         "SELECT EXISTS (SELECT 1 FROM reading WHERE unit = ?) OR EXISTS (SELECT 1 "
                         "FROM event WHERE unit = ?)");
  select.bind(1, std::string_view(unit)).bind(2, std::string_view(unit));
  return select.next() && select.integer(0) != 0;
}

std::vector<std::string> SqliteStore::units() {
  const std::lock_guard lock(read_lock_);
  SqliteStatement select(read_, unit_names);
  std::vector<std::string> units;
  while (select.next()) units.push_back(select.text(0));
  return units;
}

std::int64_t SqliteStore::last_place() {
  const std::lock_guard lock(read_lock_);
  SqliteStatement select(read_, "SELECT coalesce(max(place), 0) FROM reading");
  return select.next() ? select.integer(0) : 0;
}

void SqliteStore::save(const std::string& population, const std::vector<Checkpoint>& states,
                       std::int64_t all_up_to) {
  const std::lock_guard lock(write_lock_);
  SqliteTransaction transaction(write_);
  SqliteStatement insert(write_, "INSERT OR REPLACE INTO state VALUES (?, ?, ?, ?)");
  for (const Checkpoint& each : states) {
    insert.bind(1, std::string_view(each.unit)).bind(2, std::string_view(population));
    insert.bind(3, each.place).bind_bytes(4, each.bytes).run();
  }
  put("population", population);
  put("all_up_to", fmt::format("{}", all_up_to));
  transaction.commit();
}

std::vector<Checkpoint> SqliteStore::states(const std::string& population) {
  const std::lock_guard lock(read_lock_);
  SqliteStatement select(read_, "SELECT unit, place, bytes FROM state WHERE population = ?");
  select.bind(1, std::string_view(population));
  std::vector<Checkpoint> states;
  while (select.next()) states.push_back({select.text(0), select.integer(1), select.text(2)});
  return states;
}

std::int64_t SqliteStore::all_up_to(const std::string& population) {
  const std::lock_guard lock(write_lock_);
  const std::string at = value("all_up_to");
  return at.empty() || value("population") != population ? 0 : std::stoll(at);
}

void SqliteStore::log(const std::vector<AlarmChange>& changes) {
  if (changes.empty()) return;
  const std::lock_guard lock(write_lock_);
  SqliteTransaction transaction(write_);
  SqliteStatement insert(
      write_, "INSERT INTO alarm (unit, time_ms, alarm, risk, place) VALUES (?, ?, ?, ?, ?)");
  for (const AlarmChange& each : changes) {
    insert.bind(1, std::string_view(each.unit)).bind(2, each.time_ms);
    insert.bind(3, std::string_view(name(each.alarm))).bind(4, each.risk).bind(5, each.place).run();
  }
  transaction.commit();
}

std::vector<AlarmChange> SqliteStore::alarms() {
  const std::lock_guard lock(read_lock_);
  SqliteStatement select(
      read_,
      "SELECT unit, time_ms, alarm, risk, place FROM alarm WHERE number IN (SELECT "
      "max(number) FROM alarm GROUP BY unit)");
  std::vector<AlarmChange> changes;
  while (select.next())
    changes.push_back({select.text(0), select.integer(1), alarm_named(select.text(2)),
                       select.number(3), select.integer(4)});
  return changes;
}

std::vector<StoredFit> SqliteStore::fits() {
  const std::lock_guard lock(read_lock_);
  SqliteStatement select(
      read_, "SELECT number, population, since_ms, written_ms, trusted FROM fit ORDER BY number");
  std::vector<StoredFit> fits;
  while (select.next())
    fits.push_back({select.integer(0), select.text(1), select.integer(2), select.integer(3),
                    select.integer(4) != 0});
  return fits;
}

void SqliteStore::begin_fit(const StoredFit& fit, const std::vector<MovedForecast>& moved) {
  const std::lock_guard lock(write_lock_);
  SqliteTransaction transaction(write_);
  SqliteStatement insert(
      write_, "INSERT INTO fit (population, since_ms, written_ms, trusted) VALUES (?, ?, ?, ?)");
  insert.bind(1, std::string_view(fit.population)).bind(2, fit.since_ms).bind(3, fit.written_ms);
  insert.bind(4, std::int64_t{fit.trusted}).run();
  const std::int64_t number = sqlite3_last_insert_rowid(write_.get());
  SqliteStatement each_moved(write_, "INSERT INTO moved VALUES (?, ?, ?)");
  for (const MovedForecast& each : moved) {
    const std::string content = content_of(each);
    each_moved.bind(1, number).bind(2, std::string_view(each.unit));
    each_moved.bind(3, std::string_view(content)).run();
  }
  transaction.commit();
}

std::vector<MovedForecast> SqliteStore::moved(std::int64_t fit) {
  const std::lock_guard lock(read_lock_);
  SqliteStatement select(read_, "SELECT unit, content FROM moved WHERE fit = ? ORDER BY unit");
  select.bind(1, fit);
  std::vector<MovedForecast> moved;
  while (select.next()) moved.push_back(moved_forecast(select.text(0), select.text(1)));
  return moved;
}

std::map<std::string, SentAlarm> SqliteStore::sent_alarms() {
  const std::lock_guard lock(read_lock_);
  SqliteStatement select(read_, "SELECT unit, alarm FROM sent");
  std::map<std::string, SentAlarm> sent;
  while (select.next()) sent[select.text(0)] = sent_alarm(select.text(1));
  return sent;
}

void SqliteStore::note_sent(const std::string& unit, const SentAlarm& alarm, std::int64_t time_ms) {
  const std::lock_guard lock(write_lock_);
  SqliteStatement insert(write_, "INSERT OR REPLACE INTO sent VALUES (?, ?, ?)");
  const std::string text = text_of(alarm);
  insert.bind(1, std::string_view(unit)).bind(2, std::string_view(text)).bind(3, time_ms).run();
}

void SqliteStore::note_file(const std::string& file, std::int64_t bytes) {
  const std::lock_guard lock(write_lock_);
  SqliteStatement insert(write_, "INSERT OR REPLACE INTO file VALUES (?, ?)");
  insert.bind(1, std::string_view(file)).bind(2, bytes).run();
}

std::map<std::string, std::int64_t> SqliteStore::files() {
  const std::lock_guard lock(read_lock_);
  SqliteStatement select(read_, "SELECT name, bytes FROM file");
  std::map<std::string, std::int64_t> files;
  while (select.next()) files[select.text(0)] = select.integer(1);
  return files;
}

}  // namespace

void check_sqlite_place(const std::filesystem::path& file) {
  const std::filesystem::path target = behind_links(file);
  const std::filesystem::path folder = target.parent_path();
  // As LockFile, which is the first to write.
  if (faccessat(AT_FDCWD, folder.c_str(), W_OK | X_OK, AT_EACCESS) != 0)
    fail_to_write(LockFile::beside(file), errno);
  if (faccessat(AT_FDCWD, target.c_str(), R_OK | W_OK, AT_EACCESS) != 0 && errno != ENOENT)
    fail_to_write(file, errno);
}

std::unique_ptr<Store> open_sqlite_store(const std::filesystem::path& file,
                                         const StoreColumns& columns, Access access,
                                         const StoreNotice& reported) {
  return std::make_unique<SqliteStore>(file, columns, access, reported);
}

}  // namespace wearwell::monitor
