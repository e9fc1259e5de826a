#include <gmock/gmock.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "monitor/generated_fleet.h"
#include "monitor/http_client.h"
#include "wearwell/monitor/http_server.h"

namespace wearwell::monitor {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::StartsWith;
using testing::UnorderedElementsAre;

struct Event {
  std::string id, kind;
  json data;
};

Event event_of(const std::string& text) {
  Event event;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("id: ")) event.id = line.substr(4);
    if (line.starts_with("event: ")) event.kind = line.substr(7);
    if (line.starts_with("data: ")) event.data = json::parse(line.substr(6));
  }
  return event;
}

/// One who listens.
class Listener {
 public:
  explicit Listener(unsigned short port, const std::string& last = "", int buffer = 0)
      : client_(port, buffer) {
    client_.send(
        request_of("GET /api/v1/events", last.empty() ? "" : "Last-Event-ID: " + last + "\r\n"));
  }
  /// Nothing but its head.
  std::string head() { return client_.until("\r\n\r\n"); }
  /// The next one of the fleet.
  Event next() {
    if (!begun_) {
      head();
      client_.until("\n\n");  // how long to wait before it is tried again
      begun_ = true;
    }
    for (;;) {
      const std::string text = client_.until("\n\n");
      if (text.empty()) return {};
      Event event = event_of(text);
      if (event.kind == "fleet") return event;
      ++beats;
    }
  }
  int beats = 0;

 private:
  HttpClient client_;
  bool begun_ = false;
};

class HttpEventsTest : public testing::Test {
 protected:
  static HttpSettings settings() {
    HttpSettings settings;
    settings.port = 0;
    settings.limits.between = milliseconds(20);
    settings.limits.beat = milliseconds(100);
    settings.limits.write = milliseconds(1000);
    settings.limits.streams = settings.limits.streams_of_client = 20;
    return settings;
  }
  GeneratedFleet fleet_{300};
  HttpServer server_{settings(), fleet_, &fleet_};
};

TEST_F(HttpEventsTest, TellWhatChanged) {
  Listener listener(server_.port());
  const Event first = listener.next();
  EXPECT_EQ(first.data["all"], true);
  EXPECT_EQ(first.data["fleet"]["units"]["all"], 300);
  const std::string name = fleet_.advance(42);
  const Event second = listener.next();
  EXPECT_EQ(second.data["all"], false);
  EXPECT_THAT(second.data["changed"], ElementsAre(name));
  EXPECT_GT(second.data["version"], first.data["version"]);
  EXPECT_EQ(second.data["fleet"]["messages"]["received"], fleet_.fleet().messages);
  // Without news it beats.
  std::this_thread::sleep_for(milliseconds(500));
  fleet_.advance(43);
  listener.next();
  EXPECT_GT(listener.beats, 0);
}

TEST_F(HttpEventsTest, GoOnWhereTheyWereInterrupted) {
  std::string last;
  {
    Listener listener(server_.port());
    last = listener.next().id;
  }
  const std::string one = fleet_.advance(7), other = fleet_.advance(8);
  Listener again(server_.port(), last);
  const Event event = again.next();
  EXPECT_EQ(event.data["all"], false);
  EXPECT_THAT(event.data["changed"], UnorderedElementsAre(one, other));
  // What is no event of this run tells nothing of where it was.
  for (const std::string& id :
       std::vector<std::string>{"12.3", last + "x", "nonsense", last + "99"}) {
    EXPECT_EQ(Listener(server_.port(), id).next().data["all"], true) << id;
  }
}

TEST_F(HttpEventsTest, ThatNameManyNameNone) {
  Listener listener(server_.port());
  const std::string last = listener.next().id;
  for (int i = 0; i < 250; ++i) fleet_.advance(i);
  const Event event = Listener(server_.port(), last).next();
  EXPECT_EQ(event.data["all"], true);
  EXPECT_EQ(event.data["changed"].size(), 0u);
}

// Twenty listen to each change; the next is turned away until one goes.
TEST_F(HttpEventsTest, ReachAllButNotMoreThanAllowed) {
  std::vector<std::unique_ptr<Listener>> listeners;
  for (int i = 0; i < 20; ++i) {
    listeners.push_back(std::make_unique<Listener>(server_.port()));
    listeners.back()->next();
  }
  EXPECT_EQ(get(server_.port(), "/api/v1/events").status, 503);
  EXPECT_EQ(get(server_.port(), "/api/v1/fleet").status, 200);
  for (int round = 0; round < 5; ++round) {
    const std::string name = fleet_.advance(round);
    for (const auto& each : listeners) {
      EXPECT_THAT(each->next().data["changed"], ElementsAre(name));
    }
  }
  listeners.pop_back();
  HttpReply reply;
  for (int i = 0; i < 200 && reply.status != 200; ++i) {
    std::this_thread::sleep_for(milliseconds(20));
    HttpClient client(server_.port());
    client.send(request_of("GET /api/v1/events"));
    reply = client.reply(false);
  }
  EXPECT_EQ(reply.status, 200);
}

// One who listens but does not read: the others go on, and it is cut off when it has not taken an event in time.
TEST_F(HttpEventsTest, WaitForNobody) {
  HttpClient deaf(server_.port(), 1024);
  deaf.send(request_of("GET /api/v1/events"));
  Listener listener(server_.port());
  listener.next();
  const auto streams = [&] {
    const std::string text = get(server_.port(), "/metrics").body;
    const std::string name = "\nwearwell_http_event_streams ";
    return std::atoi(text.c_str() + text.find(name) + name.size());
  };
  EXPECT_EQ(streams(), 2);
  // A hundred and fifty names an event, until neither its buffers nor ours take more.
  bool cut = false;
  for (int round = 0; round < 4000 && !cut; ++round) {
    for (int i = 0; i < 150; ++i) fleet_.advance(i, 0.01);
    EXPECT_NE(listener.next().id, "");
    cut = round % 50 == 49 && streams() == 1;
  }
  EXPECT_TRUE(cut);
}

// One client has a part of the streams; the others of another address, and it again after one ends.
TEST(HttpEventsOfOneClient, AreLimited) {
  HttpSettings settings;
  settings.port = 0;
  settings.limits.streams_of_client = 3;
  GeneratedFleet fleet(10);
  HttpServer server(settings, fleet, &fleet);
  std::vector<std::unique_ptr<Listener>> listeners;
  for (int i = 0; i < 3; ++i) {
    listeners.push_back(std::make_unique<Listener>(server.port()));
    EXPECT_NE(listeners.back()->next().id, "");
  }
  const HttpReply refused = ask(server.port(), request_of("GET /api/v1/events"));
  EXPECT_EQ(refused.status, 503);
  EXPECT_NE(refused.body.find("this client"), std::string::npos) << refused.body;
  EXPECT_EQ(get(server.port(), "/api/v1/fleet").status, 200);
  listeners.pop_back();
  bool again = false;
  for (int i = 0; i < 200 && !again; ++i) {
    std::this_thread::sleep_for(milliseconds(10));
    HttpClient client(server.port());
    client.send(request_of("GET /api/v1/events"));
    again = client.until("\r\n\r\n").find(" 200 ") != std::string::npos;
  }
  EXPECT_TRUE(again);
}

}  // namespace
}  // namespace wearwell::monitor
