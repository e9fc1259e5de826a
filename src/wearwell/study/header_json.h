#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "wearwell/input/json_reader.h"
#include "wearwell/study/result.h"

namespace wearwell {

nlohmann::ordered_json to_json(const Header& header);
nlohmann::ordered_json to_json(const std::vector<Check>& checks);

/// Throws InputError naming file and key of what is missing or has the wrong type, and for a result
/// of another schema, which version wrote it and what to do.
Header read_header(const JsonReader& json);
std::vector<Check> read_checks(const JsonReader& json);

}  // namespace wearwell
