#include "wearwell/workbench/routes.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <string_view>
#include <utility>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/http/secret.h"
#include "wearwell/http/target.h"
#include "wearwell/workbench/actions.h"
#include "wearwell/workbench/comparison_view.h"
#include "wearwell/workbench/folder_files.h"
#include "wearwell/workbench/page.h"
#include "wearwell/workbench/result_view.h"

namespace wearwell::workbench {
namespace {

constexpr std::string_view upload_path = "/api/upload", events_path = "/api/events";

std::string_view path_of(const HttpRequest& question) {
  return std::string_view(question.target).substr(0, question.target.find('?'));
}

std::int64_t steady_ms() {
  using namespace std::chrono;
  return duration_cast<milliseconds>(steady_clock::now().time_since_epoch()).count();
}

HttpResponse json_response(const Json& json) {
  return {200, "application/json",
          printable_json(json.dump(-1, ' ', false, Json::error_handler_t::replace)) + "\n"};
}

// Messages about studies have several lines, which `refusal` would write as one.
HttpResponse json_refusal(unsigned status, const std::string& problem) {
  HttpResponse answer = json_response({{"error", printable_lines(problem)}});
  answer.status = status;
  return answer;
}

// In a frame of the page; its scripts have no origin, and so no way to the session.
HttpResponse framed(std::string html) {
  return {200,
          "text/html; charset=utf-8",
          std::move(html),
          {{"Content-Security-Policy",
            "sandbox allow-scripts allow-downloads allow-popups; connect-src 'none'; form-action "
            "'none'; frame-ancestors 'self'"},
           {"X-Frame-Options", "SAMEORIGIN"},
           {"Cross-Origin-Opener-Policy", "unsafe-none"}}};
}

}  // namespace

Routes::Routes(Session& session, std::string token)
    : session_(session),
      token_(std::move(token)),
      report_path_("/report/" + random_token()),
      comparison_path_("/comparison/" + random_token()),
      page_(workbench_page()) {}

double Routes::idle_seconds() const {
  return static_cast<double>(steady_ms() - last_used_) / 1000;
}

void Routes::note_use() const {
  last_used_ = std::max<std::int64_t>(1, steady_ms());
}

// Another name for our address would be one of another site (DNS rebinding).
bool Routes::is_ours(const HttpRequest& question) const {
  for (const char* name : {"127.0.0.1", "localhost"}) {
    const std::string host = fmt::format("{}:{}", name, port_.load());
    if (question.host == host)
      return question.origin.empty() || question.origin == "http://" + host ||
             // the report is sandboxed and has no origin of its own
             (question.origin == "null" && question.method == "GET" && path_of(question) == "/");
  }
  return false;
}

bool Routes::authorized(const HttpRequest& question) const {
  constexpr std::string_view scheme = "Bearer ";
  const std::string& field = question.authorization;
  return field.starts_with(scheme) &&
         equal_in_constant_time(std::string_view(field).substr(scheme.size()), token_);
}

std::optional<HttpResponse> Routes::refuse(const HttpRequest& question) const {
  if (!is_ours(question))
    return refusal(403, "the request comes from another site, or names another host");
  const std::string_view path = path_of(question);
  const bool shown = path == "/" || path == report_path_ || path == comparison_path_;
  // Pages of other sites may lead here, but not ask.
  if (!shown && !question.fetch_site.empty() && question.fetch_site != "same-origin" &&
      question.fetch_site != "none")
    return refusal(403, "the request comes from another site");
  if (!shown && !authorized(question))
    return refusal(401,
                   "the token is missing or wrong: open the address that wearwell open printed");
  const bool get = shown || path == events_path || look_of(path);
  const bool post = path == upload_path || action_of(path);
  if (!get && !post)
    return refusal(404,
                   fmt::format("there is nothing at {}", printable(shortened(std::string(path)))));
  const bool reads = question.method == "GET" || (shown && question.method == "HEAD");
  if (!(reads && get) && !(question.method == "POST" && post)) {
    HttpResponse answer = refusal(405, fmt::format("{} takes {}", path, get ? "GET" : "POST"));
    answer.fields.emplace_back("Allow", get && post ? "GET, POST" : get ? "GET" : "POST");
    return answer;
  }
  if (question.method == "POST" && path != upload_path &&
      question.content_type != "application/json")
    return refusal(415, "send JSON: Content-Type: application/json");
  return {};
}

bool Routes::is_events(const HttpRequest& question) const {
  return question.method == "GET" && path_of(question) == events_path;
}

bool Routes::is_delivery(const HttpRequest& question) const {
  // What a user waits for does not wait behind checks and guesses.
  static constexpr std::string_view quick[] = {"/api/stop", "/api/stop-reading", "/api/save",
                                               "/api/fit",  "/api/open",         "/api/table",
                                               "/api/set",  "/api/prior",        "/api/form"};
  return question.method == "POST" &&
         std::find(std::begin(quick), std::end(quick), path_of(question)) == std::end(quick);
}

HttpResponse Routes::answer(const HttpRequest& question, const HttpCounts&) const {
  try {
    const HttpTarget target = http_target(question.target);
    if (target.path == "/") return page(question);
    note_use();
    if (target.path == report_path_) return report();
    if (target.path == comparison_path_) return comparison();
    if (question.method == "GET") {
      Json json = look_of(target.path)(session_, target);
      if (target.path == "/api/session") {
        json["report"] = report_path_;
        json["comparison"] = comparison_path_;
      }
      return json_response(json);
    }
    if (target.path == upload_path) {
      const auto given = [&](const char* key, const char* otherwise) {
        const auto found = target.query.find(key);
        return found == target.query.end() ? otherwise : found->second;
      };
      return json_response(upload(session_,
                                  {{"file", given("file", "")},
                                   {"settings", nlohmann::json::parse(given("settings", "{}"))}},
                                  question.body));
    }
    const nlohmann::json wish = nlohmann::json::parse(question.body, nullptr, false);
    if (!wish.is_object()) return refusal(400, "the body is not a JSON object");
    return json_response(action_of(target.path)(session_, wish));
  } catch (const Conflict& error) {
    return json_refusal(409, error.what());
  } catch (const InputError& error) {
    return json_refusal(400, error.what());
  } catch (const nlohmann::json::exception& error) {
    return json_refusal(400, error.what());
  } catch (const std::exception& error) {
    return json_refusal(500, error.what());
  }
}

HttpResponse Routes::page(const HttpRequest& question) const {
  if (question.if_none_match == page_.tag)
    return {304, "text/html; charset=utf-8", "", {{"ETag", page_.tag}}};
  return {200,
          "text/html; charset=utf-8",
          page_.html,
          {{"Content-Security-Policy", page_.policy},
           {"ETag", page_.tag},
           {"Cache-Control", "no-cache"}}};
}

HttpResponse Routes::report() const {
  std::string name;
  {
    const std::lock_guard lock(session_.mutex);
    name = session_.result;
  }
  if (name.empty()) return refusal(404, "no result is open");
  return framed(report_page(path_in(session_.folder, name)));
}

HttpResponse Routes::comparison() const {
  std::vector<std::string> names;
  {
    const std::lock_guard lock(session_.mutex);
    names = session_.compared;
  }
  if (names.empty()) return refusal(404, "no results are compared");
  return framed(comparison_page_of(session_.folder, names));
}

std::uint64_t Routes::version() const {
  const std::lock_guard lock(session_.mutex);
  return session_.version;
}

std::string Routes::event(std::optional<std::uint64_t>, std::uint64_t* reached) const {
  note_use();
  const Json json = session_json(session_);
  *reached = json.at("version").get<std::uint64_t>();
  return fmt::format("event: session\ndata: {}\n\n",
                     printable_json(json.dump(-1, ' ', false, Json::error_handler_t::replace)));
}

// Sent only while a page listens.
std::string Routes::beat() const {
  note_use();
  return "event: beat\ndata: {}\n\n";
}

}  // namespace wearwell::workbench
