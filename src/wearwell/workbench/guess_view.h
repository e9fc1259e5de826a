#pragma once

#include <nlohmann/json.hpp>

#include "wearwell/workbench/session.h"

namespace wearwell::workbench {

/// What `wearwell new --from` makes of a table under the user's choices {"preset", "columns":
/// ["ROLE=HEADING"], "failure", "limit"}, all optional.
/// {readings: [{preset, reading, equal, text, taken, guesses, unstated, questions: [{text, readings:
/// [{text, options}]}]}], roles}: the best first; `equal`: it fits as well as the first. Throws
/// InputError, also if no study follows from the headings.
nlohmann::ordered_json guesses_json(const OpenTable& open, Models models,
                                    const nlohmann::json& choices);

}  // namespace wearwell::workbench
