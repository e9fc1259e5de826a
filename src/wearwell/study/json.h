#pragma once

#include <nlohmann/json.hpp>

#include "wearwell/study/posterior_summary.h"

namespace wearwell {

/// The values of the keys `parameters` and `loo` in summary.json, which `wearwell compare` reads
/// for any model.
nlohmann::ordered_json to_json(const std::vector<ParameterSummary>& parameters);
nlohmann::ordered_json to_json(const LooSummary& summary);

/// The body of summary.json of a posterior, after the header (keys: docs/ARCHITECTURE.md). A number
/// that is not finite becomes null.
nlohmann::ordered_json posterior_json(const PosteriorSummary& result);

}  // namespace wearwell
