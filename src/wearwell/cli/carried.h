#pragma once

#include <filesystem>

#include "wearwell/prognosis/carried_state.h"
#include "wearwell/study/study.h"

namespace wearwell {

/// state.bin of a result. Throws InputError as read_state does; of a clutch campaign without one with what to do instead.
prognosis::CarriedState read_carried_data(const std::filesystem::path& result);

/// The same with a posterior, which a clutch campaign does not have.
prognosis::CarriedState read_carried(const std::filesystem::path& result);

/// How the result was fitted, by its summary.json: method, chains and seed. Nothing where there is none.
SamplerChoice sampler_of(const std::filesystem::path& result);

}  // namespace wearwell
