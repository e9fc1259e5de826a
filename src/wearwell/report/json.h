#pragma once

#include <nlohmann/json.hpp>

#include "wearwell/report/result.h"

namespace wearwell {

/// summary.json (keys: docs/ARCHITECTURE.md). A number that is not finite becomes null.
nlohmann::ordered_json to_json(const StudyResult& result);

}  // namespace wearwell
