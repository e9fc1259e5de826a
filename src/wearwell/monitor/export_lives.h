#pragma once

#include <string>

#include "wearwell/monitor/store.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::monitor {

/// The lives of all parts of a store as CSV, in the unit of the axis: the use of a part at its
/// failure ("failed"), or at its removal, its replacement or its last reading ("suspended"). Sets
/// `count` to the number of parts. Throws StoreError,
/// InputError if a part ended before it was installed.
std::string lives_as_csv(Store& store, const prognosis::Tracker& tracker, std::uint64_t& count);

}  // namespace wearwell::monitor
