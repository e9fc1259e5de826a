#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/monitor/fit_record.h"
#include "wearwell/monitor/fleet_view.h"
#include "wearwell/monitor/unit_event.h"

namespace wearwell::monitor {

/// A stored reading. A unit has one for each `key`: its sequence number, or its time if the
/// messages have none.
struct StoredReading {
  std::int64_t place = 0;  ///< in the order of storage, from 1; increases, with gaps
  std::string unit;
  std::int64_t key = 0;
  std::int64_t time_ms = 0;      ///< Unix time in the message; 0: none
  std::int64_t received_ms = 0;  ///< Unix time of its arrival
  std::vector<double> numbers;   ///< SI, of Tracker::columns; NaN if missing
  std::vector<std::string> labels;
};

/// The outcome of a reading that was passed to a store.
enum class Kept {
  stored,
  repeated,     ///< the same one is stored already
  contradicts,  ///< another one with its key is stored already, and stays
  too_old       ///< it is of readings that are removed, or an event among these
};

/// The state of a unit after all its readings up to `place`.
struct Checkpoint {
  std::string unit;
  std::int64_t place = 0;
  std::string bytes;
};

struct AlarmChange {
  std::string unit;
  std::int64_t time_ms = 0;
  Alarm alarm = Alarm::ok;  ///< never unknown: silence is not stored
  double risk = 0;
  /// Of the unit's last reading in the risk, by any clock; 0 for a change from before version 2.
  std::int64_t place = 0;
};

/// What a server of alarms has been sent of a unit.
struct SentAlarm {
  Alarm alarm = Alarm::ok;  ///< the one that it has accepted last
  /// Another one was sent since, without an answer that accepts it: it may have that one.
  bool unconfirmed = false;
  bool operator==(const SentAlarm&) const = default;
};
/// "act", "act unconfirmed", and back.
std::string text_of(const SentAlarm& sent);
SentAlarm sent_alarm(std::string_view text);

/// Readings of parts that have long been out of service, which a store need not keep.
struct Removal {
  std::string unit;
  std::int64_t before_key = 0;  ///< they have smaller keys; the first one that may still be added
  std::int64_t last_event = 0;  ///< number of the unit's last event when they were chosen
  std::vector<std::int64_t> places = {};
  bool drops_state = false;  ///< the unit's state is one of these readings
  bool done = false;         ///< no others are to be removed
};

/// What was removed of a unit.
struct RemovedReadings {
  std::int64_t before_key =
      0;  ///< of readings with smaller keys only the last of each part is there
  std::uint64_t count = 0;
  bool done = false;
};

/// The store is temporarily unavailable: the disk is full, the server is away. The operation was
/// not done, or is found as done when it is repeated; it may succeed later.
struct StoreError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Readings and their results, kept by one monitor at a time. Any thread may call; all functions
/// throw StoreError.
class Store {
 public:
  virtual ~Store() = default;

  /// Stores new ones, all or, when it throws, none: after a commit whose answer was lost they are
  /// found as repeats. When it returns they are on disk.
  virtual std::vector<Kept> add(const std::vector<StoredReading>& readings) = 0;

  /// Readings after `place`, in order, at most `count`.
  virtual std::vector<StoredReading> after(std::int64_t place, std::size_t count) = 0;
  /// One unit's readings after `after` and up to `last`, in order.
  virtual void of_unit(const std::string& unit, std::int64_t after, std::int64_t last,
                       const std::function<void(const StoredReading&)>& visit) = 0;
  /// The reading of a unit with this key, as it was stored.
  virtual std::optional<StoredReading> reading(const std::string& unit, std::int64_t key) = 0;
  virtual std::uint64_t count() = 0;
  /// Whether a reading or an event of a unit of this name is stored.
  virtual bool has_unit(const std::string& unit) = 0;
  /// The names of all these units.
  virtual std::vector<std::string> units() = 0;
  /// Of the last stored reading; 0 without any.
  virtual std::int64_t last_place() = 0;

  /// Stores new events, all or, when it throws, none; the same one again counts as repeated. Too old
  /// ones would change what removed readings say.
  virtual std::vector<Kept> add_events(const std::vector<UnitEvent>& events) = 0;
  /// Events with a larger number, in order.
  virtual std::vector<UnitEvent> events_after(std::int64_t number) = 0;
  /// Those of one unit, in order.
  virtual std::vector<UnitEvent> events_of(const std::string& unit) = 0;

