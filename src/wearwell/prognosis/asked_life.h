#pragma once

#include <memory>
#include <optional>
#include <string>

#include "wearwell/prognosis/carried_state.h"
#include "wearwell/prognosis/tracker.h"
#include "wearwell/prognosis/unit_life.h"
#include "wearwell/study/model.h"

namespace wearwell::prognosis {

/// A named part of an S-N study, with what follows it.
struct AskedPart {
  std::unique_ptr<const Tracker> tracker;
  std::string name;
};

/// The part that `unit` names; none in other studies and where it is not the name of a part. Throws
/// InputError if the text is also the name of a stress.
std::optional<AskedPart> asked_part(const CarriedState& state, const std::string& result,
                                    Models models, const std::string& unit);

/// The life that `wearwell life` reports: a named part of an S-N study is found by its name, all
/// else by the lives of the study. `result`: its name in messages. Throws InputError.
UnitLife asked_life(const CarriedState& state, const std::string& result, Models models,
                    const LifeQuestion& question);

/// Throws InputError for a result without a posterior, a clutch campaign; `result`: its name.
void require_posterior(const CarriedState& state, const std::string& result);

/// The value of --risk: "1 %". Throws InputError that names the option.
double tolerated_risk(const std::string& text);

}  // namespace wearwell::prognosis
