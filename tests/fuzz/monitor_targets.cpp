#include "fuzz/monitor_targets.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "monitor/growth_tracker.h"
#include "wearwell/base/error.h"
#include "wearwell/monitor/event_row.h"
#include "wearwell/monitor/foreign_message.h"
#include "wearwell/monitor/message.h"
#include "wearwell/monitor/reading_mapping.h"
#include "wearwell/monitor/time_text.h"

namespace wearwell::fuzz {
namespace {

using monitor::Fields;
using monitor::ReadingMapping;

constexpr std::int64_t received_ms = 1'795'358'574'763;

void promise(bool kept, const char* what) {
  if (!kept) throw std::logic_error(what);
}

const GrowthTracker& tracker() {
  static const GrowthTracker only;
  return only;
}

ReadingMapping mapping_of(const char* unit, const char* sequence, const char* time) {
  ReadingMapping mapping = monitor::plain_mapping(tracker(), false);
  mapping.unit = unit;
  mapping.sequence = sequence;
  mapping.time = time;
  return mapping;
}

void check_event(const Fields& fields, const ReadingMapping& mapping) {
  const monitor::UnitEvent event = monitor::event_of(fields, "", mapping, received_ms);
  promise(!event.unit.empty() && !event.author.empty(), "an event names its unit and author");
  promise(event.kind != monitor::EventKind::repaired || event.restored > 0,
          "a repair takes something back");
  promise(!monitor::begins_part(event.kind) || event.use >= 0, "a part begins at a use");
  monitor::UnitEvent again = event;
  again.use = std::numeric_limits<double>::quiet_NaN();
  again.offset = again.restored = 0;
  again.numbers.clear();
  again.labels.clear();
  again.cancels = again.alarm_ms = 0;
  monitor::read_content(monitor::content_of(event), again);
  promise(monitor::identity_of(again) == monitor::identity_of(event),
          "a stored event is the event that was reported");
}

void check_row(const Fields& fields, const ReadingMapping& mapping) {
  promise(fields.size() <= monitor::most_fields, "a message has a limited number of fields");
  try {
    if (monitor::is_event(fields, mapping)) return check_event(fields, mapping);
    const monitor::StoredReading reading = monitor::reading_of(fields, "", mapping, received_ms);
    promise(!reading.unit.empty() && reading.unit.size() <= monitor::longest_name,
            "a reading names its unit");
    promise(reading.numbers.size() == tracker().columns().size(), "a reading is whole");
    for (const double each : reading.numbers) promise(std::isfinite(each), "and finite");
    promise(reading.time_ms >= 0 && reading.time_ms <= monitor::latest_unix_ms,
            "its time is of this age");
  } catch (const InputError&) {
  }
}

void refused(const std::string& problem) {
  promise(!problem.empty(), "a refusal has a reason");
}

}  // namespace

void events(std::string_view bytes) {
  const ReadingMapping mapping = mapping_of("machine", "n", "");
  monitor::for_each_row(
      bytes, [&](const Fields& fields) { check_row(fields, mapping); }, refused);
}

void influx(std::string_view bytes) {
  const ReadingMapping mapping = mapping_of("machine", "", "{timestamp}");
  monitor::read_influx(
      bytes, 1'000'000'000, [&](const Fields& fields) { check_row(fields, mapping); }, refused);
}

void opc_ua(std::string_view bytes) {
  const ReadingMapping mapping = mapping_of("{writer}", "", "{timestamp}");
  monitor::read_opc_ua(
      bytes, [&](const Fields& fields) { check_row(fields, mapping); }, refused);
}

}  // namespace wearwell::fuzz
