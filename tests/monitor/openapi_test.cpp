// openapi.json describes what the server answers: every path and method, and every field.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "monitor/generated_fleet.h"
#include "monitor/http_client.h"
#include "monitor/json_schema.h"
#include "wearwell/monitor/current_fleet.h"
#include "wearwell/monitor/http_route.h"
#include "wearwell/monitor/http_server.h"
#include "wearwell/monitor/starting_fleet.h"

namespace wearwell::monitor {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;

class OpenApi : public testing::Test {
 protected:
  static HttpSettings settings() {
    HttpSettings settings;
    settings.port = 0;
    return settings;
  }
  /// The schema of an answer of JSON.
  json schema_of(const std::string& path, const std::string& method, int status) const {
    const json& answers = description_.at("paths").at(path).at(method).at("responses");
    const std::string code = std::to_string(status);
    const json& answer = answers.contains(code) ? answers[code] : answers.at("default");
    return answer.at("content").at("application/json").at("schema");
  }
  void expect_described(const std::string& path, const std::string& method,
                        const HttpReply& reply) {
    const json body = json::parse(reply.body);
    EXPECT_THAT(JsonSchema(description_).problems(schema_of(path, method, reply.status), body),
                IsEmpty())
        << path << " " << reply.status;
  }

  GeneratedFleet fleet_{40};
  HttpServer server_{settings(), fleet_, &fleet_, &fleet_};
  const json description_ = json::parse(get(server_.port(), "/api/v1/openapi.json").body);
};

TEST_F(OpenApi, HasAllRoutesAndNoOther) {
  EXPECT_EQ(description_["openapi"], "3.1.0");
  std::set<std::string> described, served;
  for (const auto& [path, methods] : description_["paths"].items()) {
    for (const auto& [method, operation] : methods.items()) described.insert(method + " " + path);
  }
  for (const HttpRoute& each : http_routes()) {
    for (const char* method : {"GET", "POST"}) {
      if (each.methods.find(method) == std::string_view::npos) continue;
      std::string name = method;
      for (char& c : name) c = static_cast<char>(std::tolower(c));
      served.insert(name + " " + std::string(each.path));
    }
  }
  EXPECT_EQ(described, served);
  // And each is there, with the role that is written beside it.
  for (const auto& [path, methods] : description_["paths"].items()) {
    for (const auto& [method, operation] : methods.items()) {
      std::string target = path;
      if (const auto at = target.find("{name}"); at != target.npos) target.replace(at, 6, "M1020");
      if (target == "/api/v1/events") continue;  // it does not end
      const int status = method == "get" ? get(server_.port(), target).status
                                         : post(server_.port(), target, "{").status;
      EXPECT_NE(status, 404) << target;
      EXPECT_NE(status, 405) << target;
      const json& answers = operation["responses"];
      EXPECT_TRUE(answers.contains(std::to_string(status))) << method << " " << target << status;
    }
  }
}

TEST_F(OpenApi, DescribesEveryAnswer) {
  for (const char* path : {"/api/v1/fleet", "/api/v1/units", "/api/v1/fits", "/health"})
    expect_described(path, "get", get(server_.port(), path));
  const json units = json::parse(get(server_.port(), "/api/v1/units?count=500").body)["units"];
  ASSERT_EQ(units.size(), 40U);
  for (const json& each : units) {
    std::string name;
    for (const unsigned char c : each["unit"].get<std::string>()) name += fmt::format("%{:02x}", c);
    expect_described("/api/v1/units/{name}", "get", get(server_.port(), "/api/v1/units/" + name));
  }
  expect_described("/api/v1/units/{name}", "get", get(server_.port(), "/api/v1/units/none"));
  expect_described("/api/v1/fleet", "get",
                   get(server_.port(), "/api/v1/fleet", "Origin: http://x.y\r\n"));
  expect_described("/api/v1/units", "get", get(server_.port(), "/api/v1/units?count=x"));
  const std::string reading = R"({"unit": "M1020", "at": 5000, "wear": 31.5})";
  expect_described("/api/v1/readings", "post", post(server_.port(), "/api/v1/readings", reading));
  expect_described("/api/v1/readings", "post", post(server_.port(), "/api/v1/readings", "x"));
  fleet_.away = true;
  expect_described("/api/v1/readings", "post", post(server_.port(), "/api/v1/readings", reading));
  fleet_.away = false;
  const std::string wrong = R"({"event": "acknowledged", "by": "A", "alarm_ms": 1})";
  const HttpReply reply = post(server_.port(), "/api/v1/units/M1020/events", wrong);
  EXPECT_EQ(reply.status, 409);
  EXPECT_THAT(reply.body, HasSubstr("has another alarm by now"));
  expect_described("/api/v1/units/{name}/events", "post", reply);
}

TEST_F(OpenApi, DescribesTheStream) {
  HttpClient client(server_.port());
  client.send(request_of("GET /api/v1/events"));
  std::string text;
  do {
    text = client.until("\n\n");
  } while (text.find("event: fleet") == text.npos);
  const json data = json::parse(text.substr(text.find("data: ") + 6));
  EXPECT_THAT(
      JsonSchema(description_).problems(description_["components"]["schemas"]["Change"], data),
      IsEmpty());
}

// Until the states have the stored readings there are no forecasts to read, but readings are accepted.
TEST_F(OpenApi, DescribesAStart) {
  CurrentFleet readers(std::make_shared<const StartingFleet>(1'795'360'000'000));
  const HttpServer server(settings(), readers, &fleet_, &fleet_);
  HttpReply health = get(server.port(), "/health");
  EXPECT_EQ(health.status, 200);
  EXPECT_EQ(health.body, "{\"status\":\"starting\"}\n");
  expect_described("/health", "get", health);
  EXPECT_EQ(get(server.port(), "/").status, 200);
  EXPECT_EQ(get(server.port(), "/api/v1/openapi.json").status, 200);
  const char* from_states[] = {"/api/v1/fleet", "/api/v1/units",  "/api/v1/units/M1020",
                               "/api/v1/fits",  "/api/v1/events", "/metrics"};
  for (const char* path : from_states) {
    const HttpReply reply = get(server.port(), path);
    EXPECT_EQ(reply.status, 503) << path;
    EXPECT_THAT(reply.body, HasSubstr("the monitor is starting"));
    EXPECT_EQ(reply.field("Retry-After"), "5") << path;
  }
  expect_described("/api/v1/fleet", "get", get(server.port(), "/api/v1/fleet"));
  const std::string reading = R"({"unit": "M1020", "at": 5000, "wear": 31.5})";
  EXPECT_EQ(post(server.port(), "/api/v1/readings", reading).status, 200);
  const std::string path = "/api/v1/units/M1020/events";
  // It comes to the inbox, which takes readings only.
  EXPECT_THAT(post(server.port(), path, R"({"event": "withdrawn", "by": "A", "key": 1})").body,
              HasSubstr("is no reading"));
  const HttpReply reply =
      post(server.port(), path, R"({"event": "acknowledged", "by": "A", "alarm_ms": 1})");
  EXPECT_EQ(reply.status, 503);
  expect_described("/api/v1/units/{name}/events", "post", reply);

  readers.exchange({std::shared_ptr<const FleetReader>(), &fleet_});
  EXPECT_EQ(get(server.port(), "/health").body, "{\"status\":\"ok\"}\n");
  for (const char* each : from_states) {
    if (std::string_view(each) == "/api/v1/events") continue;  // it does not end
    EXPECT_EQ(get(server.port(), each).status, 200) << each;
  }
}

// The check itself finds what is wrong.
TEST_F(OpenApi, IsCheckedStrictly) {
  json fleet = json::parse(get(server_.port(), "/api/v1/fleet").body);
  const JsonSchema schema(description_);
  const json& rule = description_["components"]["schemas"]["VersionedFleet"];
  const auto with = [&](const auto& change) {
    json changed = fleet;
    change(changed);
    return schema.problems(rule, changed).size();
  };
  EXPECT_EQ(with([](json&) {}), 0U);
  EXPECT_EQ(with([](json& each) { each["more"] = 1; }), 1U);
  EXPECT_EQ(with([](json& each) { each.erase("fit"); }), 1U);
  EXPECT_EQ(with([](json& each) { each["units"]["act"] = "3"; }), 1U);
  EXPECT_EQ(with([](json& each) { each["keys"] = "other"; }), 1U);
  EXPECT_EQ(with([](json& each) { each["webhook"]["sent"] = 1.5; }), 1U);
  EXPECT_EQ(with([](json& each) {
              each["columns"] = json::array({{{"name", 5}, {"unit", nullptr}}});
            }),
            1U);
}

}  // namespace
}  // namespace wearwell::monitor
