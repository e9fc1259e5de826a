#include "wearwell/monitor/http_access.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "monitor/generated_fleet.h"
#include "monitor/http_client.h"
#include "support/run_command.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/monitor/http_server.h"

namespace wearwell::monitor {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

const std::string token = "a-token-that-nobody-guesses";

HttpSettings settings_of(const std::string& its_token = "") {
  HttpSettings settings;
  settings.port = 0;
  settings.token = its_token;
  return settings;
}

class HttpAccessTest : public ScratchTest {
 protected:
  // A certificate and key of machine.example.org, or of another name.
  void certify(const std::string& file, const std::string& name = "machine.example.org") const {
    const CommandResult made =
        run_command("cd '" + folder().string() +
                    "' && openssl req -x509 -newkey ec -pkeyopt "
                    "ec_paramgen_curve:prime256v1 -nodes -days 2 -subj '/CN=" +
                    name + "' -addext 'subjectAltName=DNS:" + name + ",IP:127.0.0.1' -keyout " +
                    file + ".key -out " + file + ".pem");
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }
  HttpSettings tls(const std::string& its_token = "") const {
    HttpSettings settings = settings_of(its_token);
    settings.certificate = folder() / "a.pem";
    settings.key = folder() / "a.key";
    return settings;
  }
  std::string refusal_of(const HttpSettings& settings) {
    return message_of<InputError>([&] { HttpServer(settings, fleet_, &fleet_); });
  }

