#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "wearwell/input/json_reader.h"
#include "wearwell/study/result.h"

namespace wearwell {

nlohmann::ordered_json to_json(const Header& header);
nlohmann::ordered_json to_json(const std::vector<Check>& checks);

/// Throws InputError that names the file and the missing or mistyped key. For another schema
/// version the message names the version that wrote the result and the remedy.
Header read_header(const JsonReader& json);
std::vector<Check> read_checks(const JsonReader& json);

}  // namespace wearwell
