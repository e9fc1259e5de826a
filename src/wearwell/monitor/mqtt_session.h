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

/// A connection to a broker, driven by its owner's thread alone. Nothing is sent but by `write`: so an arrival is acknowledged
/// when its owner says so, not when it is read (libmosquitto queues what it would send where it is told that other threads may send, and leaves
/// the writing to the loop).
class MqttSession {
 public:
  struct Message {
    std::string topic, payload;
  };

  /// Throws InputError where the settings cannot be (no such certificate), MachineError without memory.
  explicit MqttSession(const BrokerSettings& broker, bool keeps_session);
  ~MqttSession();
  MqttSession(const MqttSession&) = delete;
  MqttSession& operator=(const MqttSession&) = delete;

  /// "" when the broker has been reached, else why not. What was read and not acknowledged comes again.
  std::string connect();
  /// Subscribes once the broker has said yes.
  void subscribe(const std::string& filter);
  /// From the next connection on, a retained message tells under this topic whether it is there (STATE of Sparkplug B).
  void tell_presence(const std::string& topic) { presence_ = topic; }
  bool accepted() const { return accepted_; }
  /// What the broker refused, "" for nothing.
  const std::string& refusal() const { return refusal_; }

  /// Waits for something to arrive.
  bool wait(int milliseconds) const;
  /// Reads what has arrived, up to so many messages and bytes. "" or what is wrong with the connection.
  std::string read(std::size_t messages, std::size_t bytes);
  std::vector<Message>& arrived() { return arrived_; }
  /// Sends acknowledgements and all else, and what keeps the connection alive. Likewise.
  std::string write();
  /// Queues a message; false where there is no connection. `quality`: of service, 0 or 1.
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
  std::string tls_;  ///< what went wrong with it last, in the words of its library
  bool accepted_ = false;
  std::vector<Message> arrived_;
  std::size_t arrived_bytes_ = 0;
};

}  // namespace wearwell::monitor