  /// States of the units, of this population only (a SHA-1); `all_up_to`: all readings up to there
  /// are included.
  virtual void save(const std::string& population, const std::vector<Checkpoint>& states,
                    std::int64_t all_up_to) = 0;
  virtual std::vector<Checkpoint> states(const std::string& population) = 0;
  virtual std::int64_t all_up_to(const std::string& population) = 0;

  virtual void log(const std::vector<AlarmChange>& changes) = 0;
  /// The last of each unit.
  virtual std::vector<AlarmChange> alarms() = 0;

  /// The fits in the order of their use.
  virtual std::vector<StoredFit> fits() = 0;
  /// From now on forecasts come from this fit (its number is ignored), which has moved these.
  virtual void begin_fit(const StoredFit& fit, const std::vector<MovedForecast>& moved) = 0;
  /// The forecasts that a fit has moved, by unit.
  virtual std::vector<MovedForecast> moved(std::int64_t fit) = 0;

  /// What the server of the webhook has been sent, by unit.
  virtual std::map<std::string, SentAlarm> sent_alarms() = 0;
  virtual void note_sent(const std::string& unit, const SentAlarm& sent, std::int64_t time_ms) = 0;

  /// Removes readings in one transaction; never the last one of the store, whose place would be given
  /// again. Further readings and events before this key are too old from then on. False, with
  /// nothing done, if the unit has other events by now.
  virtual bool remove(const Removal& removal) = 0;
  /// What was removed, by unit.
  virtual std::map<std::string, RemovedReadings> removed() = 0;
  /// Removes alarms from before this Unix time, but the last of each unit, and forecasts moved by
  /// fits that were taken before it, but the last. Returns their number.
  virtual std::uint64_t remove_forecasts(std::int64_t before_ms) = 0;

  /// The position read so far in a file of a folder: bytes.
  virtual void note_file(const std::string& file, std::int64_t bytes) = 0;
  virtual std::map<std::string, std::int64_t> files() = 0;
};

/// The meaning of a store's columns, which guards against misreading.
struct StoreColumns {
  std::vector<std::string> numbers;  ///< names; their values are SI
  std::vector<std::string> labels;
  bool sequence = false;  ///< keys are sequence numbers, else times
};

/// `read`: while a monitor may be running; the store must exist. `copy`: as `read`, only to copy it
/// as a whole, so that its version may be older.
enum class Access { write, read, copy };

/// Takes messages about the opening of a store.
using StoreNotice = std::function<void(const std::string& what)>;

/// There is no store yet: no monitor has run.
struct NoStoreYet : InputError {
  using InputError::InputError;
};

/// Throws as the opening for writing would, before there is a store or beside a running monitor: the
/// folder is missing or cannot be written to, the server is unreachable or lets no tables be made.
/// Leaves nothing.
void check_place(const std::string& url, const std::filesystem::path& folder);

/// Opens or creates a store: a URL "postgresql://...", or else a file of SQLite, relative to
/// `folder`. A writer upgrades an older one in one transaction, and reports it. Throws InputError:
/// a later version, an older one that is only to be read, other columns, no store at all, or in use
/// by another monitor; StoreError.
std::unique_ptr<Store> open_store(const std::string& url, const std::filesystem::path& folder,
                                  const StoreColumns& columns, Access access = Access::write,
                                  const StoreNotice& reported = {});
bool is_postgres(const std::string& url);
/// The name in messages: without credentials.
std::string shown_store(const std::string& url);

/// A URL of PostgreSQL without user and password.
std::string shown_url(const std::string& url);

/// The version of the tables that this program writes. 2: alarms have a place; 3: events of units;
/// 4: fits, moved forecasts, alarms that were sent; 5: readings that were removed.
inline constexpr int store_version = 5;

/// The version of the store `name` from its own text, if it is supported: 1 to `store_version`.
/// Throws InputError.
int check_store(const std::string& name, const std::string& version, const StoreColumns& there,
                const StoreColumns& wanted, Access access);
std::string migrated_text(const std::string& name, int from);

/// Whether an event would change what readings before `before_key` say, which are removed.
/// `cancelled`: the event that it cancels, if it cancels one.
bool is_among_removed(const UnitEvent& event, const std::optional<UnitEvent>& cancelled,
                      std::int64_t before_key);

/// Lists in the store's tables, as JSON: "[1.5,null]", numbers in the shortest form that reads back
/// to the same.
std::string json_of(const std::vector<double>& numbers);
std::string json_of(const std::vector<std::string>& texts);
/// Throw StoreError if it is not such a list.
std::vector<double> numbers_of(std::string_view json);
std::vector<std::string> texts_of(std::string_view json);

}  // namespace wearwell::monitor
