#pragma once

#include <filesystem>
#include <string>

#include "wearwell/prognosis/carried_state.h"
#include "wearwell/prognosis/life_text.h"
#include "wearwell/prognosis/tracker.h"
#include "wearwell/study/model.h"

namespace wearwell {

/// Adds the rows to the study of `state`. Reweights its nodes; where too few carry the weight of the
/// new posterior, rebuilds them. Throws InputError.
prognosis::LifeReadings take_readings(const std::filesystem::path& result,
                                      const std::filesystem::path& readings, Models models,
                                      prognosis::CarriedState& state);

/// Gives them to a part of an S-N study. Throws InputError that names the row that is invalid, is of
/// another part, or cannot count.
prognosis::LifeReadings take_part_readings(const std::filesystem::path& readings,
                                           const prognosis::Tracker& tracker,
                                           const std::string& part, const Source& source,
                                           prognosis::TrackedUnit& unit);

}  // namespace wearwell
