#pragma once

#include "wearwell/prognosis/bytes.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::prognosis {

void save(ByteWriter& to, const Reading& reading);
/// Throws InputError unless it has the tracker's columns.
Reading read_reading(ByteReader& from, const Tracker& tracker);

}  // namespace wearwell::prognosis
