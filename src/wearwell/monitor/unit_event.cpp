#include "wearwell/monitor/unit_event.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "wearwell/base/sha1.h"
#include "wearwell/monitor/store.h"

namespace wearwell::monitor {
namespace {

constexpr std::pair<EventKind, const char*> event_list[] = {
    {EventKind::installed, "installed"}, {EventKind::replaced, "replaced"},
    {EventKind::repaired, "repaired"},   {EventKind::removed, "removed"},
    {EventKind::failed, "failed"},       {EventKind::sensor, "sensor"},
    {EventKind::corrected, "corrected"}, {EventKind::withdrawn, "withdrawn"},
    {EventKind::cancelled, "cancelled"}, {EventKind::acknowledged, "acknowledged"}};

}  // namespace

const char* name(EventKind kind) {
  for (const auto& [each, text] : event_list) {
    if (each == kind) return text;
  }
  return "";
}

std::optional<EventKind> event_named(std::string_view name) {
  for (const auto& [each, text] : event_list) {
    if (text == name) return each;
  }
  return {};
}

bool begins_part(EventKind kind) {
  return kind == EventKind::installed || kind == EventKind::replaced;
}

bool begins_unit(EventKind kind) {
  return kind == EventKind::installed;
}

bool changes_state(EventKind kind) {
  return kind != EventKind::acknowledged;
}

bool needs_reference(EventKind kind) {
  return kind == EventKind::corrected || kind == EventKind::withdrawn ||
         kind == EventKind::cancelled || kind == EventKind::acknowledged;
}

EventKind stored_event(std::string_view name) {
  if (const auto kind = event_named(name)) return *kind;
  throw StoreError(fmt::format("'{}' is not an event", name));
}

std::string event_names() {
  std::string names;
  for (const auto& [each, text] : event_list)
    names += (names.empty() ? "" : ", ") + std::string(text);
  return names;
}

const char* name(Service service) {
  return service == Service::removed  ? "removed"
         : service == Service::failed ? "failed"
                                      : "in service";
}

std::string content_of(const UnitEvent& event) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  if (!std::isnan(event.use)) json["use"] = event.use;
  if (!event.part.empty()) json["part"] = event.part;
  if (event.kind == EventKind::sensor) json["offset"] = event.offset;
  if (event.kind == EventKind::repaired) json["restored"] = event.restored;
  if (event.kind == EventKind::cancelled) json["cancels"] = event.cancels;
  if (event.kind == EventKind::acknowledged) json["alarm_ms"] = event.alarm_ms;
  if (event.kind == EventKind::corrected) {
    json["numbers"] = json_of(event.numbers);
    json["labels"] = json_of(event.labels);
  }
  return json.dump();
}

std::string identity_of(const UnitEvent& event) {
  const nlohmann::json all = {event.unit,   name(event.kind), event.key,
                              event.author, event.note,       content_of(event)};
  return sha1_of(all.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

void read_content(const std::string& text, UnitEvent& event) {
  try {
    const auto json = nlohmann::json::parse(text);
    event.use = json.value("use", std::numeric_limits<double>::quiet_NaN());
    event.part = json.value("part", "");
    event.offset = json.value("offset", 0.0);
    event.restored = json.value("restored", 0.0);
    event.cancels = json.value("cancels", std::int64_t{0});
    event.alarm_ms = json.value("alarm_ms", std::int64_t{0});
    event.numbers = numbers_of(json.value("numbers", "[]"));
    event.labels = texts_of(json.value("labels", "[]"));
  } catch (const nlohmann::json::exception& error) {
    throw StoreError(fmt::format("event {} of unit '{}' is damaged: {}", event.number, event.unit,
                                 error.what()));
  }
}

}  // namespace wearwell::monitor
