#include "wearwell/monitor/intake.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/monitor/event_row.h"
#include "wearwell/monitor/foreign_message.h"
#include "wearwell/monitor/time_text.h"
#include "wearwell/monitor/unit_events.h"

namespace wearwell::monitor {

namespace {

std::string too_old_text(const std::string& unit, const std::string& what) {
  return fmt::format(
      "unit '{}': {} of a part whose readings were removed, out of service for longer than "
      "store.keep",
      unit, what);
}

/// Of many rows, the one that is refused: "unit 'M042', n 118: ".
std::string row_text(const Fields& fields, const std::string& unit, const ReadingMapping& mapping) {
  std::vector<std::string> parts;
  if (!unit.empty()) parts.push_back(fmt::format("unit '{}'", printable(shortened(unit))));
  const Field* const key =
      find_field(fields, mapping.sequence.empty() ? mapping.time : mapping.sequence);
  if (key && !key->text.empty()) {
    parts.push_back(fmt::format("{} {}", key->name, printable(shortened(key->text))));
  } else if (key && key->kind == Field::Kind::number) {
    parts.push_back(key->whole ? fmt::format("{} {}", key->name, key->integer)
                               : fmt::format("{} {}", key->name, key->number));
  }
  return parts.empty() ? "" : fmt::format("{}: ", fmt::join(parts, ", "));
}

}  // namespace

Delivery Intake::deliver(const SourceSettings& source, std::span<const Message> messages,
                         const std::string& no_events) {
  Batch batch;
  batch.no_events = no_events;
  for (const Message& message : messages) {
    const std::size_t before = batch.refusals.size();
    read(source, message, batch);
    for (std::size_t i = before; i < batch.refusals.size() && !message.file.empty(); ++i)
      batch.refusals[i].where = message.file + ": " + batch.refusals[i].where;
  }
  return deliver(source, batch);
}

Delivery Intake::deliver(const SourceSettings& source, std::span<const Row> rows) {
  const std::int64_t now = unix_ms_now();
  Batch batch;
  for (const Row& row : rows) {
    if (row.problem.empty()) {
      read_row(source, row.fields, row.unit, now, batch);
    } else {
      ++batch.rows;
      batch.refusals.push_back({row.unit, row.problem});
    }
  }
  return deliver(source, batch);
}

Delivery Intake::deliver(const SourceSettings& source, Batch& batch) {
  Delivery delivery;
  if (!batch.readings.empty()) commit(batch);
  // They are stored even if the events that follow cannot be, and then come again as repeats.
  const auto stored = std::count(batch.kept.begin(), batch.kept.end(), Kept::stored);
  tally_.stored(static_cast<std::uint64_t>(stored));
  // After the readings: an event may be of one in the same message.
  if (!batch.events.empty() && batch.trouble.empty()) commit_events(batch);
  if (!batch.trouble.empty()) {
    delivery.problem = batch.trouble;
    return delivery;
  }
  delivery.stored = true;
  delivery.unknown_unit = batch.unknown_unit;
  tally_.messages(batch.rows, unix_ms_now());
  for (const Refusal& each : batch.refusals) refuse(source, each, delivery);
  for (std::size_t i = 0; i < batch.kept.size(); ++i) {
    const StoredReading& each = batch.readings[i];
    if (batch.kept[i] == Kept::stored) {
      ++delivery.readings;
    } else if (batch.kept[i] == Kept::repeated) {
      ++delivery.repeated;
      tally_.repeated(each.unit);
    } else if (batch.kept[i] == Kept::too_old) {
      refuse(source, {each.unit, too_old_text(each.unit, "a reading")}, delivery);
    } else {
      const bool sequence = !source.mapping.sequence.empty();
      const std::string which =
          sequence ? fmt::format("with number {}", each.key) : "of " + iso_of_unix_ms(each.key);
      refuse(source,
             {each.unit,
              fmt::format("unit '{}': another reading {} is stored already, with other values",
                          each.unit, which)},
             delivery);
    }
  }
  for (const Kept each : batch.kept_events) {
    if (each != Kept::too_old) ++(each == Kept::stored ? delivery.events : delivery.repeated);
  }
  if (delivery.problem.empty()) delivery.problem = batch.remark;
  return delivery;
}

void Intake::refuse(const SourceSettings& source, const std::string& problem) {
  Delivery ignored;
  tally_.messages(1, unix_ms_now());
  refuse(source, {"", problem}, ignored);
}

void Intake::refuse(const SourceSettings& source, const Refusal& refusal, Delivery& delivery) {
  ++delivery.refused;
  const std::string problem = refusal.where + refusal.problem;
  if (delivery.problem.empty()) delivery.problem = problem;
  tally_.refused(refusal.unit, refusal.problem);
  notices_.tell(fmt::format("source.{}", source.name), "refused: " + problem);
}

void Intake::read(const SourceSettings& source, const Message& message, Batch& batch) {
  const std::int64_t now = unix_ms_now();
  const auto refuse_row = [&](const std::string& unit, const std::string& problem) {
    ++batch.rows;
    batch.refusals.push_back({unit, problem});
  };
  std::string unit;
  const auto refuse_message = [&](const std::string& problem) {
    const std::string topic =
        message.topic.empty() ? std::string()
                              : fmt::format(" of topic '{}'", printable(shortened(message.topic)));
    refuse_row(unit, fmt::format("the message{} {}", topic, problem));
  };
  if (source.mapping.unit.empty()) {
    const auto named = source.topic.unit(message.topic);
    if (!named) return refuse_message("has no unit");
    unit = *named;
  }
  const auto row = [&](const Fields& fields) { read_row(source, fields, unit, now, batch); };
  const MessageFormat& format = source.format;
  if (format.form == Form::influx) {
    read_influx(message.payload, format.per_second, row, refuse_message);
  } else if (format.form == Form::opc_ua) {
    read_opc_ua(message.payload, row, refuse_message, message.form);
  } else {
    for_each_row(message.payload, row, refuse_message, message.form);
  }
}

void Intake::read_row(const SourceSettings& source, const Fields& fields, const std::string& unit,
                      std::int64_t now_ms, Batch& batch) {
  ++batch.rows;
  try {
    if (is_event(fields, source.mapping)) {
      if (!batch.no_events.empty()) throw InputError(batch.no_events);
      UnitEvent event = event_of(fields, unit, source.mapping, now_ms);
      const auto& in_study = source.mapping.in_study;
      batch.of_study.push_back(in_study && in_study(event.unit));
      batch.events.push_back(std::move(event));
      return;
    }
    StoredReading reading = reading_of(fields, unit, source.mapping, now_ms);
    admit(reading.unit);
    batch.readings.push_back(std::move(reading));
  } catch (const InputError& error) {
    const Field* named = unit.empty() ? find_field(fields, source.mapping.unit) : nullptr;
    const std::string whose = named ? named->text : unit;
    batch.refusals.push_back({whose, error.what(), row_text(fields, whose, source.mapping)});
  }
}

void Intake::admit(const std::string& unit) {
  if (!tally_.admit(unit))
    throw InputError(
        fmt::format("'{}' is a new unit, and the number of units has reached limits.units", unit));
}

void Intake::commit(Batch& batch) {
  std::unique_lock lock(lock_);
  waiting_.push_back(&batch);
  // The first idle caller stores for all that wait.
  while (!batch.done) {
    if (storing_) {
      changed_.wait(lock);
    } else {
      store_waiting(lock);
    }
  }
}

/// Why an event has another unit than it names: most often the name is misspelt. Asks the store, not
/// the fleet, which may still have to process the unit's first readings.
std::string Intake::unknown_unit(const UnitEvent& event, bool of_study) {
  if (begins_unit(event.kind) || of_study || store_.has_unit(event.unit)) return {};
  return fmt::format(
      "{}: '{}' is not a unit: no reading or event of it is stored, and the study does not have "
      "it; "
      "correct the name, or report \"installed\" first if it is a new one",
      name(event.kind), printable(shortened(event.unit)));
}

/// What an event refers to and the store does not have; empty if it is there.
std::string Intake::missing_reference(const UnitEvent& event) {
  if (!needs_reference(event.kind)) return {};
  if (event.kind == EventKind::acknowledged)
    return store_.has_unit(event.unit)
               ? std::string()
               : fmt::format("acknowledged: '{}' is not a unit with an alarm", event.unit);
  if (event.kind != EventKind::cancelled) {
    if (store_.reading(event.unit, event.key)) return {};
    return fmt::format("{}: unit '{}' has no stored reading with key {}", name(event.kind),
                       event.unit, event.key);
  }
  for (const UnitEvent& each : store_.events_of(event.unit)) {
    if (each.number == event.cancels && each.kind != EventKind::cancelled) return {};
  }
  return fmt::format("cancelled: unit '{}' has no event with number {}", event.unit, event.cancels);
}

std::string Intake::not_in_force(const UnitEvent& event) {
  return UnitEvents(store_.events_of(event.unit), {}).not_in_force(event);
}

void Intake::commit_events(Batch& batch) {
  try {
    std::vector<UnitEvent> events;
    std::vector<Refusal> refusals;
    std::set<std::string> begun;  // by events of this message
    for (std::size_t i = 0; i < batch.events.size(); ++i) {
      const UnitEvent& each = batch.events[i];
      const std::string unknown =
          unknown_unit(each, batch.of_study[i] || begun.contains(each.unit));
      batch.unknown_unit |= !unknown.empty();
      const std::string missing = unknown.empty() ? missing_reference(each) : unknown;
      try {
        if (!missing.empty()) throw InputError(missing);
        admit(each.unit);
        if (begins_unit(each.kind)) begun.insert(each.unit);
        events.push_back(each);
      } catch (const InputError& error) {
        refusals.push_back({each.unit, error.what()});
      }
    }
    batch.kept_events = store_.add_events(events);
    for (std::size_t i = 0; i < events.size(); ++i) {
      const Kept kept = batch.kept_events[i];
      if (kept == Kept::too_old)
        refusals.push_back({events[i].unit, too_old_text(events[i].unit, "an event")});
      if (kept == Kept::repeated && batch.remark.empty()) batch.remark = not_in_force(events[i]);
    }
    batch.refusals.insert(batch.refusals.end(), refusals.begin(), refusals.end());
    stored_();
  } catch (const std::exception& error) {
    batch.trouble = *error.what() ? error.what() : "the store failed";
    notices_.tell("store", fmt::format("cannot store events, which wait: {}", batch.trouble));
  }
}

EventInbox::EventInbox(Intake& intake, const prognosis::Tracker& tracker, bool keys_are_times)
    : intake_(intake) {
  source_.name = "http";
  source_.mapping = plain_mapping(tracker, keys_are_times);
}

Delivery EventInbox::deliver(const std::string& unit, const std::string& payload,
                             const std::string& no_events) {
  Row row{unit, {}, no_events};
  if (!no_events.empty()) return intake_.deliver(source_, std::span(&row, 1));
  try {
    row.fields = fields_of_json(payload);
    if (!is_event(row.fields, source_.mapping))
      row.problem = fmt::format("event is missing: one of {}", event_names());
    const Field* key = find_field(row.fields, "key");
    constexpr double seconds_end = 1e11;  // as milliseconds: the year 1973
    if (!source_.mapping.time.empty() && key && key->number > 0 && key->number < seconds_end)
      row.problem = fmt::format(
          "key is {}, which is a time in the year {}; it is a Unix time in milliseconds, not "
          "seconds",
          key->integer, iso_of_unix_ms(key->integer).substr(0, 4));
  } catch (const InputError& error) {
    row.problem = fmt::format("the event {}", error.what());
  }
  return intake_.deliver(source_, std::span(&row, 1));
}

void Intake::store_waiting(std::unique_lock<std::mutex>& lock) {
  storing_ = true;
  const std::vector<Batch*> batches = std::move(waiting_);
  waiting_.clear();
  lock.unlock();
  std::string trouble;
  std::vector<Kept> kept;
  try {
    if (batches.size() == 1) {
      kept = store_.add(batches.front()->readings);
    } else {
      std::vector<StoredReading> all;
      for (const Batch* each : batches)
        all.insert(all.end(), each->readings.begin(), each->readings.end());
      kept = store_.add(all);
    }
  } catch (const std::exception& error) {
    trouble = error.what();
    if (trouble.empty()) trouble = "the store failed";
    notices_.tell("store", fmt::format("cannot store readings, which wait: {}", trouble));
  }
  lock.lock();
  std::size_t at = 0;
  for (Batch* each : batches) {
    each->trouble = trouble;
    if (trouble.empty()) {
      each->kept.assign(kept.begin() + static_cast<std::ptrdiff_t>(at),
                        kept.begin() + static_cast<std::ptrdiff_t>(at + each->readings.size()));
      at += each->readings.size();
    }
    each->done = true;
  }
  storing_ = false;
  changed_.notify_all();
  if (trouble.empty()) {
    lock.unlock();
    stored_();
    lock.lock();
  }
}

}  // namespace wearwell::monitor
