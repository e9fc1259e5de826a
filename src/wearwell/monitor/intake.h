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
};

/// A reading's fields, where a source reads its messages itself, or why there is none.
struct Row {
  std::string unit;  ///< where it is known without the fields
  Fields fields;
  std::string problem = {};
};

/// Takes messages of all sources, makes readings of them and stores these; those that wait at the same time are stored in one
/// transaction. Any thread may call.
class Intake {
 public:
  /// `stored` is called after every commit. All outlive it.
  Intake(Store& store, Tally& tally, Notices& notices, std::function<void()> stored)
      : store_(store), tally_(tally), notices_(notices), stored_(std::move(stored)) {}

  /// Returns when all that can be read of them is stored, or cannot be now: then nothing of them is, or all, and they may
  /// be delivered again. What cannot be read is refused and counted; it does not keep the others from being stored.
  Delivery deliver(const SourceSettings& source, std::span<const Message> messages);
  Delivery deliver(const SourceSettings& source, std::span<const Row> rows);

  /// Counts what is no message at all.
  void refuse(const SourceSettings& source, const std::string& problem);

 private:
  struct Refusal {
    std::string unit, problem;
  };
  struct Batch {
    std::vector<StoredReading> readings = {};
    std::vector<Refusal> refusals = {};  // counted when the others are stored, and so once
    std::size_t rows = 0;
    std::vector<Kept> kept = {};
    std::string trouble = {};
    bool done = false;
  };
  void read(const SourceSettings& source, const Message& message, Batch& batch);
  void read_row(const SourceSettings& source, const Fields& fields, const std::string& unit,
                std::int64_t now_ms, Batch& batch);
  Delivery deliver(const SourceSettings& source, Batch& batch);
  void refuse(const SourceSettings& source, const Refusal& refusal, Delivery& delivery);
  void commit(Batch& batch);
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

/// The inbox of one source.
class SourceInbox : public Inbox {
 public:
  SourceInbox(Intake& intake, const SourceSettings& source) : intake_(intake), source_(source) {}
  Delivery deliver(const std::string& topic, const std::string& payload) override {
    const Message message{topic, payload};
    return intake_.deliver(source_, std::span(&message, 1));
  }

 private:
  Intake& intake_;
  const SourceSettings& source_;
};

}  // namespace wearwell::monitor
