#include "wearwell/monitor/http_server.h"

#include <gmock/gmock.h>

#include <atomic>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>
#include <vector>

#include "monitor/generated_fleet.h"
#include "monitor/http_client.h"

namespace wearwell::monitor {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;
using testing::HasSubstr;
using testing::StartsWith;

class HttpServerTest : public testing::Test {
 protected:
  explicit HttpServerTest(HttpLimits limits = {}) : server_(settings(limits), fleet_, &fleet_) {}

  static HttpSettings settings(const HttpLimits& limits) {
    HttpSettings settings;
    settings.port = 0;
    settings.limits = limits;
    return settings;
  }

  HttpReply get(const std::string& target, const std::string& fields = {}) const {
    return monitor::get(server_.port(), target, fields);
  }
  HttpReply post(const std::string& body, const std::string& fields = {}) const {
    return monitor::post(server_.port(), "/api/v1/readings", body, fields);
  }
  bool is_well() const { return get("/health").status == 200; }

  GeneratedFleet fleet_{30};
  HttpServer server_;
};

TEST_F(HttpServerTest, AnswersEveryPath) {
  const std::vector<std::pair<std::string, std::string>> paths = {
      {"/", "text/html; charset=utf-8"},
      {"/api/v1/fleet", "application/json"},
      {"/api/v1/units", "application/json"},
      {"/api/v1/units/M1010", "application/json"},
      {"/metrics", "text/plain; version=0.0.4; charset=utf-8"},
      {"/health", "application/json"}};
  for (const auto& [path, type] : paths) {
    const HttpReply reply = get(path);
    EXPECT_EQ(reply.status, 200) << path;
    EXPECT_EQ(reply.field("Content-Type"), type) << path;
    EXPECT_EQ(reply.field("X-Content-Type-Options"), "nosniff") << path;
    EXPECT_EQ(reply.field("Access-Control-Allow-Origin"), "") << path;
    EXPECT_EQ(json::accept(reply.body), type == "application/json") << path;
    HttpClient client(server_.port());
    client.send(request_of("HEAD " + path));
    const HttpReply head = client.reply(false);
    EXPECT_EQ(head.status, 200) << path;
    EXPECT_NE(head.field("Content-Length"), "0") << path;
    client.send(request_of("GET /health"));  // nothing of a body stands in the way
    EXPECT_EQ(client.reply().status, 200) << path;
  }
  EXPECT_EQ(get("/").field("Content-Security-Policy").find("unsafe"), std::string::npos);
  EXPECT_THAT(get("/").field("Content-Security-Policy"), StartsWith("default-src 'none'"));
  const std::string tag = get("/").field("ETag");
  EXPECT_EQ(get("/", "If-None-Match: " + tag + "\r\n").status, 304);
}

TEST_F(HttpServerTest, TellsOfTheFleetAndItsUnits) {
  const json fleet = json::parse(get("/api/v1/fleet").body);
  EXPECT_EQ(fleet["units"]["all"], 30);
  EXPECT_EQ(fleet["limit"], 80.0);
  const json all = json::parse(get("/api/v1/units?count=500").body);
  ASSERT_EQ(all["units"].size(), 30u);
  EXPECT_EQ(all["matching"], 30);
  // By risk; in doubt as if just to act on, beyond the threshold first.
  const auto urgency = [&](const json& unit) {
    const double least = unit["beyond"] ? 1 : unit["doubt"].is_null() ? 0 : 0.3;
    return std::max(unit["risk"].get<double>(), least);
  };
  for (std::size_t i = 1; i < 30; ++i) {
    EXPECT_GE(urgency(all["units"][i - 1]), urgency(all["units"][i])) << i;
  }
  EXPECT_EQ(all["units"][0]["beyond"], true);
  EXPECT_EQ(all["units"][0]["alarm"], "act");
  EXPECT_GT(fleet["units"]["doubt"], 0);
  // A page of it is a piece of it.
  const json page = json::parse(get("/api/v1/units?offset=10&count=7").body);
  ASSERT_EQ(page["units"].size(), 7u);
  for (std::size_t i = 0; i < 7; ++i) EXPECT_EQ(page["units"][i], all["units"][10 + i]);
  EXPECT_EQ(json::parse(get("/api/v1/units?offset=29").body)["units"].size(), 1u);
  EXPECT_EQ(json::parse(get("/api/v1/units?offset=30").body)["units"].size(), 0u);
  // All of a unit's view stands in its detail.
  const json& first = *std::find_if(
      page["units"].begin(), page["units"].end(),
      [](const json& unit) { return unit["unit"].get<std::string>().starts_with("M"); });
  const json detail = json::parse(get("/api/v1/units/" + first["unit"].get<std::string>()).body);
  for (const auto& [key, value] : first.items()) EXPECT_EQ(detail[key], value) << key;
  EXPECT_EQ(detail["path"].size(), 81u);
  EXPECT_GE(detail["forecasts"]["judged"], detail["forecasts"]["held"]);
}

TEST_F(HttpServerTest, NamesMayHoldAnything) {
  const auto found = [&](const std::string& encoded) {
    const HttpReply reply = get("/api/v1/units/" + encoded);
    return reply.status == 200 ? std::string(json::parse(reply.body)["unit"]) : reply.body;
  };
  EXPECT_EQ(found("hall%202%2Fline%207%20100%25"), "hall 2/line 7 100%");
  EXPECT_EQ(found("%3Cimg%20src=x%20onerror=alert(1)%3E"), "<img src=x onerror=alert(1)>");
  EXPECT_EQ(found("Pumpe%20S%C3%BCd%20%223%22%20%5C%20%C2%B5"), "Pumpe Süd \"3\" \\ µ");
  EXPECT_EQ(json::parse(get("/api/v1/units?search=s%C3%BCd+%223").body)["matching"], 1);
  EXPECT_EQ(get("/api/v1/units/nobody%22%1b[2J").status, 404);
  EXPECT_EQ(std::string(json::parse(get("/api/v1/units/nobody%22%1b[2J").body)["error"]),
            "\"nobody\"\\x1b[2J\" is not a unit");
  for (const char* bad : {"%zz", "%4", "%", "a%ff"}) {
    EXPECT_EQ(get(std::string("/api/v1/units/") + bad).status, 400) << bad;
  }
}

TEST_F(HttpServerTest, WhatIsNotFiniteIsNull) {
  const json unit = json::parse(get("/api/v1/units/never%20heard%20of").body);
  EXPECT_TRUE(unit["remaining"]["q95"].is_null());
  EXPECT_TRUE(unit["remaining"]["q50"].is_number());
}

TEST_F(HttpServerTest, RefusesWhatItDoesNotKnow) {
  EXPECT_EQ(get("/api").status, 404);
  EXPECT_EQ(get("/../../etc/passwd").status, 404);
  EXPECT_EQ(get("/api/v1/readings").status, 405);
  EXPECT_EQ(get("/api/v1/readings").field("Allow"), "POST");
  EXPECT_EQ(ask(server_.port(), request_of("POST /api/v1/fleet", "", "{}")).status, 405);
  EXPECT_EQ(ask(server_.port(), request_of("OPTIONS /api/v1/readings")).status, 405);
  EXPECT_EQ(ask(server_.port(), request_of("DELETE /api/v1/units/M1010")).status, 405);
  for (const char* query :
       {"count=501", "count=-1", "count=1e3", "count=", "offset=1000000001",
        "offset=99999999999999999999", "limit=5", "count=5&count=6", "search=%f", "search=%c3"}) {
    const HttpReply reply = get(std::string("/api/v1/units?") + query);
    EXPECT_EQ(reply.status, 400) << query;
    EXPECT_TRUE(json::parse(reply.body).contains("error")) << query;
  }
  EXPECT_EQ(std::string(json::parse(get("/api/v1/units?count=501").body)["error"]),
            "count = \"501\": must be a whole number from 0 to 500");
}

TEST_F(HttpServerTest, TakesReadingsOrSaysWhyNot) {
  const std::string reading = R"({"unit": "M1010", "at": 5000, "wear": 41.5})";
  const auto before = fleet_.fleet().messages;
  const HttpReply taken = post(reading, "Content-Type: application/json\r\n");
  EXPECT_EQ(taken.status, 200);
  EXPECT_EQ(json::parse(taken.body)["readings"], 1);
  EXPECT_EQ(fleet_.fleet().messages, before + 1);
  EXPECT_EQ(json::parse(get("/api/v1/units/M1010").body)["at"], 5000.0);

  const HttpReply partly = post(reading + "\nnonsense\n");
  EXPECT_EQ(partly.status, 200);
  EXPECT_EQ(json::parse(partly.body)["refused"], 1);
  EXPECT_EQ(std::string(json::parse(partly.body)["problem"]), "\"nonsense\" is no reading");

  EXPECT_EQ(post("nonsense").status, 400);
  EXPECT_EQ(
      ask(server_.port(), request_of("POST /api/v1/readings", "Content-Length: 0\r\n")).status,
      400);
  EXPECT_EQ(post(reading, "Content-Type: multipart/form-data\r\n").status, 415);
  EXPECT_EQ(post(reading, "Content-Encoding: gzip\r\n").status, 415);

  fleet_.away = true;
  const HttpReply away = post(reading);
  EXPECT_EQ(away.status, 503);
  EXPECT_NE(away.field("Retry-After"), "");
  EXPECT_EQ(std::string(json::parse(away.body)["problem"]), "the store cannot be reached");
  EXPECT_TRUE(is_well());
}

TEST_F(HttpServerTest, TakesBodiesInPiecesAndOnDemand) {
  const std::string reading = R"({"unit": "M1010", "at": 5000, "wear": 41.5})";
  HttpClient pieces(server_.port());
  pieces.send(
      "POST /api/v1/readings HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n");
  for (const char each : reading) pieces.send(std::string("1\r\n") + each + "\r\n");
  pieces.send("0\r\n\r\n");
  EXPECT_EQ(pieces.reply().status, 200);

  HttpClient careful(server_.port());
  careful.send(
      "POST /api/v1/readings HTTP/1.1\r\nHost: localhost\r\nExpect: 100-continue\r\n"
      "Content-Length: " +
      std::to_string(reading.size()) + "\r\n\r\n");
  EXPECT_EQ(careful.until("\r\n\r\n"), "HTTP/1.1 100 Continue\r\n\r\n");
  careful.send(reading);
  EXPECT_EQ(careful.reply().status, 200);
}

TEST_F(HttpServerTest, KeepsConnectionsAsTheyAskFor) {
  HttpClient client(server_.port());
  client.send(request_of("GET /health") + request_of("GET /api/v1/fleet") +
              request_of("GET /nothing"));
  EXPECT_EQ(client.reply().status, 200);
  EXPECT_THAT(client.reply().body, HasSubstr("Pumps of hall 2"));
  EXPECT_EQ(client.reply().status, 404);
  client.send(request_of("GET /health", "Connection: close\r\n"));
  EXPECT_THAT(client.rest(), HasSubstr("Connection: close"));

  HttpClient old(server_.port());
  old.send("GET /health HTTP/1.0\r\nHost: localhost\r\n\r\n");
  EXPECT_THAT(old.rest(), HasSubstr("200 OK"));
  HttpClient kept(server_.port());
  for (int i = 0; i < 2; ++i) {
    kept.send("GET /health HTTP/1.0\r\nHost: localhost\r\nConnection: keep-alive\r\n\r\n");
    const HttpReply reply = kept.reply();
    EXPECT_EQ(reply.status, 200);
    EXPECT_EQ(reply.field("Connection"), "keep-alive");
  }
}

TEST_F(HttpServerTest, AnswersManyAtOnce) {
  std::atomic<int> wrong = 0;
  std::vector<std::jthread> clients;
  for (int i = 0; i < 6; ++i) {
    clients.emplace_back([&, i] {
      HttpClient client(server_.port());
      for (int j = 0; j < 100; ++j) {
        const char* target = (i + j) % 3 == 0   ? "/api/v1/units"
                             : (i + j) % 3 == 1 ? "/metrics"
                                                : "/";
        client.send(request_of(std::string("GET ") + target));
        if (client.reply().status != 200) ++wrong;
        fleet_.advance();
      }
    });
  }
  clients.clear();
  EXPECT_EQ(wrong, 0);
}

class HttpLimitsTest : public HttpServerTest {
 protected:
  HttpLimitsTest() : HttpServerTest(small()) {}
  static HttpLimits small() {
    HttpLimits limits;
    limits.body_bytes = 10'000;
    limits.connections = 12;
    limits.large_bodies = 3;
    limits.streams = 4;
    limits.header = limits.body = milliseconds(400);
    return limits;
  }
};

TEST_F(HttpLimitsTest, HeadersEndSomewhere) {
  EXPECT_EQ(get("/health", "X: " + std::string(7000, 'x') + "\r\n").status, 200);
  EXPECT_EQ(get("/health", "X: " + std::string(9000, 'x') + "\r\n").status, 431);
  EXPECT_EQ(get("/" + std::string(9000, 'x')).status, 431);
  HttpClient endless(server_.port());
  endless.send("GET /health HTTP/1.1\r\nHost: localhost\r\n");
  bool open = true;
  for (int i = 0; i < 100'000 && open; ++i) open = endless.send("A: bcdefghijklmnop\r\n");
  EXPECT_FALSE(open);
  EXPECT_TRUE(is_well());
}

TEST_F(HttpLimitsTest, BodiesEndSomewhere) {
  const std::string line = "nonsense that is refused\n";
  std::string body;
  while (body.size() + line.size() <= 10'000) body += line;
  EXPECT_EQ(post(body).status, 400);
  EXPECT_EQ(post(std::string(10'001, 'x')).status, 413);
  // By its length alone, before it is sent.
  EXPECT_EQ(
      ask(server_.port(), request_of("POST /api/v1/readings", "Content-Length: 10001\r\n")).status,
      413);
  EXPECT_EQ(ask(server_.port(),
                request_of("POST /api/v1/readings", "Content-Length: 18446744073709551615\r\n"))
                .status,
            413);
  HttpClient pieces(server_.port());
  pieces.send(request_of("POST /api/v1/readings", "Transfer-Encoding: chunked\r\n"));
  const std::string piece = "1000\r\n" + std::string(0x1000, 'x') + "\r\n";
  for (int i = 0; i < 10; ++i) pieces.send(piece);
  EXPECT_EQ(pieces.reply().status, 413);
  EXPECT_TRUE(is_well());
}

TEST_F(HttpLimitsTest, LargeBodiesTakeTurns) {
  // Of unknown length, they might become large.
  const std::string begin = request_of("POST /api/v1/readings", "Transfer-Encoding: chunked\r\n");
  std::vector<std::unique_ptr<HttpClient>> senders;
  for (int i = 0; i < 3; ++i) {
    senders.push_back(std::make_unique<HttpClient>(server_.port()));
    senders.back()->send(begin + "1\r\nx\r\n");
  }
  int busy = 0;
  for (int i = 0; i < 100 && busy != 503; ++i) busy = ask(server_.port(), begin).status;
  EXPECT_EQ(busy, 503);
  EXPECT_EQ(post("small").status, 400);
  for (const auto& each : senders) {
    each->send("0\r\n\r\n");
    EXPECT_EQ(each->reply().status, 400);
  }
  EXPECT_EQ(ask(server_.port(), begin + "0\r\n\r\n").status, 400);
}

TEST_F(HttpLimitsTest, WhoSendsLittleByLittleIsCutOff) {
  // As many as there are places, each a byte at a time, for ever.
  std::vector<std::unique_ptr<HttpClient>> slow;
  for (int i = 0; i < 12; ++i) slow.push_back(std::make_unique<HttpClient>(server_.port()));
  for (const auto& each : slow) each->send("POST /api/v1/readings HTTP/1.1\r\n");
  std::size_t cut = 0;
  for (int i = 0; i < 400 && cut < slow.size(); ++i) {
    cut = 0;
    for (const auto& each : slow) {
      if (!each->send("x")) ++cut;
    }
    std::this_thread::sleep_for(milliseconds(20));
  }
  EXPECT_EQ(cut, slow.size());
  // The same with a body.
  HttpClient body(server_.port());
  body.send(request_of("POST /api/v1/readings", "Content-Length: 5000\r\n"));
  bool open = true;
  for (int i = 0; i < 400 && open; ++i) {
    open = body.send("x");
    std::this_thread::sleep_for(milliseconds(20));
  }
  EXPECT_FALSE(open);
  EXPECT_TRUE(is_well());
}

TEST_F(HttpLimitsTest, OneConnectionTooManyIsTurnedAway) {
  std::vector<std::unique_ptr<HttpClient>> open;
  for (int i = 0; i < 12; ++i) {
    open.push_back(std::make_unique<HttpClient>(server_.port()));
    open.back()->send(request_of("GET /health"));
    EXPECT_EQ(open.back()->reply().status, 200);
  }
  const HttpReply refused = get("/api/v1/fleet");
  EXPECT_EQ(refused.status, 503);
  EXPECT_EQ(refused.field("Retry-After"), "10");
  EXPECT_EQ(get("/health").status, 200);
  EXPECT_EQ(get("/metrics").status, 200);
  open.clear();
  // What closed is seen a moment later.
  bool well = false;
  for (int i = 0; i < 200 && !well; ++i) {
    well = is_well();
    std::this_thread::sleep_for(milliseconds(20));
  }
  EXPECT_TRUE(well);
}

class HttpFairnessTest : public HttpServerTest {
 protected:
  HttpFairnessTest() : HttpServerTest(small()) {}
  static HttpLimits small() {
    HttpLimits limits;
    limits.connections = 20;
    limits.of_client = 6;
    limits.reserve = 3;
    return limits;
  }
  /// A client at another address of this machine.
  HttpReply ask_from(const char* address, const std::string& request) {
    HttpClient client(server_.port(), 0, address);
    client.send(request);
    return client.reply();
  }
};

// One client, with as many connections as it gets, all idle: others are served, and supervision always.
TEST_F(HttpFairnessTest, OneClientTakesNothingFromTheOthers) {
  std::vector<std::unique_ptr<HttpClient>> idle;
  for (int i = 0; i < 100; ++i) {
    idle.push_back(std::make_unique<HttpClient>(server_.port()));
    if (i % 10 == 9) {
      EXPECT_EQ(get("/health").status, 200) << i;
      EXPECT_EQ(ask_from("127.0.0.2", request_of("GET /api/v1/fleet")).status, 200) << i;
    }
  }
  EXPECT_EQ(get("/metrics").status, 200);
  EXPECT_EQ(get("/api/v1/fleet").status, 503);
  EXPECT_EQ(get("/api/v1/events").status, 503);
  EXPECT_EQ(post("{}").status, 503);
  EXPECT_EQ(get("/").status, 503);
  // No kept connection: the next request may be any.
  HttpClient probe(server_.port());
  probe.send(request_of("GET /health"));
  const HttpReply reply = probe.reply();
  EXPECT_EQ(reply.status, 200);
  EXPECT_EQ(reply.field("Connection"), "close");
  idle.clear();
  bool served = false;
  for (int i = 0; i < 200 && !served; ++i) {
    served = get("/api/v1/fleet").status == 200;
    std::this_thread::sleep_for(milliseconds(20));
  }
  EXPECT_TRUE(served);
}

// Many clients take all places: supervision has its own.
TEST_F(HttpFairnessTest, AllPlacesAreTakenButThoseOfSupervision) {
  std::vector<std::unique_ptr<HttpClient>> idle;
  for (int i = 0; i < 20; ++i)
    idle.push_back(std::make_unique<HttpClient>(server_.port(), 0,
                                                ("127.0.0." + std::to_string(10 + i)).c_str()));
  EXPECT_EQ(ask_from("127.0.0.99", request_of("GET /api/v1/fleet")).status, 503);
  for (int i = 0; i < 10; ++i)
    EXPECT_EQ(ask_from("127.0.0.99", request_of("GET /health")).status, 200);
}

// What is no HTTP gets 400 or nothing, and harms nobody.
TEST_F(HttpServerTest, BearsWhatIsNoRequest) {
  const std::string chunked =
      "POST /api/v1/readings HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n";
  const std::vector<std::string> hostile = {
      chunked + "-2\r\nabc\r\n0\r\n\r\n",
      chunked + "zz\r\nabc\r\n0\r\n\r\n",
      chunked + "ffffffffffffffffff\r\nabc\r\n0\r\n\r\n",
      chunked + "3\r\nabcdef\r\n0\r\n\r\n",
      chunked + "3;" + std::string(100'000, 'x') + "\r\nabc\r\n0\r\n\r\n",
      chunked + " 3\r\nabc\r\n0\r\n\r\n",
      "POST /api/v1/readings HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n"
      "Content-Length: 3\r\n\r\n3\r\nabc\r\n0\r\n\r\n",
      "POST /api/v1/readings HTTP/1.1\r\nHost: localhost\r\nContent-Length: 3\r\nContent-Length: "
      "4\r\n\r\nabcd",
      "POST /api/v1/readings HTTP/1.1\r\nHost: localhost\r\nContent-Length: -1\r\n\r\nabcd",
      "POST /api/v1/readings HTTP/1.1\r\nHost: localhost\r\nContent-Length: 0x3\r\n\r\nabc",
      "GET /health HTTP/1.1\r\n\r\n",
      "GET /health HTTP/1.1\r\nHost: localhost\r\nHost: localhost\r\n\r\n",
      "GET http://localhost/health HTTP/1.1\r\nHost: localhost\r\n\r\n",
      "GET health HTTP/1.1\r\nHost: localhost\r\n\r\n",
      "GET * HTTP/1.1\r\nHost: localhost\r\n\r\n",
      "GET /health HTTP/9.9\r\nHost: localhost\r\n\r\n",
      "GET /health\r\n\r\n",
      "GET /hea\tlth HTTP/1.1\r\nHost: localhost\r\n\r\n",
      "GET /health HTTP/1.1\r\nHost : localhost\r\n\r\n",
      "GET /health HTTP/1.1\r\nHost: localhost\r\n folded\r\nA\r\n\r\n",
      std::string("GET /\0 HTTP/1.1\r\n\r\n", 19),
      "\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03" + std::string(500, '\xaa'),
      std::string(20'000, '\n'),
      std::string(20'000, 'A'),
      "\r\n\r\n\r\n"};
  for (const std::string& each : hostile) {
    HttpClient client(server_.port());
    client.send(each);
    client.finish();
    const std::string answer = client.rest();
    EXPECT_EQ(answer.find("HTTP/1.1 200"), std::string::npos) << each.substr(0, 200) << "\n"
                                                              << answer;
    EXPECT_EQ(answer.find("HTTP/1.1 500"), std::string::npos) << each.substr(0, 200);
  }
  EXPECT_TRUE(is_well());
}

TEST_F(HttpServerTest, BearsRequestsThatAreChangedAtRandom) {
  std::mt19937 engine(5);
  const std::vector<std::string> seeds = {
      request_of("POST /api/v1/readings", "Content-Type: text/csv\r\n",
                 "unit,at,wear\nM1010,1,2\n"),
      request_of("GET /api/v1/units?search=a%20b&offset=3&count=9",
                 "Cookie: a=b; wearwell=1.2\r\n"),
      request_of("GET /api/v1/units/M%31010",
                 "If-None-Match: \"x\"\r\nOrigin: http://localhost\r\n"),
      "POST /api/v1/readings HTTP/1.1\r\nHost: [::1]:80\r\nTransfer-Encoding: chunked\r\n\r\n"
      "3\r\nabc\r\n0\r\n\r\n"};
  for (int i = 0; i < 3000; ++i) {
    std::string text = seeds[engine() % seeds.size()];
    for (unsigned changes = 1 + engine() % 6; changes > 0; --changes) {
      const std::size_t at = engine() % text.size();
      switch (engine() % 4) {
        case 0:
          text[at] = static_cast<char>(engine());
          break;
        case 1:
          text.erase(at, 1 + engine() % 9);
          break;
        case 2:
          text.insert(at, text.substr(engine() % text.size(), engine() % 30));
          break;
        default:
          text.insert(at, 1, "\r\n\0%:; "[engine() % 7]);
      }
      if (text.empty()) text = "x";
    }
    HttpClient client(server_.port());
    client.send(text);
    client.finish();
    EXPECT_EQ(client.rest().find("HTTP/1.1 500"), std::string::npos) << text;
  }
  EXPECT_TRUE(is_well());
}

TEST_F(HttpServerTest, StopsAtOnceWhateverIsOpen) {
  std::vector<std::unique_ptr<HttpClient>> open;
  for (int i = 0; i < 30; ++i) {
    open.push_back(std::make_unique<HttpClient>(server_.port()));
    open.back()->send(i % 3 == 0   ? request_of("GET /api/v1/events")
                      : i % 3 == 1 ? request_of("POST /api/v1/readings", "Content-Length: 99\r\n")
                                   : "GET /hea");
  }
  open[0]->until("event: fleet");
  server_.stop();
  for (const auto& each : open) each->rest();
  EXPECT_THROW(HttpClient{server_.port()}, std::runtime_error);
  server_.stop();
}

}  // namespace
}  // namespace wearwell::monitor
