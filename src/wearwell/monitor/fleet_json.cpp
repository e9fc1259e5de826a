#include "wearwell/monitor/fleet_json.h"
#include "wearwell/base/printable.h"

#include <cmath>

namespace wearwell::monitor {
namespace {

using Json = nlohmann::ordered_json;

Json number(double x) {
  return std::isfinite(x) ? Json(x) : Json(nullptr);
}

Json json_of_interval(const Interval& interval) {
  return {
      {"q05", number(interval.q05)}, {"q50", number(interval.q50)}, {"q95", number(interval.q95)}};
}

// For a unit of unknown state there are no numbers.
Json json_of_known(const UnitView& unit, double x) {
  return unit.known ? number(x) : Json(nullptr);
}

Json json_of_known(const UnitView& unit, const Interval& interval) {
  return unit.known ? json_of_interval(interval) : Json(nullptr);
}

Json json_of_change(const std::optional<RateChangeView>& change) {
  if (!change) return nullptr;
  return {{"probability", number(change->probability)},
          {"since", json_of_interval(change->since)},
          {"factor", json_of_interval(change->factor)}};
}

Json json_of_moment(const UnitMoment& moment) {
  return {{"key", moment.key},
          {"time_ms", moment.time_ms},
          {"at", number(moment.at)},
          {"measured", moment.measured ? number(*moment.measured) : Json(nullptr)},
          {"level", json_of_interval(moment.level)},
          {"life", json_of_interval(moment.life)}};
}

Json json_of_event(const EventView& view) {
  const UnitEvent& event = view.event;
  Json json = {{"number", event.number}, {"event", name(event.kind)}};
  if (event.kind == EventKind::cancelled) {
    json["cancels"] = event.cancels;
  } else if (event.kind == EventKind::acknowledged) {
    json["alarm_ms"] = event.alarm_ms;
    json["cancelled"] = view.cancelled;
  } else {
    json["key"] = event.key;
    json["cancelled"] = view.cancelled;
  }
  if (std::isfinite(view.use)) json["use"] = view.use;
  if (event.kind == EventKind::sensor) json["offset"] = view.offset;
  if (event.kind == EventKind::repaired) json["restored"] = view.restored;
  if (!event.part.empty()) json["part_name"] = event.part;
  for (const auto& [column, value] : view.values) json["values"][column] = number(value);
  json["received_ms"] = event.received_ms;
  json["by"] = event.author;
  json["note"] = event.note;
  return json;
}

Json json_of_side(const MovedForecast::Side& side) {
  return {{"alarm", name(side.alarm)},
          {"risk", side.known ? number(side.risk) : Json(nullptr)},
          {"remaining", side.known ? json_of_interval(side.remaining) : Json(nullptr)}};
}

}  // namespace

Json json_of(const MovedForecast& moved) {
  return {{"last_key", moved.last_key},
          {"axis_unit", moved.axis_unit},
          {"before", json_of_side(moved.before)},
          {"after", json_of_side(moved.after)}};
}

Json json_of(const FleetView& fleet) {
  Json columns = Json::array();
  for (const ColumnView& each : fleet.columns)
    columns.push_back(
        {{"name", each.name}, {"unit", each.unit.empty() ? Json(nullptr) : Json(each.unit)}});
  return {{"title", fleet.title},
          {"noun", fleet.noun},
          {"axis", fleet.axis},
          {"axis_unit", fleet.axis_unit},
          {"limited", fleet.limited},
          {"level_unit", fleet.level_unit},
          {"limit", number(fleet.limit)},
          {"horizon", number(fleet.horizon)},
          {"keys", fleet.keys_are_times ? "time" : "sequence"},
          {"columns", std::move(columns)},
          {"level_column", fleet.level_column ? Json(fleet.level_column->name) : Json(nullptr)},
          {"trusted", fleet.trusted},
          {"fit",
           {{"fingerprint", fleet.fit.fingerprint},
            {"written_ms", fleet.fit.written_ms},
            {"since_ms", fleet.fit.since_ms}}},
          {"webhook", fleet.webhook ? Json{{"sent", fleet.webhook->sent},
                                           {"failed", fleet.webhook->failed},
                                           {"waiting", fleet.webhook->waiting}}
                                    : Json(nullptr)},
          {"units",
           {{"all", fleet.units},
            {"act", fleet.act},
            {"doubt", fleet.doubt},
            {"watch", fleet.watch},
            {"ok", fleet.ok},
            {"unknown", fleet.unknown}}},
          {"messages",
           {{"received", fleet.messages},
            {"stored", fleet.stored},
            {"refused", fleet.refused},
            {"repeated", fleet.repeated},
            {"last_ms", fleet.last_message_ms},
            {"lag_ms", fleet.lag_ms}}},
          {"now_ms", fleet.now_ms},
          {"started_ms", fleet.started_ms}};
}

Json json_of(const UnitView& unit) {
  return {{"unit", unit.unit},
          {"alarm", name(unit.alarm)},
          {"alarm_ms", unit.alarm_ms},
          {"acknowledged_by",
           unit.acknowledged_by.empty() ? Json(nullptr) : Json(unit.acknowledged_by)},
          {"known", unit.known},
          {"at", json_of_known(unit, unit.at)},
          {"last_key", unit.last_key},
          {"last_reading_ms", unit.last_reading_ms},
          {"level", json_of_known(unit, unit.level)},
          {"remaining", json_of_known(unit, unit.remaining)},
          {"b10", json_of_known(unit, unit.b10)},
          {"numerical_error", json_of_known(unit, unit.numerical_error)},
          {"risk", json_of_known(unit, unit.risk)},
          {"passed", json_of_known(unit, unit.passed)},
          {"rate_change", json_of_change(unit.rate_change)},
          {"doubt", unit.doubt.empty() ? Json(nullptr) : Json(unit.doubt)},
          {"beyond", unit.beyond},
          {"part", unit.part},
          {"service", name(unit.service)},
          {"quality",
           {{"readings", unit.quality.readings},
            {"repeated", unit.quality.repeated},
            {"late", unit.quality.late},
            {"contradicting", unit.quality.contradicting},
            {"refused", unit.quality.refused},
            {"last_problem", unit.quality.last_problem}}}};
}

Json json_of(const UnitDetail& detail) {
  Json moments = Json::array(), path = Json::array(), survival = Json::array();
  for (const UnitMoment& each : detail.moments) moments.push_back(json_of_moment(each));
  for (const auto& [at, level] : detail.path) {
    path.push_back({{"at", number(at)}, {"level", json_of_interval(level)}});
  }
  for (const auto& [remaining, probability] : detail.survival) {
    survival.push_back({{"remaining", number(remaining)}, {"survival", number(probability)}});
  }
  Json json = json_of(detail.view);
  Json events = Json::array();
  for (const EventView& each : detail.events) events.push_back(json_of_event(each));
  json["events"] = std::move(events);
  json["moments"] = std::move(moments);
  json["path"] = std::move(path);
  json["survival"] = std::move(survival);
  json["forecasts"] = {{"judged", detail.judged}, {"held", detail.held}};
  json["moved"] = detail.moved ? json_of(*detail.moved) : Json(nullptr);
  return json;
}

Json json_of(const Delivery& delivery) {
  return {{"stored", delivery.stored},   {"readings", delivery.readings},
          {"events", delivery.events},   {"repeated", delivery.repeated},
          {"refused", delivery.refused}, {"problem", delivery.problem}};
}

std::string text_of(const Json& json) {
  return printable_json(json.dump(-1, ' ', false, Json::error_handler_t::replace)) + "\n";
}

}  // namespace wearwell::monitor
