#include "wearwell/monitor/event_row.h"

#include <fmt/format.h>

#include <algorithm>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"

namespace wearwell::monitor {
namespace {

std::string text_in(const Fields& fields, const char* name, std::size_t most) {
  const Field* field = find_field(fields, name);
  if (!field || field->kind == Field::Kind::null) return {};
  const bool written = field->kind == Field::Kind::text || field->whole || !field->text.empty();
  const std::string text = field->kind == Field::Kind::text || !field->text.empty()
                               ? field->text
                               : fmt::format("{}", field->integer);
  if (!written || text.size() > most || printable(text) != text)
    throw InputError(fmt::format("{} must be a text of at most {} bytes without control characters",
                                 name, most));
  return text;
}

EventKind kind_of(const Fields& fields, const ReadingMapping& mapping) {
  const Field& field = *find_field(fields, mapping.event);
  if (const auto kind = event_named(field.text)) return *kind;
  throw InputError(fmt::format("{} is '{}', but must be one of {}", printable(mapping.event),
                               printable(shortened(field.text)), event_names()));
}

/// The amount that a repair takes back, a difference of levels. The level's own field could be meant
/// as what is left after the repair.
double restored_in(const Fields& fields, const ReadingMapping& mapping) {
  if (!mapping.watched.level) return std::numeric_limits<double>::quiet_NaN();
  const ColumnField& level = mapping.columns[*mapping.watched.level];
  const Field* shown = level.field.empty() ? nullptr : find_field(fields, level.field);
  if (shown && shown->kind != Field::Kind::null &&
      !(shown->kind == Field::Kind::text && shown->text.empty()))
    throw InputError(
        fmt::format("repaired: {} could be what the repair takes back or what is left after it; "
                    "give the amount "
                    "that it takes back as restored, in {}, and what is left as a reading",
                    printable(level.field), level.unit.text));
  ColumnField amount = level;
  amount.field = "restored";
  amount.constant.reset();
  if (!find_field(fields, amount.field))
    throw InputError(fmt::format(
        "repaired: restored is missing: the amount of {} that the repair takes back, in {}; if the "
        "part is as good as new, report \"replaced\"",
        level.column, level.unit.text));
  return value_of(fields, amount) - to_si(level.unit, 0);
}

/// The name of a part, in a field of its own that no mapping uses otherwise.
std::string part_in(const Fields& fields, const ReadingMapping& mapping, EventKind kind) {
  constexpr const char* field = "part_name";
  const auto is_column = [&](const ColumnField& each) { return each.field == field; };
  if (mapping.unit == field ||
      std::any_of(mapping.columns.begin(), mapping.columns.end(), is_column) ||
      std::find(mapping.labels.begin(), mapping.labels.end(), field) != mapping.labels.end())
    return {};
  std::string part = text_in(fields, field, longest_name);
  if (!part.empty() && !begins_part(kind))
    throw InputError(
        fmt::format("{}: {} is for \"installed\" and \"replaced\" alone", name(kind), field));
  return part;
}

}  // namespace

bool is_event(const Fields& fields, const ReadingMapping& mapping) {
  if (mapping.event.empty()) return false;
  const Field* field = find_field(fields, mapping.event);
  return field && field->kind != Field::Kind::null &&
         !(field->kind == Field::Kind::text && field->text.empty());
}

UnitEvent event_of(const Fields& fields, const std::string& unit, const ReadingMapping& mapping,
                   std::int64_t received_ms) {
  constexpr std::size_t longest_note = 1000;
  UnitEvent event;
  event.kind = kind_of(fields, mapping);
  const bool corrected = event.kind == EventKind::corrected;
  const bool cancelled = event.kind == EventKind::cancelled;
  const bool acknowledged = event.kind == EventKind::acknowledged;
  // An event needs no time beside a sequence number, and one that is not at a reading neither.
  ReadingMapping identity = mapping;
  const bool has_no_key = cancelled || acknowledged;
  if (has_no_key || !identity.sequence.empty()) identity.time = "";
  if (has_no_key) identity.sequence = "";
  const StoredReading at = corrected ? reading_of(fields, unit, identity, received_ms)
                                     : identity_of(fields, unit, identity, received_ms);
  event.unit = at.unit;
  event.key = at.key;
  event.received_ms = received_ms;
  event.author = text_in(fields, "by", longest_name);
  event.note = text_in(fields, "note", longest_note);
  event.part = part_in(fields, mapping, event.kind);
  if (corrected) {
    event.numbers = at.numbers;
    event.labels = at.labels;
  } else if (cancelled) {
    const Field* number = find_field(fields, "number");
    if (!number || !number->whole || number->integer < 1)
      throw InputError("number must be a whole number: of the event that is cancelled");
    event.cancels = number->integer;
  } else if (acknowledged) {
    const Field* since = find_field(fields, "alarm_ms");
    if (!since || !since->whole || since->integer < 1)
      throw InputError(
          "alarm_ms must be a whole number: since when the alarm that is acknowledged holds, as "
          "the unit reports it");
    event.alarm_ms = since->integer;
  } else if (event.kind == EventKind::sensor) {
    // A difference of levels, whatever the zero of the unit is.
    if (mapping.watched.level) {
      const ColumnField& level = mapping.columns[*mapping.watched.level];
      event.offset = value_of(fields, level) - to_si(level.unit, 0);
    }
  } else if (event.kind == EventKind::repaired) {
    event.restored = restored_in(fields, mapping);
  } else if (event.kind != EventKind::withdrawn) {
    event.use = value_of(fields, mapping.columns[mapping.watched.axis]);
  }
  if (mapping.event_problem) {
    if (const std::string why = mapping.event_problem(event); !why.empty()) throw InputError(why);
  }
  return event;
}

}  // namespace wearwell::monitor
