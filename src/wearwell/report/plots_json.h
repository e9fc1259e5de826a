#pragma once

#include <nlohmann/json.hpp>

#include "wearwell/report/plots.h"

namespace wearwell {

/// plots.json of a result folder: what a report draws beyond summary.json and the draws. A number
/// that is not finite is null.
nlohmann::ordered_json to_json(const Plots& plots);

/// Throws nlohmann::json::exception where something is missing or of another type.
Plots plots_from_json(const nlohmann::ordered_json& json);

}  // namespace wearwell
