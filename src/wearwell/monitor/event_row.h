#pragma once

#include "wearwell/monitor/message.h"
#include "wearwell/monitor/reading_mapping.h"
#include "wearwell/monitor/unit_event.h"

namespace wearwell::monitor {

/// Whether a row is an event, not a reading: it has a value in the field `ReadingMapping::event`.
bool is_event(const Fields& fields, const ReadingMapping& mapping);

/// The event in a row: its kind in that field, unit and key as of a reading, who reports it in `by`,
/// and perhaps a `note`. What the counter of use shows is in the field of the axis, the offset of a
/// sensor in that of the measured level; `corrected` has all fields of a reading, `cancelled` the
/// `number` of an event. Throws InputError that names the field and its value.
UnitEvent event_of(const Fields& fields, const std::string& unit, const ReadingMapping& mapping,
                   std::int64_t received_ms);

}  // namespace wearwell::monitor
