#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "wearwell/monitor/monitor_config.h"

struct mosquitto;
struct mosquitto_message;

namespace wearwell::monitor {

/// A connection to a broker, driven only by its owner's thread. Only `write` sends: an arrival is
/// acknowledged when the owner decides so, not when it is read (libmosquitto queues its output in
/// threaded mode, and leaves the writing to the loop).
class MqttSession {
 public:
  struct Message {
    std::string topic, payload;
  };

  /// Throws InputError for invalid settings (no such certificate), MachineError if out of memory.
  explicit MqttSession(const BrokerSettings& broker, bool keeps_session);
  ~MqttSession();
  MqttSession(const MqttSession&) = delete;
  MqttSession& operator=(const MqttSession&) = delete;

  /// "" when the broker is reached, else the reason. Messages that were read but not acknowledged
  /// are delivered again.
  std::string connect();
  /// Subscribes once the broker has accepted the connection.
  void subscribe(const std::string& filter);
  /// From the next connection on, a retained message under this topic shows whether it is online
  /// (STATE of Sparkplug B).
  void tell_presence(const std::string& topic) { presence_ = topic; }
  bool accepted() const { return accepted_; }
  /// The broker's refusal, "" if none.
  const std::string& refusal() const { return refusal_; }

  /// Waits for an arrival.
  bool wait(int milliseconds) const;
  /// Reads arrivals, up to a number of messages and bytes. "" or the error of the connection.
  std::string read(std::size_t messages, std::size_t bytes);
  std::vector<Message>& arrived() { return arrived_; }
  /// Sends acknowledgements, queued messages and keep-alive. Returns the same.
  std::string write();
  /// Queues a message; false without a connection. `quality`: of service, 0 or 1.
  bool publish(const std::string& topic, const std::string& payload, bool retain, int quality = 1);
  void disconnect();

 private:
  static void on_connect(mosquitto* client, void* self, int code);
  static void on_message(mosquitto* client, void* self, const mosquitto_message* message);
  static void on_log(mosquitto* client, void* self, int level, const char* text);
  std::string description(int code) const;

  std::string presence(bool online) const;

  const BrokerSettings broker_;
  const bool keeps_session_;
  mosquitto* client_ = nullptr;
  std::string filter_, refusal_, presence_;
  std::int64_t connected_ms_ = 0;
  std::string tls_;  ///< its last error, in the words of its library
  bool accepted_ = false;
  std::vector<Message> arrived_;
  std::size_t arrived_bytes_ = 0;
};

}  // namespace wearwell::monitor
