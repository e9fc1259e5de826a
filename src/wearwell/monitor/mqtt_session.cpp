#include "wearwell/monitor/mqtt_session.h"

#include <fmt/format.h>
#include <mosquitto.h>
#include <mqtt_protocol.h>
#include <poll.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/monitor/message.h"
#include "wearwell/monitor/time_text.h"

namespace wearwell::monitor {
namespace {

constexpr int keepalive_s = 30;
constexpr int most_unacknowledged = 2000;
constexpr int at_least_once = 1;

struct Library {
  Library() { mosquitto_lib_init(); }
  ~Library() { mosquitto_lib_cleanup(); }
};

}  // namespace

MqttSession::MqttSession(const BrokerSettings& broker, bool keeps_session)
    : broker_(broker), keeps_session_(keeps_session) {
  static const Library library;
  client_ = mosquitto_new(broker.client.c_str(), !keeps_session, this);
  if (!client_) throw MachineError("out of memory for an MQTT client");
  mosquitto_int_option(client_, MOSQ_OPT_PROTOCOL_VERSION,
                       broker.version5 ? MQTT_PROTOCOL_V5 : MQTT_PROTOCOL_V311);
  mosquitto_int_option(client_, MOSQ_OPT_RECEIVE_MAXIMUM, most_unacknowledged);
  mosquitto_int_option(client_, MOSQ_OPT_TCP_NODELAY, 1);
  mosquitto_threaded_set(client_, true);
  mosquitto_connect_callback_set(client_, on_connect);
  mosquitto_message_callback_set(client_, on_message);
  if (broker.tls) mosquitto_log_callback_set(client_, on_log);
  if (!broker.user.empty())
    mosquitto_username_pw_set(client_, broker.user.c_str(),
                              broker.password.empty() ? nullptr : broker.password.c_str());
  if (!broker.tls) return;
  const char* file = broker.authority.empty() ? nullptr : broker.authority.c_str();
  const int code = mosquitto_tls_set(client_, file, file ? nullptr : "/etc/ssl/certs", nullptr,
                                     nullptr, nullptr);
  if (code != MOSQ_ERR_SUCCESS) {
    const std::string why = description(code);
    mosquitto_destroy(std::exchange(client_, nullptr));
    throw InputError(fmt::format("TLS to the broker {}: {}", broker.host, why));
  }
}

MqttSession::~MqttSession() {
  if (client_) mosquitto_destroy(client_);
}

void MqttSession::on_connect(mosquitto* client, void* self, int code) {
  auto& session = *static_cast<MqttSession*>(self);
  if (code != 0) {
    session.refusal_ =
        session.broker_.version5 ? mosquitto_reason_string(code) : mosquitto_connack_string(code);
    return;
  }
  session.accepted_ = true;
  if (!session.filter_.empty()) mosquitto_subscribe(client, nullptr, session.filter_.c_str(), 1);
  if (!session.presence_.empty()) session.publish(session.presence_, session.presence(true), true);
}

std::string MqttSession::presence(bool online) const {
  return fmt::format("{{\"online\":{},\"timestamp\":{}}}", online, connected_ms_);
}

void MqttSession::on_message(mosquitto*, void* self, const mosquitto_message* message) {
  auto& session = *static_cast<MqttSession*>(self);
  const auto size = static_cast<std::size_t>(message->payloadlen);
  session.arrived_.push_back(
      {message->topic,
       size ? std::string(static_cast<const char*>(message->payload), size) : std::string()});
  session.arrived_bytes_ += size;
}

// "OpenSSL Error[0]: error:0A000086:SSL routines::certificate verify failed".
void MqttSession::on_log(mosquitto*, void* self, int level, const char* text) {
  const std::string_view said = text;
  if (level != MOSQ_LOG_ERR || said.find("SSL") == said.npos) return;
  const std::size_t colon = said.rfind(':');
  static_cast<MqttSession*>(self)->tls_ = said.substr(colon == said.npos ? 0 : colon + 1);
}

std::string MqttSession::description(int code) const {
  if (code == MOSQ_ERR_SUCCESS) return {};
  if (code == MOSQ_ERR_ERRNO) return std::strerror(errno);
  if (code != MOSQ_ERR_TLS || tls_.empty()) return mosquitto_strerror(code);
  const bool doubted = tls_.find("certificate verify failed") != tls_.npos;
  return fmt::format(
      "TLS: {}{}", printable(valid_utf8(tls_)),
      !doubted ? ""
      : broker_.authority.empty()
          ? ": the system's certificate authorities do not confirm it; add authority = \"ca.pem\""
          : fmt::format(": {} does not confirm it, or it is for another host",
                        broker_.authority.string()));
}

std::string MqttSession::connect() {
  tls_.clear();
  arrived_.clear();
  arrived_bytes_ = 0;
  accepted_ = false;
  refusal_.clear();
  if (!presence_.empty()) {
    connected_ms_ = unix_ms_now();
    const std::string gone = presence(false);
    mosquitto_will_set(client_, presence_.c_str(), static_cast<int>(gone.size()), gone.data(),
                       at_least_once, true);
  }
  int code = MOSQ_ERR_SUCCESS;
  if (broker_.version5) {
    mosquitto_property* properties = nullptr;
    constexpr std::uint32_t forever = 0xffffffff;
    mosquitto_property_add_int32(&properties, MQTT_PROP_SESSION_EXPIRY_INTERVAL,
                                 keeps_session_ ? forever : 0);
    mosquitto_property_add_int32(&properties, MQTT_PROP_MAXIMUM_PACKET_SIZE,
                                 static_cast<std::uint32_t>(longest_message + longest_row));
    code = mosquitto_connect_bind_v5(client_, broker_.host.c_str(), broker_.port, keepalive_s,
                                     nullptr, properties);
    mosquitto_property_free_all(&properties);
  } else {
    code = mosquitto_connect(client_, broker_.host.c_str(), broker_.port, keepalive_s);
  }
  return description(code);
}

void MqttSession::subscribe(const std::string& filter) {
  filter_ = filter;
}

bool MqttSession::wait(int milliseconds) const {
  const int socket = mosquitto_socket(client_);
  if (socket < 0) return false;
  pollfd ready{socket, POLLIN, 0};
  return poll(&ready, 1, milliseconds) > 0;
}

std::string MqttSession::read(std::size_t messages, std::size_t bytes) {
  do {
    errno = 0;
    const int code = mosquitto_loop_read(client_, 1);
    if (code != MOSQ_ERR_SUCCESS) return description(code);
  } while (arrived_.size() < messages && arrived_bytes_ < bytes && wait(0));
  arrived_bytes_ = 0;
  return refusal_;
}

std::string MqttSession::write() {
  while (mosquitto_want_write(client_)) {
    errno = 0;
    const int code = mosquitto_loop_write(client_, 1);
    if (code != MOSQ_ERR_SUCCESS) return description(code);
    if (errno == EAGAIN) break;
  }
  return description(mosquitto_loop_misc(client_));
}

bool MqttSession::publish(const std::string& topic, const std::string& payload, bool retain,
                          int quality) {
  return accepted_ &&
         mosquitto_publish(client_, nullptr, topic.c_str(), static_cast<int>(payload.size()),
                           payload.data(), quality, retain) == MOSQ_ERR_SUCCESS;
}

void MqttSession::disconnect() {
  if (!presence_.empty() && publish(presence_, presence(false), true)) static_cast<void>(write());
  mosquitto_disconnect(client_);
  static_cast<void>(write());
}

}  // namespace wearwell::monitor
