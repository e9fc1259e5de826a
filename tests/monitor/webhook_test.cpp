// Alarms reach another server: each at least once, in order, and none that flickers.
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <thread>

#include "monitor/fleet_rig.h"
#include "monitor/http_client.h"
#include "wearwell/monitor/webhook.h"

namespace wearwell::monitor {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

constexpr milliseconds minute{60'000};

TEST(AlarmQueues, SendWhatLasts) {
  AlarmQueue queue({{"b", {Alarm::act, false}}}, minute);
  const auto start = AlarmQueue::Clock::now();
  queue.see("a", Alarm::watch, start);
  queue.see("b", Alarm::act, start);  // sent already
  queue.see("c", Alarm::ok, start);
  EXPECT_EQ(queue.size(), 1U);
  EXPECT_THAT(queue.due(start + minute - milliseconds(1)), IsEmpty());
  EXPECT_THAT(queue.due(start + minute), ElementsAre("a"));
  // It goes back before a minute is over, again and again: nothing is sent.
  for (int i = 1; i <= 10; ++i) {
    queue.see("a", i % 2 ? Alarm::ok : Alarm::watch, start + i * minute / 2);
    EXPECT_THAT(queue.due(start + i * minute / 2), IsEmpty());
  }
  // A higher alarm begins its own minute.
  queue.see("a", Alarm::watch, start + 10 * minute);
  queue.see("a", Alarm::act, start + 10 * minute + minute / 2);
  EXPECT_THAT(queue.due(start + 11 * minute), IsEmpty());
  EXPECT_THAT(queue.due(start + 12 * minute), ElementsAre("a"));
  queue.accepted("a", Alarm::act);
  EXPECT_EQ(queue.size(), 0U);
  EXPECT_EQ(queue.sent("a"), (SentAlarm{Alarm::act, false}));
}

TEST(AlarmQueues, WaitLongerAfterEachFailure) {
  AlarmQueue queue({}, milliseconds(0));
  auto now = AlarmQueue::Clock::now();
  queue.see("a", Alarm::act, now);
  queue.see("b", Alarm::act, now + milliseconds(1));
  EXPECT_THAT(queue.due(now + minute), ElementsAre("a", "b"));
  milliseconds pause = AlarmQueue::shortest;
  for (int i = 0; i < 12; ++i) {
    queue.failed("a", now);
    EXPECT_THAT(queue.due(now + pause - milliseconds(1)), testing::Not(testing::Contains("a")));
    now += pause;
    EXPECT_THAT(queue.due(now), testing::Contains("a"));
    pause = std::min(2 * pause, AlarmQueue::longest);
  }
  EXPECT_EQ(pause, AlarmQueue::longest);
}

// The answer to "act" is lost: the server may have it, so "ok" is sent, though it was accepted before.
TEST(AlarmQueues, SendAgainAfterAnAttempt) {
  AlarmQueue queue({}, milliseconds(0));
  const auto now = AlarmQueue::Clock::now();
  queue.see("a", Alarm::act, now);
  queue.attempted("a");
  queue.failed("a", now);
  queue.see("a", Alarm::ok, now);
  EXPECT_THAT(queue.due(now + minute), ElementsAre("a"));
  EXPECT_EQ(queue.waiting("a").alarm, Alarm::ok);
  queue.accepted("a", Alarm::ok);
  queue.see("a", Alarm::ok, now);
  EXPECT_EQ(queue.size(), 0U);
}

/// Accepts one request a connection, answers with these statuses in turn, and keeps the bodies.
class Receiver {
 public:
  explicit Receiver(std::vector<int> statuses) : statuses_(std::move(statuses)) {
    listener_ = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address = loopback(0);
    socklen_t size = sizeof address;
    if (bind(listener_, reinterpret_cast<const sockaddr*>(&address), size) != 0 ||
        listen(listener_, 8) != 0)
      throw std::runtime_error("cannot listen");
    getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
    port = ntohs(address.sin_port);
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
  }
  ~Receiver() {
    thread_.request_stop();
    thread_.join();
    close(listener_);
  }
  std::vector<nlohmann::json> bodies() {
    const std::lock_guard lock(lock_);
    return bodies_;
  }
  std::atomic<int> requests = 0;
  std::string head;
  unsigned short port = 0;

 private:
  void run(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      pollfd ready{listener_, POLLIN, 0};
      if (poll(&ready, 1, 50) <= 0) continue;
      const int client = accept(listener_, nullptr, nullptr);
      std::string text;
      char buffer[4096];
      std::size_t need = std::string::npos, body = 0;
      while (text.size() < need) {
        const ssize_t count = recv(client, buffer, sizeof buffer, 0);
        if (count <= 0) break;
        text.append(buffer, static_cast<std::size_t>(count));
        body = text.find("\r\n\r\n");
        if (body == std::string::npos) continue;
        const std::size_t at = text.find("Content-Length: ");
        need = body + 4 + std::stoul(text.substr(at + 16));
      }
      const auto n = static_cast<std::size_t>(requests++);
      const int status = statuses_[std::min(n, statuses_.size() - 1)];
      {
        const std::lock_guard lock(lock_);
        head = text.substr(0, body);
        bodies_.push_back(nlohmann::json::parse(text.substr(body + 4)));
        bodies_.back()["answer"] = status;
      }
      const std::string answer =
          fmt::format("HTTP/1.1 {} X\r\nContent-Length: 0\r\nConnection: close\r\n\r\n", status);
      if (status != 0) ::send(client, answer.data(), answer.size(), MSG_NOSIGNAL);
      close(client);
    }
  }
  std::vector<int> statuses_;
  int listener_ = -1;
  std::mutex lock_;
  std::vector<nlohmann::json> bodies_;
  std::jthread thread_;
};

class Webhooks : public FleetRig {
 protected:
  WebhookSettings settings(unsigned short port) {
    WebhookSettings settings;
    settings.url = "http://127.0.0.1/alarms";
    settings.host = "127.0.0.1";
    settings.port = std::to_string(port);
    settings.target = "/alarms?site=2";
    settings.token = "secret";
    settings.lasting = milliseconds(0);
    return settings;
  }
  static bool eventually(const std::function<bool()>& holds) {
    for (int i = 0; i < 400 && !holds(); ++i) std::this_thread::sleep_for(milliseconds(25));
    return holds();
  }
};

TEST_F(Webhooks, SendEachAlarmUntilItIsAccepted) {
  open();
  for (int n = 1; n <= 20; ++n) deliver(message("a", n, 49.0 * n, 49 * n));
  deliver(message("b", 1, 1, 1));
  catch_up();
  Receiver receiver({500, 0, 204});
  WebhookCounts counts;
  {
    std::jthread sender([&](std::stop_token stop) {
      send_alarms(*fleet_, settings(receiver.port), *store_, quiet_, counts, std::move(stop));
    });
    ASSERT_TRUE(eventually([&] { return counts.sent == 1; }));
  }
  EXPECT_EQ(counts.failed, 2U);
  EXPECT_EQ(counts.waiting, 0U);
  const auto bodies = receiver.bodies();
  ASSERT_THAT(bodies, SizeIs(3));
  for (const auto& each : bodies) {
    EXPECT_EQ(each["unit"], "a");
    EXPECT_EQ(each["alarm"], "act");
    EXPECT_EQ(each["before"], "ok");
    EXPECT_EQ(each["state"]["alarm_ms"], each["alarm_ms"]);
    EXPECT_EQ(each["level_unit"], "m");
  }
  EXPECT_THAT(receiver.head, testing::StartsWith("POST /alarms?site=2 HTTP/1.1"));
  EXPECT_THAT(receiver.head,
              testing::HasSubstr(fmt::format("Host: 127.0.0.1:{}\r\n", receiver.port)));
  EXPECT_THAT(receiver.head, testing::HasSubstr("Authorization: Bearer secret"));
  EXPECT_EQ(store_->sent_alarms(), (std::map<std::string, SentAlarm>{{"a", {Alarm::act, false}}}));
  // After a restart it is not sent again.
  std::jthread again([&](std::stop_token stop) {
    send_alarms(*fleet_, settings(receiver.port), *store_, quiet_, counts, std::move(stop));
  });
  std::this_thread::sleep_for(milliseconds(800));
  EXPECT_EQ(receiver.requests, 3);
}

// The server has accepted "act" and its answer was lost with the monitor; the unit is ok by the next
// start: it hears so.
TEST_F(Webhooks, SendWhatFollowsALostAnswer) {
  open();
  deliver(message("a", 1, 1, 1));
  deliver(message("b", 1, 1, 1));
  catch_up();
  ASSERT_EQ(fleet_->view("a")->alarm, Alarm::ok);
  store_->note_sent("a", {Alarm::ok, true}, 1);
  Receiver receiver({200});
  WebhookCounts counts;
  {
    std::jthread sender([&](std::stop_token stop) {
      send_alarms(*fleet_, settings(receiver.port), *store_, quiet_, counts, std::move(stop));
    });
    ASSERT_TRUE(eventually([&] { return counts.sent == 1; }));
    ASSERT_TRUE(eventually([&] { return !store_->sent_alarms()["a"].unconfirmed; }));
  }
  const auto bodies = receiver.bodies();
  ASSERT_THAT(bodies, SizeIs(1));
  EXPECT_EQ(bodies[0]["unit"], "a");
  EXPECT_EQ(bodies[0]["alarm"], "ok");
}

// A server that accepts and does not answer holds the sender up no longer than until it is stopped.
TEST_F(Webhooks, EndWithoutAnAnswer) {
  open();
  for (int n = 1; n <= 20; ++n) deliver(message("a", n, 49.0 * n, 49 * n));
  catch_up();
  const int listener = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address = loopback(0);
  socklen_t size = sizeof address;
  ASSERT_EQ(bind(listener, reinterpret_cast<const sockaddr*>(&address), size), 0);
  ASSERT_EQ(listen(listener, 8), 0);
  getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size);
  WebhookCounts counts;
  {
    std::jthread sender([&](std::stop_token stop) {
      send_alarms(*fleet_, settings(ntohs(address.sin_port)), *store_, quiet_, counts,
                  std::move(stop));
    });
    pollfd ready{listener, POLLIN, 0};
    EXPECT_EQ(poll(&ready, 1, 10'000), 1);
  }
  EXPECT_EQ(counts.sent, 0U);
  // It may have accepted it all the same.
  EXPECT_EQ(store_->sent_alarms(), (std::map<std::string, SentAlarm>{{"a", {Alarm::ok, true}}}));
  ::close(listener);
}

}  // namespace
}  // namespace wearwell::monitor
