#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "wearwell/input/json_reader.h"
#include "wearwell/present/section.h"

namespace wearwell::present {

/// report.json: the content of a report, for rendering it again. A number that is not finite is
/// text: "NaN", "inf", "-inf".
nlohmann::ordered_json to_json(const std::vector<Section>& sections);

/// Throws InputError that names the file and the missing or mistyped key.
std::vector<Section> sections_from_json(const JsonReader& json);

}  // namespace wearwell::present
