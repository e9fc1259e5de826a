#pragma once

#include <optional>
#include <string>

#include "wearwell/prognosis/carried_state.h"
#include "wearwell/prognosis/known_lives.h"
#include "wearwell/study/model.h"

namespace wearwell::prognosis {

/// The B-life of new units as `wearwell fit` reports it: the study is read with this share and this level of a lower
/// bound in [predict], and answered from its posterior. `point` names the life as for lives_of_study (study_lives.h).
/// None if the study reports no B-life of it. Throws InputError.
std::optional<FittedBLife> fitted_b_life(const CarriedState& state, Models models,
                                         const std::string& title, const std::string& point,
                                         double share, double level);

}  // namespace wearwell::prognosis
