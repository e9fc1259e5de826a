#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "wearwell/monitor/fleet_view.h"

/// The JSON API's answers (docs/reference/monitor-api.md). Numbers that are not finite become null.
namespace wearwell::monitor {

nlohmann::ordered_json json_of(const FleetView& fleet);
nlohmann::ordered_json json_of(const UnitView& unit);
nlohmann::ordered_json json_of(const UnitDetail& detail);
nlohmann::ordered_json json_of(const MovedForecast& moved);  ///< without the unit
nlohmann::ordered_json json_of(const Delivery& delivery);

/// On one line. Bytes in names that are not UTF-8 become U+FFFD.
std::string text_of(const nlohmann::ordered_json& json);

}  // namespace wearwell::monitor
