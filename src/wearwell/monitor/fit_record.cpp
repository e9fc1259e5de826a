#include "wearwell/monitor/fit_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "wearwell/monitor/alarm.h"
#include "wearwell/monitor/fleet_json.h"
#include "wearwell/monitor/store.h"

namespace wearwell::monitor {
namespace {

double number_or_infinity(const nlohmann::json& json) {
  return json.is_null() ? std::numeric_limits<double>::infinity() : json.get<double>();
}

MovedForecast::Side side_in(const nlohmann::json& json) {
  MovedForecast::Side side;
  side.alarm = alarm_named(json.at("alarm").get<std::string>());
  side.known = !json.at("risk").is_null();
  if (!side.known) return side;
  side.risk = json.at("risk");
  const nlohmann::json& remaining = json.at("remaining");
  side.remaining = {number_or_infinity(remaining.at("q05")),
                    number_or_infinity(remaining.at("q50")),
                    number_or_infinity(remaining.at("q95"))};
  return side;
}

MovedForecast::Side side_of(const UnitView& view) {
  return {view.alarm, view.known, view.remaining, view.risk};
}

}  // namespace

std::string content_of(const MovedForecast& moved) {
  return json_of(moved).dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

MovedForecast moved_forecast(const std::string& unit, const std::string& content) {
  try {
    const auto json = nlohmann::json::parse(content);
    return {unit, json.at("last_key"), json.at("axis_unit"), side_in(json.at("before")),
            side_in(json.at("after"))};
  } catch (const nlohmann::json::exception& error) {
    throw StoreError(
        fmt::format("the moved forecast of unit '{}' is damaged: {}", unit, error.what()));
  }
}

double change_of(const MovedForecast& moved) {
  const double before = moved.before.remaining.q50, after = moved.after.remaining.q50;
  if (!moved.before.known && !moved.after.known) return 0;
  if (!moved.before.known || !moved.after.known || std::isinf(before) != std::isinf(after))
    return std::numeric_limits<double>::infinity();
  if (before == after) return 0;
  return before > 0 ? after / before - 1 : std::numeric_limits<double>::infinity();
}

std::vector<MovedForecast> moved_forecasts(const FleetReader& before, const FleetReader& after) {
  std::map<std::string, UnitView> earlier;
  for (UnitView& each : before.units("", 0, SIZE_MAX)) {
    const std::string name = each.unit;
    earlier.emplace(name, std::move(each));
  }
  const std::string axis_unit = after.fleet().axis_unit;
  std::vector<MovedForecast> all;
  for (const UnitView& each : after.units("", 0, SIZE_MAX)) {
    const auto old = earlier.find(each.unit);
    if (old == earlier.end()) continue;
    all.push_back({each.unit, each.last_key, axis_unit, side_of(old->second), side_of(each)});
  }
  sort_by_change(all);
  return all;
}

void sort_by_change(std::vector<MovedForecast>& moved) {
  std::stable_sort(moved.begin(), moved.end(), [](const MovedForecast& a, const MovedForecast& b) {
    return std::abs(change_of(a)) > std::abs(change_of(b));
  });
}

std::string moved_text(const std::vector<MovedForecast>& moved) {
  if (moved.empty()) return "no unit has a forecast yet";
  const MovedForecast& most = moved.front();
  const auto median = [&](const MovedForecast::Side& side) {
    return !side.known ? std::string("unknown")
           : std::isinf(side.remaining.q50)
               ? std::string("never")
               : fmt::format("{:.4g} {}", side.remaining.q50, most.axis_unit);
  };
  return fmt::format(
      "{} unit{}; the median remaining useful life of '{}' changes most, from {} to {}",
      moved.size(), moved.size() == 1 ? "" : "s", most.unit, median(most.before),
      median(most.after));
}

}  // namespace wearwell::monitor
