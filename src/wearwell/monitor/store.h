#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "wearwell/monitor/fleet_view.h"

namespace wearwell::monitor {

/// A reading as it is kept. A unit has one of each `key`: its sequence number, or its time where the messages have none.
struct StoredReading {
  std::int64_t place = 0;  ///< in the order of storage, from 1; grows, with gaps
  std::string unit;
  std::int64_t key = 0;
  std::int64_t time_ms = 0;      ///< Unix time that the message says; 0: none
  std::int64_t received_ms = 0;  ///< Unix time of its arrival
  std::vector<double> numbers;   ///< SI, of Tracker::columns; NaN where there is none
  std::vector<std::string> labels;
};

/// What became of a reading that was handed to a store.
enum class Kept {
  stored,
  repeated,    ///< it is there already, the same
  contradicts  ///< another one is there under its key, and stays
};

/// What is known of a unit after all its readings up to `place`.
struct Checkpoint {
  std::string unit;
  std::int64_t place = 0;
  std::string bytes;
};

struct AlarmChange {
  std::string unit;
  std::int64_t time_ms = 0;
  Alarm alarm = Alarm::ok;  ///< never unknown: silence is not kept
  double risk = 0;
  /// Of the unit's last reading that the risk knew, whatever clocks said; 0 of a change from before version 2.
  std::int64_t place = 0;
};

/// The store could not do it now: the disk is full, the server away. What was asked was not done, or is found when it is asked
/// again; later it may be.
struct StoreError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Readings and what was made of them, kept by one monitor at a time. Any thread may call; all throw StoreError.
class Store {
 public:
  virtual ~Store() = default;

  /// Keeps those that are not there yet, all or, when it throws, none: a commit of which the answer was lost
  /// is found as repeats the next time. When it returns the disk has them.
  virtual std::vector<Kept> add(const std::vector<StoredReading>& readings) = 0;

  /// Readings behind `place`, in order, at most `count`.
  virtual std::vector<StoredReading> after(std::int64_t place, std::size_t count) = 0;
  /// One unit's readings behind `after` and up to `last`, in order.
  virtual void of_unit(const std::string& unit, std::int64_t after, std::int64_t last,
                       const std::function<void(const StoredReading&)>& visit) = 0;
  virtual std::uint64_t count() = 0;

  /// States of the units, of this population alone (a SHA-1); `all_up_to`: all readings up to there are in them.
  virtual void save(const std::string& population, const std::vector<Checkpoint>& states,
                    std::int64_t all_up_to) = 0;
  virtual std::vector<Checkpoint> states(const std::string& population) = 0;
  virtual std::int64_t all_up_to(const std::string& population) = 0;

  virtual void log(const std::vector<AlarmChange>& changes) = 0;
  /// The last of each unit.
  virtual std::vector<AlarmChange> alarms() = 0;

  /// How far a file of a folder has been read: bytes.
  virtual void note_file(const std::string& file, std::int64_t bytes) = 0;
  virtual std::map<std::string, std::int64_t> files() = 0;
};

/// What the columns of a store mean, so that it is never read as something else.
struct StoreColumns {
  std::vector<std::string> numbers;  ///< names; their values are SI
  std::vector<std::string> labels;
  bool sequence = false;  ///< keys are sequence numbers, else times
};

/// `read`: beside a monitor that may be at work; there must be a store.
enum class Access { write, read };

/// Takes what happened to a store when it was opened, in words.
using StoreNotice = std::function<void(const std::string& what)>;

/// Opens or begins a store: a URL "postgresql://...", or else a file of SQLite, found beside `folder`. Who writes brings an older
/// one up to date, in one transaction, and tells. Throws InputError: of a later version, of an older one that is only to be read, of
/// other columns, no store at all, or in use by another monitor; StoreError.
std::unique_ptr<Store> open_store(const std::string& url, const std::filesystem::path& folder,
                                  const StoreColumns& columns, Access access = Access::write,
                                  const StoreNotice& reported = {});
bool is_postgres(const std::string& url);
/// As messages name it: without who logs in.
std::string shown_store(const std::string& url);

/// A URL of PostgreSQL without user and password.
std::string shown_url(const std::string& url);

/// The version of the tables that this program writes. 2: alarms have a place.
inline constexpr int store_version = 2;

/// The version of a store `name` that says this of itself, if it can be gone on with: 1 to `store_version`. Throws InputError.
int check_store(const std::string& name, const std::string& version, const StoreColumns& there,
                const StoreColumns& wanted, Access access);
std::string migrated_text(const std::string& name, int from);

/// Lists as the store's tables have them, JSON: "[1.5,null]", numbers in the shortest form that reads back to the same.
std::string json_of(const std::vector<double>& numbers);
std::string json_of(const std::vector<std::string>& texts);
/// Throw StoreError where it is no such list.
std::vector<double> numbers_of(std::string_view json);
std::vector<std::string> texts_of(std::string_view json);

}  // namespace wearwell::monitor
