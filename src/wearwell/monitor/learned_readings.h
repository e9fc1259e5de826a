#pragma once

#include <string>
#include <vector>

#include "wearwell/monitor/store.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::monitor {

/// Why a fit would count readings twice: `units` have stored readings, and its study has readings of
/// them that the study of the present fit does not have (`wearwell update` with exported ones). A
/// unit that both have counts as grown if its farthest reading lies farther. Empty if it would not.
std::string learned_units(const prognosis::Tracker& present, const prognosis::Tracker& now,
                          const std::vector<std::string>& units);

/// The same from the store alone, at a start, when the earlier fit is not there to be compared: the
/// farthest reading of a unit in the study is one of its stored readings. Throws StoreError.
std::string learned_from(Store& store, const prognosis::Tracker& now);

/// At a start with the fit `population`: throws InputError if the store was last monitored with
/// another fit and this one has learned readings of it.
void refuse_learned(Store& store, const std::string& population, const prognosis::Tracker& now);

}  // namespace wearwell::monitor
