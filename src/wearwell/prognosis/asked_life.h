#pragma once

#include <memory>
#include <optional>
#include <string>

#include "wearwell/prognosis/carried_state.h"
#include "wearwell/prognosis/life_bounds.h"
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

/// A question about a life as its options are written; what is empty is not asked.
struct LifeRequest {
  std::string unit, survived, horizon, risk, level, sides;
};
struct ReadLifeRequest {
  LifeQuestion question;
  LifeBounds bounds;
};
/// Throws InputError that names the option: "--risk".
ReadLifeRequest read_life_request(const LifeRequest& request);

}  // namespace wearwell::prognosis
