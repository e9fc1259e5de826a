#include "wearwell/monitor/http_routes.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/monitor/fleet_json.h"
#include "wearwell/monitor/message.h"
#include "wearwell/monitor/page_resources.h"

// Longer than others: the answers of all paths, and why a request is refused.
namespace wearwell::monitor {
namespace {

constexpr std::size_t units_at_once = 500;
/// The metrics show only this many of the riskiest units: each has some twenty lines, and
/// Prometheus keeps every one.
constexpr std::size_t units_measured = 10'000;
/// With more changes an event says only that many units changed, not which.
constexpr std::size_t names_at_once = 200;
std::string_view path_of(const HttpRequest& question) {
  return std::string_view(question.target).substr(0, question.target.find('?'));
}

bool is_taken(const std::string& methods, const std::string& method) {
  return (", " + methods + ",").find(" " + method + ",") != std::string::npos;
}

std::int64_t now_seconds() {
  using namespace std::chrono;
  return duration_cast<seconds>(system_clock::now().time_since_epoch()).count();
}

HttpResponse moved(const char* where) {
  return {303, "text/plain; charset=utf-8", "", {{"Location", where}}};
}

HttpResponse as_page(const ServedPage& page, unsigned status = 200) {
  return {status,
          "text/html; charset=utf-8",
          page.html,
          {{"Content-Security-Policy", page.policy},
           {"ETag", page.tag},
           {"Cache-Control", "no-cache"}}};
}

/// "application/json; charset=utf-8" -> "application/json".
std::string media_type(const std::string& field) {
  std::string type = field.substr(0, field.find_first_of("; "));
  std::transform(type.begin(), type.end(), type.begin(),
                 [](unsigned char c) { return c < 128 ? std::tolower(c) : c; });
  return type;
}

// Rejected permanently with 400, to be repeated with 503.
HttpResponse answer_of(Delivery delivery) {
  HttpResponse answer;
  if (!delivery.stored) {
    answer.status = 503;
    answer.fields.emplace_back("Retry-After", "5");
  } else if (delivery.readings + delivery.events + delivery.repeated == 0) {
    answer.status = 400;
    if (delivery.problem.empty()) delivery.problem = "it contains no reading";
  }
  answer.body = text_of(json_of(delivery));
  return answer;
}

HttpResponse not_yet(const std::string& why) {
  HttpResponse answer = refusal(503, why);
  answer.fields.emplace_back("Retry-After", "5");
  return answer;
}

/// The kind of an event; empty if it cannot be read.
std::string event_in(const std::string& body) {
  try {
    const Fields fields = fields_of_json(body);
    const Field* event = find_field(fields, "event");
    return event ? event->text : std::string();
  } catch (const InputError&) {
    return {};
  }
}

/// Why an acknowledgement is of an alarm that the unit does not have; empty if it has, or if this is
/// another event.
std::string not_the_alarm(const std::string& body, const UnitView& unit) {
  Fields fields;
  try {
    fields = fields_of_json(body);
  } catch (const InputError&) {
    return {};  // the inbox refuses it, with the reason
  }
  const Field* event = find_field(fields, "event");
  const Field* since = find_field(fields, "alarm_ms");
  if (!event || event->text != name(EventKind::acknowledged) || !since || !since->whole) return {};
  const bool calls = unit.alarm != Alarm::ok && unit.alarm != Alarm::unknown;
  if (calls && since->integer == unit.alarm_ms) return {};
  return fmt::format("\"{}\" has another alarm by now: {} since {}", shortened(unit.unit),
                     name(unit.alarm), unit.alarm_ms);
}

std::optional<HttpResponse> refuse_kind(const HttpRequest& question) {
  if (!question.content_encoding.empty() && question.content_encoding != "identity") {
    return refusal(415, "the body is compressed; send it uncompressed");
  }
  static constexpr std::string_view kinds[] = {
      "",
      "application/json",
      "application/x-ndjson",
      "application/jsonl",
      "text/csv",
      "application/csv",
      "text/plain",
      "application/octet-stream",
      "application/x-www-form-urlencoded"};  // curl uses the last one by default
  const std::string type = media_type(question.content_type);
  if (std::find(std::begin(kinds), std::end(kinds), type) != std::end(kinds)) return {};
  return refusal(
      415, fmt::format("Content-Type \"{}\": send JSON, lines of JSON or CSV", shortened(type)));
}

}  // namespace

HttpRoutes::HttpRoutes(const HttpAccess& access, const FleetReader& reader, Inbox* readings,
                       Inbox* events)
    : access_(access),
      reader_(reader),
      inbox_(readings),
      events_(events),
      page_(fleet_page(access.needs_token())),
      login_(login_page(false)),
      wrong_(login_page(true)),
      started_ms_(reader.fleet().started_ms) {}

bool HttpRoutes::is_events(const HttpRequest& question) const {
  return question.method == "GET" && path_of(question) == "/api/v1/events";
}

bool HttpRoutes::is_supervision(const HttpRequest& question) const {
  const std::string_view path = path_of(question);
  return path == "/health" || path == "/metrics";
}

bool HttpRoutes::is_delivery(const HttpRequest& question) const {
  return path_of(question) == "/api/v1/readings" || is_events_of_unit(path_of(question));
}

std::optional<HttpResponse> HttpRoutes::refuse(const HttpRequest& question) const {
  if (auto refused = access_.refuse(question)) return refused;
  const std::string_view path = path_of(question);
  const HttpRoute* route = route_of(path);
  const unsigned needed = route ? route->role : role_read;
  const unsigned roles = access_.roles(question, now_seconds());
  if (needed && !roles) {
    if (path == "/") return moved("/login");
    HttpResponse answer =
        refusal(401, "the token is missing or wrong: Authorization: Bearer TOKEN");
    answer.fields.emplace_back("WWW-Authenticate", "Bearer realm=\"wearwell\"");
    return answer;
  }
  if (!route) {
    return refusal(404, fmt::format("there is nothing at {}", shortened(std::string(path))));
  }
  const std::string methods(route->methods);
  if (!is_taken(methods, question.method)) {
    HttpResponse answer = refusal(405, fmt::format("{} takes {}", path, methods));
    answer.fields.emplace_back("Allow", methods);
    return answer;
  }
  if (needed && !(roles & needed)) {
    return refusal(403, fmt::format("this needs the role {}; the token has {}", role_names(needed),
                                    role_names(roles)));
  }
  if (question.method == "POST") return refuse_kind(question);
  if (route->from_states) {
    if (const std::string why = reader_.starting(); !why.empty()) return not_yet(why);
  }
  return {};
}

HttpResponse HttpRoutes::answer(const HttpRequest& question, const HttpCounts& http) const {
  try {
    const HttpTarget target = http_target(question.target);
    const std::string& path = target.path;
    if (path == "/") return page(question);
    if (path == "/login") return login(question);
    if (path == "/logout") {
      HttpResponse answer = moved("/login");
      answer.fields.emplace_back("Set-Cookie", access_.no_cookie());
      return answer;
    }
    if (path == "/health")
      return {200, "application/json",
              reader_.starting().empty() ? "{\"status\":\"ok\"}\n" : "{\"status\":\"starting\"}\n"};
    if (path == "/metrics") return metrics(http);
    if (path == "/api/v1/fleet") {
      nlohmann::ordered_json json = {{"version", reader_.version()}};
      json.update(json_of(reader_.fleet()));
      return {200, "application/json", text_of(json)};
    }
    if (path == "/api/v1/units") return units(target);
    if (path == "/api/v1/fits") return fits(target);
    if (path == "/api/v1/openapi.json")
      return {200, "application/json", std::string(resource::monitor_openapi())};
    if (path == "/api/v1/readings") return readings(question);
    if (is_events_of_unit(path)) return event_of_unit(unit_in(path), question.body);
    return unit(unit_in(path));
  } catch (const InputError& error) {
    return refusal(400, error.what());
  } catch (const std::exception& error) {
    return refusal(500, error.what());
  }
}

HttpResponse HttpRoutes::page(const HttpRequest& question) const {
  if (question.if_none_match == page_.tag) {
    return {304, "text/html; charset=utf-8", "", {{"ETag", page_.tag}}};
  }
  return as_page(page_);
}

HttpResponse HttpRoutes::login(const HttpRequest& question) const {
  if (!access_.needs_token()) return moved("/");
  if (question.method != "POST") return as_page(login_);
  const auto fields = form_fields(question.body);
  const auto token = fields.find("token");
  // The page is for those who may read it.
  if (token == fields.end() || !(access_.roles_of_token(token->second) & role_read))
    return as_page(wrong_, 403);
  HttpResponse answer = moved("/");
  answer.fields.emplace_back("Set-Cookie", access_.cookie(token->second, now_seconds()));
  return answer;
}

HttpResponse HttpRoutes::units(const HttpTarget& target) const {
  for (const auto& [key, value] : target.query) {
    if (key != "search" && key != "offset" && key != "count") {
      throw InputError(fmt::format("{}: use search, offset and count", shortened(key)));
    }
  }
  const auto search = target.query.find("search");
  const std::size_t offset = target.number("offset", 0, 1'000'000'000);
  const std::size_t count = target.number("count", 50, units_at_once);
  const std::uint64_t version = reader_.version();
  std::uint64_t matching = 0;
  const std::vector<UnitView> found =
      reader_.units(search == target.query.end() ? "" : search->second, offset, count, &matching);
  nlohmann::ordered_json json = {{"version", version}, {"matching", matching}, {"offset", offset}};
  json["units"] = nlohmann::ordered_json::array();
  for (const UnitView& each : found) json["units"].push_back(json_of(each));
  return {200, "application/json", text_of(json)};
}

HttpResponse HttpRoutes::fits(const HttpTarget& target) const {
  for (const auto& [key, value] : target.query) {
    if (key != "offset" && key != "count")
      throw InputError(fmt::format("{}: use offset and count", shortened(key)));
  }
  const std::size_t offset = target.number("offset", 0, 1'000'000'000);
  const std::size_t count = target.number("count", 50, units_at_once);
  // One state: another fit may take the place of this one in between.
  const std::shared_ptr<const FleetReader> reader = reader_.present();
  std::uint64_t all = 0;
  nlohmann::ordered_json moved = nlohmann::ordered_json::array();
  for (const MovedForecast& each : reader->moved(offset, count, &all)) {
    nlohmann::ordered_json json = {{"unit", each.unit}};
    json.update(json_of(each));
    moved.push_back(std::move(json));
  }
  const FleetView fleet = reader->fleet();
  const nlohmann::ordered_json json = {{"fit", json_of(fleet)["fit"]},
                                       {"trusted", fleet.trusted},
                                       {"all", all},
                                       {"offset", offset},
                                       {"moved", std::move(moved)}};
  return {200, "application/json", text_of(json)};
}

HttpResponse HttpRoutes::unit(const std::string& encoded) const {
  const std::string name = percent_decoded(encoded);
  const std::uint64_t version = reader_.version();
  const std::optional<UnitDetail> detail = reader_.unit(name);
  if (!detail) return refusal(404, fmt::format("\"{}\" is not a unit", shortened(name)));
  nlohmann::ordered_json json = {{"version", version}};
  json.update(json_of(*detail));
  return {200, "application/json", text_of(json)};
}

std::string HttpRoutes::no_events(const HttpRequest& question) const {
  if (!events_) return "it is an event, and this monitor takes no events by HTTP";
  const unsigned roles = access_.roles(question, now_seconds());
  if (roles & role_operate) return {};
  return fmt::format("it is an event, which needs the role {}; the token has {}",
                     role_names(role_operate), role_names(roles));
}

HttpResponse HttpRoutes::readings(const HttpRequest& question) const {
  if (!inbox_) return refusal(404, "this monitor takes no readings by HTTP");
  return answer_of(inbox_->deliver("", question.body, no_events(question)));
}

HttpResponse HttpRoutes::event_of_unit(const std::string& encoded, const std::string& body) const {
  if (!events_) return refusal(404, "this monitor takes no events by HTTP");
  const std::string name = percent_decoded(encoded);
  // A unit whose first readings are still to be processed has no alarm; whether there is such a unit
  // at all, the inbox knows.
  const std::shared_ptr<const FleetReader> reader = reader_.present();
  if (const std::optional<UnitView> unit = reader->view(name)) {
    if (const std::string why = not_the_alarm(body, *unit); !why.empty()) return refusal(409, why);
  } else if (event_in(body) == monitor::name(EventKind::acknowledged)) {
    if (const std::string why = reader->starting(); !why.empty())
      return answer_of({false, 0, 0, 0, why});
    return refusal(404, fmt::format("\"{}\" is not a unit with an alarm", shortened(name)));
  }
  const Delivery delivery = events_->deliver(name, body);
  return delivery.unknown_unit ? refusal(404, delivery.problem) : answer_of(delivery);
}

HttpResponse HttpRoutes::metrics(const HttpCounts& http) const {
  return {200, "text/plain; version=0.0.4; charset=utf-8",
          metrics_text(reader_.fleet(), reader_.units("", 0, units_measured), http)};
}

std::string HttpRoutes::event(std::optional<std::uint64_t> version, std::uint64_t* reached) const {
  // The version first: later changes are sent again with the next event.
  *reached = reader_.version();
  std::vector<std::string> changed;
  if (version) changed = reader_.changed_since(*version);
  const bool all = !version || changed.size() > names_at_once;
  if (all) changed.clear();
  const nlohmann::ordered_json json = {{"version", *reached},
                                       {"fleet", json_of(reader_.fleet())},
                                       {"all", all},
                                       {"changed", changed}};
  return fmt::format("id: {}.{}\nevent: fleet\ndata: {}\n", started_ms_, *reached, text_of(json));
}

std::string HttpRoutes::beat() const {
  using namespace std::chrono;
  const auto now = duration_cast<milliseconds>(system_clock::now().time_since_epoch()).count();
  return fmt::format("event: beat\ndata: {{\"now_ms\":{}}}\n\n", now);
}

std::optional<std::uint64_t> HttpRoutes::version_of(const std::string& event_id) const {
  const std::string run = fmt::format("{}.", started_ms_);
  if (!event_id.starts_with(run)) return {};
  std::uint64_t version = 0;
  const char *begin = event_id.data() + run.size(), *end = event_id.data() + event_id.size();
  const auto [last, error] = std::from_chars(begin, end, version);
  if (error != std::errc{} || last != end || version > reader_.version()) return {};
  return version;
}

}  // namespace wearwell::monitor
