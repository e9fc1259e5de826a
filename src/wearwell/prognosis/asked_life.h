#pragma once

#include <string>

#include "wearwell/prognosis/carried_state.h"
#include "wearwell/prognosis/unit_life.h"
#include "wearwell/study/model.h"

namespace wearwell::prognosis {

/// The life that `wearwell life` reports: a named part of an S-N study is found by its name, all
/// else by the lives of the study. `result`: its name in messages. Throws InputError.
UnitLife asked_life(const CarriedState& state, const std::string& result, Models models,
                    const LifeQuestion& question);

/// Throws InputError for a result without a posterior, a clutch campaign; `result`: its name.
void require_posterior(const CarriedState& state, const std::string& result);

/// The value of --risk: "1 %". Throws InputError that names the option.
double tolerated_risk(const std::string& text);

}  // namespace wearwell::prognosis
