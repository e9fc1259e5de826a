#pragma once

#include <filesystem>

#include "wearwell/prognosis/carried_state.h"
#include "wearwell/study/study.h"

namespace wearwell {

/// Reads state.bin of a result. Throws InputError as read_state does; for a clutch campaign without
/// state.bin the message names the remedy.
prognosis::CarriedState read_carried_data(const std::filesystem::path& result);

/// The same for results with a posterior; a clutch campaign has none.
prognosis::CarriedState read_carried(const std::filesystem::path& result);

/// How the result was fitted, by its summary.json (prognosis/update.h). Empty where there is none.
SamplerChoice sampler_of(const std::filesystem::path& result);

}  // namespace wearwell