  GeneratedFleet fleet_{12};
};

// A page in the browser of somebody who may ask: its name, and where what it sends comes from.
TEST_F(HttpAccessTest, PagesFromElsewhereAreHeldOff) {
  HttpSettings settings = settings_of();
  settings.names = {"wear.example.org"};
  const HttpServer server(settings, fleet_, &fleet_);
  const auto status = [&](const std::string& line, const std::string& fields,
                          const std::string& body = "") {
    const std::string length =
        body.empty() ? "" : "Content-Length: " + std::to_string(body.size()) + "\r\n";
    return ask(server.port(), line + " HTTP/1.1\r\n" + fields + length + "\r\n" + body).status;
  };
  const std::string port = std::to_string(server.port());
  for (const std::string ours :
       {"localhost", "LocalHost:", "127.0.0.1:", "[::1]:", "wear.example.org", "192.168.1.7:"}) {
    const std::string host = ours + (ours.back() == ':' ? port : "");
    EXPECT_EQ(status("GET /api/v1/fleet", "Host: " + host + "\r\n"), 200) << host;
  }
  for (const char* other : {"evil.example.com", "127.0.0.1.evil.example.com", "localhost.evil.com",
                            "example.org", "", "[evil]", "1"}) {
    EXPECT_NE(status("GET /api/v1/fleet", std::string("Host: ") + other + "\r\n"), 200) << other;
  }
  const std::string here = "Host: localhost:" + port + "\r\n", reading = "{}";
  const auto from = [&](const std::string& fields) {
    return status("POST /api/v1/readings", here + fields, reading);
  };
  EXPECT_EQ(from(""), 400);  // it is read: no browser sends it
  EXPECT_EQ(from("Origin: http://localhost:" + port + "\r\n"), 400);
  EXPECT_EQ(from("Origin: https://wear.example.org\r\n"), 400);
  EXPECT_EQ(from("Origin: http://evil.example.com\r\n"), 403);
  EXPECT_EQ(from("Origin: http://localhost:1\r\n"), 403);
  EXPECT_EQ(from("Origin: null\r\n"), 403);
  EXPECT_EQ(from("Sec-Fetch-Site: cross-site\r\n"), 403);
  EXPECT_EQ(from("Sec-Fetch-Site: same-site\r\n"), 403);
  EXPECT_EQ(from("Sec-Fetch-Site: same-origin\r\n"), 400);
  EXPECT_EQ(status("GET /api/v1/fleet", here + "Sec-Fetch-Site: cross-site\r\n"), 403);
  EXPECT_EQ(status("GET /", here + "Sec-Fetch-Site: cross-site\r\n"), 200);  // a link
}

TEST_F(HttpAccessTest, ATokenIsAskedForEverywhere) {
  const HttpServer server(settings_of(token), fleet_, &fleet_);
  const unsigned short port = server.port();
  const std::string bearer = "Authorization: Bearer " + token + "\r\n";
  for (const char* path : {"/api/v1/fleet", "/api/v1/units", "/api/v1/units/M1010",
                           "/api/v1/events", "/metrics", "/nothing"}) {
    const HttpReply refused = get(port, path);
    EXPECT_EQ(refused.status, 401) << path;
    EXPECT_THAT(refused.field("WWW-Authenticate"), StartsWith("Bearer")) << path;
    EXPECT_EQ(get(port, path, "Authorization: Bearer " + token + "x\r\n").status, 401);
    EXPECT_EQ(get(port, path, "Authorization: Bearer \r\n").status, 401);
    EXPECT_EQ(get(port, path, "Authorization: Basic " + token + "\r\n").status, 401);
  }
  EXPECT_EQ(post(port, "/api/v1/readings", "{}").status, 401);
  EXPECT_EQ(post(port, "/api/v1/readings", "{}", bearer).status, 400);
  EXPECT_EQ(get(port, "/metrics", bearer).status, 200);
  EXPECT_EQ(get(port, "/metrics", "Authorization: bearer " + token + "\r\n").status, 200);
  EXPECT_EQ(get(port, "/health").status, 200);
  EXPECT_EQ(get(port, "/").status, 303);
  EXPECT_EQ(get(port, "/").field("Location"), "/login");
}

TEST_F(HttpAccessTest, ThePageIsSignedInByACookie) {
  const HttpServer server(settings_of(token), fleet_, &fleet_);
  const unsigned short port = server.port();
  EXPECT_THAT(get(port, "/login").body, HasSubstr("type=\"password\""));
  EXPECT_EQ(post(port, "/login", "token=wrong").status, 403);
  EXPECT_EQ(post(port, "/login", "x").status, 403);
  const HttpReply in = post(port, "/login", "token=" + token);
  EXPECT_EQ(in.status, 303);
  const std::string cookie = in.field("Set-Cookie");
  EXPECT_THAT(cookie, HasSubstr("; HttpOnly; SameSite=Lax"));
  EXPECT_EQ(cookie.find(token), std::string::npos);
  const std::string value = cookie.substr(0, cookie.find(';'));
  const auto status = [&](const std::string& with) {
    return get(port, "/api/v1/fleet", "Cookie: " + with + "\r\n").status;
  };
  EXPECT_EQ(status(value), 200);
  EXPECT_EQ(status("other=1; " + value + "; more=2"), 200);
  for (std::size_t i = std::string("wearwell=").size(); i < value.size(); i += 7) {
    std::string changed = value;
    changed[i] = changed[i] == '1' ? '2' : '1';
    EXPECT_EQ(status(changed), 401) << changed;
  }
  EXPECT_EQ(status("wearwell="), 401);
  EXPECT_EQ(status("wearwell=99999999999999999999.aa"), 401);
  EXPECT_THAT(post(port, "/logout", "x", "Cookie: " + value + "\r\n").field("Set-Cookie"),
              HasSubstr("Max-Age=0"));
}

TEST_F(HttpAccessTest, ACookieEndsWithItsTimeAndItsToken) {
  const HttpAccess access(settings_of(token), {});
  HttpRequest question;
  const std::string cookie = access.cookie(token, 1000);
  question.cookie = cookie.substr(0, cookie.find(';'));
  constexpr std::int64_t month = 30 * 24 * 3600;
  EXPECT_TRUE(access.roles(question, 1000));
  EXPECT_TRUE(access.roles(question, 1000 + month));
  EXPECT_FALSE(access.roles(question, 1001 + month));
  EXPECT_FALSE(HttpAccess(settings_of(token + "2"), {}).roles(question, 1000));
}

// Each token may do what its roles say, by its header and by its cookie.
TEST_F(HttpAccessTest, TokensHaveRoles) {
  HttpSettings settings = settings_of(token);
  settings.port = 0;
  const std::string reads = "reads-0123456789", writes = "writes-0123456789",
                    operates = "operates-0123456789";
  settings.tokens = {{"a", reads, role_read},
                     {"b", writes, role_write},
                     {"c", operates, role_read | role_operate}};
  GeneratedFleet fleet(20);
  HttpServer server(settings, fleet, &fleet, &fleet);
  const unsigned short port = server.port();
  const auto bearer = [](const std::string& of) { return "Authorization: Bearer " + of + "\r\n"; };
  const std::string reading = R"({"unit": "M1010", "at": 5000, "wear": 31.5})";
  const std::string path = "/api/v1/units/M1010/events";
  struct Expected {
    std::string token;
    int read, write, operate;
  };
  for (const Expected& each : {Expected{token, 200, 200, 400}, Expected{reads, 200, 403, 403},
                               Expected{writes, 403, 200, 403}, Expected{operates, 200, 403, 400},
                               Expected{"nobody-0123456789", 401, 401, 401}}) {
    const std::string field = bearer(each.token);
    EXPECT_EQ(get(port, "/api/v1/fleet", field).status, each.read) << each.token;
    EXPECT_EQ(get(port, "/metrics", field).status, each.read) << each.token;
    EXPECT_EQ(post(port, "/api/v1/readings", reading, field).status, each.write) << each.token;
    EXPECT_EQ(post(port, path, "{}", field).status, each.operate) << each.token;
    EXPECT_EQ(get(port, "/health", field).status, 200);
  }
  // An event of a unit that is not known is more likely one of a wrong name, except its first.
  const std::string failed = R"({"event": "failed", "key": 1, "by": "x"})",
                    installed = R"({"event": "installed", "key": 1, "by": "x"})";
  const HttpReply wrong = post(port, "/api/v1/units/new/events", failed, bearer(token));
  EXPECT_EQ(wrong.status, 404);
  EXPECT_THAT(wrong.body, HasSubstr("report \\\"installed\\\" first"));
  // The generated fleet takes no events: it refuses it itself.
  EXPECT_EQ(post(port, "/api/v1/units/new/events", installed, bearer(token)).status, 400);
  // Who may only write does not report events among readings either.
  post(port, "/api/v1/readings", reading, bearer(writes));
  EXPECT_EQ(fleet.no_events(), "it is an event, which needs the role operate; the token has write");
  post(port, "/api/v1/readings", reading, bearer(token));
  EXPECT_EQ(fleet.no_events(), "");
  {
    HttpServer no_events(settings, fleet, &fleet, nullptr);
    post(no_events.port(), "/api/v1/readings", reading, bearer(token));
    EXPECT_EQ(fleet.no_events(), "it is an event, and this monitor takes no events by HTTP");
  }
  EXPECT_THAT(post(port, path, "{}", bearer(reads)).body,
              HasSubstr("this needs the role operate; the token has read"));
  EXPECT_EQ(post(port, "/login", "token=" + writes).status, 403);
  const std::string cookie = post(port, "/login", "token=" + reads).field("Set-Cookie");
  const std::string field = "Cookie: " + cookie.substr(0, cookie.find(';')) + "\r\n";
  EXPECT_EQ(get(port, "/api/v1/fleet", field).status, 200);
  EXPECT_EQ(post(port, path, "{}", field).status, 403);
}

TEST_F(HttpAccessTest, BeyondLoopbackATokenAndTlsMustBe) {
  HttpSettings settings = settings_of();
  settings.host = "0.0.0.0";
  EXPECT_EQ(refusal_of(settings),
            "host = \"0.0.0.0\" is reachable from other machines: set a token and TLS (certificate "
            "and key); or use 127.0.0.1, which only this machine can reach");
  settings.token = token;
  EXPECT_THAT(refusal_of(settings), HasSubstr("set TLS (certificate and key)"));
  certify("a");
  settings.certificate = folder() / "a.pem";
  EXPECT_THAT(refusal_of(settings), HasSubstr("TLS needs both"));
  settings.key = folder() / "a.key";
  const HttpServer server(settings, fleet_, &fleet_);
  EXPECT_THAT(server.address(), StartsWith("https://0.0.0.0:"));
  settings.token.clear();
  EXPECT_THAT(refusal_of(settings), HasSubstr("is reachable from other machines: set a token"));
}

TEST_F(HttpAccessTest, SettingsThatCannotBeAreRefused) {
  HttpSettings settings = settings_of("short");
  EXPECT_THAT(refusal_of(settings), StartsWith("the token has 5 characters: use at least 16"));
  settings = settings_of(token + "\n");
  EXPECT_THAT(refusal_of(settings), HasSubstr("visible ASCII"));
  settings = settings_of();
  settings.port = 65536;
  EXPECT_THAT(refusal_of(settings), StartsWith("port = 65536"));
  settings = settings_of();
  settings.host = "no such host.invalid";
  EXPECT_THAT(refusal_of(settings), HasSubstr("neither an address nor a known name"));
  certify("a");
  certify("b");
  settings = tls();
  settings.certificate = folder() / "none.pem";
  EXPECT_THAT(refusal_of(settings), HasSubstr("none.pem: contains no readable certificate"));
  settings = tls();
  settings.key = folder() / "b.key";
  EXPECT_THAT(refusal_of(settings), HasSubstr("b.key: "));
  settings.key = write("bad.key", "no key");
  EXPECT_THAT(refusal_of(settings), HasSubstr("bad.key: "));
  const HttpServer server(settings_of(), fleet_, &fleet_);
  settings = settings_of();
  settings.port = server.port();
  EXPECT_THAT(message_of<MachineError>([&] { HttpServer(settings, fleet_, &fleet_); }),
              HasSubstr("in use"));
}

TEST_F(HttpAccessTest, TlsIsSpokenUnderTheNamesOfTheCertificate) {
  certify("a");
  const HttpServer server(tls(token), fleet_, &fleet_);
  const std::string port = std::to_string(server.port());
  const auto curl = [&](const std::string& arguments) {
    return run_command("curl -s --max-time 20 --noproxy '*' --cacert '" +
                       (folder() / "a.pem").string() + "' --resolve machine.example.org:" + port +
                       ":127.0.0.1 -H 'Authorization: "
                       "Bearer " +
                       token + "' " + arguments);
  };
  const std::string address = "https://machine.example.org:" + port;
  const CommandResult fleet = curl(address + "/api/v1/fleet");
  EXPECT_EQ(fleet.exit_code, 0) << fleet.err;
  EXPECT_EQ(nlohmann::json::parse(fleet.out)["units"]["all"], 12);
  EXPECT_THAT(curl("-i " + address + "/").out, HasSubstr("Strict-Transport-Security"));
  EXPECT_THAT(curl("-i -d token=" + token + " " + address + "/login").out, HasSubstr("; Secure"));
  EXPECT_EQ(curl("https://127.0.0.1:" + port + "/health").exit_code, 0);
  EXPECT_THAT(curl("-H 'Host: evil.example.com' " + address + "/api/v1/fleet").out,
              HasSubstr("is not a name of this server"));
  EXPECT_NE(curl("--tls-max 1.1 " + address + "/health").exit_code, 0);
  EXPECT_THAT(curl("--max-time 2 -N " + address + "/api/v1/events").out, HasSubstr("event: fleet"));
  // Plain HTTP, and half a handshake, lead nowhere and hurt nobody.
  EXPECT_EQ(ask(server.port(), request_of("GET /health")).status, 0);
  HttpClient half(server.port());
  half.send("\x16\x03\x01\x02");
  EXPECT_EQ(curl(address + "/health").exit_code, 0);
}

}  // namespace
}  // namespace wearwell::monitor
