#pragma once

#include <nlohmann/json.hpp>

#include "wearwell/selection/result.h"

namespace wearwell {

/// summary.json of a selection (keys: docs/how-to/select.md). A number that is not finite becomes
/// null.
nlohmann::ordered_json to_json(const SelectionResult& result);

/// The models found, best first, one per row.
std::string models_csv(const SelectionResult& result);

}  // namespace wearwell
