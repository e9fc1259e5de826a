#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "wearwell/report/json_reader.h"
#include "wearwell/report/plots.h"
#include "wearwell/report/result.h"

namespace wearwell {

/// plots.json: what the report draws beyond summary.json and the draws. A number that is not finite
/// is null.
nlohmann::ordered_json to_json(const Plots& plots);

/// Throws InputError naming file and key of what is missing or has the wrong type.
Plots plots_from_json(const JsonReader& json);

/// Throws InputError where columns of a plot differ in length, or plots and result in what they are
/// of.
void require_consistent(const Plots& plots, const StudyResult& result,
                        const std::filesystem::path& file);

}  // namespace wearwell
