#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "wearwell/monitor/message.h"
#include "wearwell/monitor/monitor_config.h"
#include "wearwell/monitor/notices.h"
#include "wearwell/monitor/store.h"
#include "wearwell/monitor/tally.h"

namespace wearwell::monitor {

struct Message {
  std::string topic, payload;
  Form form = Form::any;
  std::string file = {};  ///< that has it, for what is refused
};

/// A reading's fields, for a source that parses its own messages, or why it is invalid.
struct Row {
  std::string unit;  ///< if it is known without the fields
  Fields fields;
  std::string problem = {};
};

/// Accepts messages of all sources, converts them to readings and stores these; waiting ones are
/// stored in one transaction. Any thread may call.
class Intake {
 public:
  /// `stored` is called after every commit. All arguments must outlive it.
  Intake(Store& store, Tally& tally, Notices& notices, std::function<void()> stored)
      : store_(store), tally_(tally), notices_(notices), stored_(std::move(stored)) {}

  /// Returns when all readable messages are stored, or cannot be stored now: then none of them is,
  /// or all are, and they may be delivered again. Unreadable ones are refused and counted; the
  /// others are stored.
  /// `no_events`: why rows that are events are refused; empty: they are not.
  Delivery deliver(const SourceSettings& source, std::span<const Message> messages,
                   const std::string& no_events = {});
  Delivery deliver(const SourceSettings& source, std::span<const Row> rows);

  /// Counts input that is not a message.
  void refuse(const SourceSettings& source, const std::string& problem);

 private:
  struct Refusal {
    std::string unit, problem;
    std::string where = {};  // file and row
  };
  struct Batch {
    std::vector<StoredReading> readings = {};
    std::vector<UnitEvent> events = {};
    std::vector<char> of_study = {};     // whether the study has the unit of each event
    std::vector<Refusal> refusals = {};  // counted when the others are stored, and so only once
    std::size_t rows = 0;
    std::string no_events = {};
    std::vector<Kept> kept = {}, kept_events = {};
    std::string remark = {};  // of an event that was stored already and does not hold
    std::string trouble = {};
    bool unknown_unit = false;
    bool done = false;
  };
  void read(const SourceSettings& source, const Message& message, Batch& batch);
  void read_row(const SourceSettings& source, const Fields& fields, const std::string& unit,
                std::int64_t now_ms, Batch& batch);
  Delivery deliver(const SourceSettings& source, Batch& batch);
  void refuse(const SourceSettings& source, const Refusal& refusal, Delivery& delivery);
  void commit(Batch& batch);
  void commit_events(Batch& batch);
  void admit(const std::string& unit);
  std::string unknown_unit(const UnitEvent& event, bool of_study);
  std::string missing_reference(const UnitEvent& event);
  std::string not_in_force(const UnitEvent& event);
  void store_waiting(std::unique_lock<std::mutex>& lock);

  Store& store_;
  Tally& tally_;
  Notices& notices_;
  std::function<void()> stored_;
  std::mutex lock_;
  std::condition_variable changed_;
  std::vector<Batch*> waiting_;
  bool storing_ = false;
};

/// The inbox of events that are reported by HTTP: one JSON object each, its fields in the units of
/// the study; the topic is the unit's name.
class EventInbox : public Inbox {
 public:
  EventInbox(Intake& intake, const prognosis::Tracker& tracker, bool keys_are_times);
  ReadingMapping& mapping() { return source_.mapping; }
  using Inbox::deliver;
  Delivery deliver(const std::string& unit, const std::string& payload,
                   const std::string& no_events) override;

 private:
  Intake& intake_;
  SourceSettings source_;
};

/// The inbox of one source.
class SourceInbox : public Inbox {
 public:
  SourceInbox(Intake& intake, const SourceSettings& source) : intake_(intake), source_(source) {}
  using Inbox::deliver;
  Delivery deliver(const std::string& topic, const std::string& payload,
                   const std::string& no_events) override {
    const Message message{topic, payload};
    return intake_.deliver(source_, std::span(&message, 1), no_events);
  }

 private:
  Intake& intake_;
  const SourceSettings& source_;
};

}  // namespace wearwell::monitor
