#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "wearwell/input/json_reader.h"
#include "wearwell/present/section.h"

namespace wearwell::present {

/// report.json: what a report is made of, so that it can be made anew. A number that is not finite is
/// text: "NaN", "inf", "-inf".
nlohmann::ordered_json to_json(const std::vector<Section>& sections);

/// Throws InputError naming file and key of what is missing or has the wrong type.
std::vector<Section> sections_from_json(const JsonReader& json);

}  // namespace wearwell::present
