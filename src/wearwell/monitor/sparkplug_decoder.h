#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "wearwell/monitor/intake.h"
#include "wearwell/monitor/sparkplug_metrics.h"
#include "wearwell/monitor/sparkplug_topic.h"

namespace wearwell::monitor {

/// Converts messages of Sparkplug B to rows (docs/reference/monitor.md): keeps for each edge node
/// and device its birth certificate, its current values, and whether a message is missing.
/// Ambiguous content becomes a row with a problem, and the edge node is asked for its birth
/// certificates. One thread calls; times are from a monotonic clock.
class SparkplugDecoder {
 public:
  /// `settings` must outlive it.
  explicit SparkplugDecoder(const SourceSettings& settings);
  SparkplugDecoder(const SparkplugDecoder&) = delete;
  SparkplugDecoder& operator=(const SparkplugDecoder&) = delete;

  /// Adds the rows of one message.
  void read(std::string_view topic, std::string_view payload, std::vector<Row>& rows);
  /// Resets all knowledge: messages may have been missed.
  void forget();
  /// Topics of NCMD of the edge nodes to ask for their birth certificates now: each at once, and
  /// again after growing pauses.
  std::vector<std::string> rebirths(std::int64_t clock_ms);

 private:
  /// An edge node itself, or a device of it.
  struct Scope {
    bool alive = false;
    std::string problem;                                     // with its birth certificate
    std::unordered_map<std::uint64_t, std::size_t> aliases;  // -> name, or `unnamed`
    std::vector<KnownMetric> known;                          // by name
  };
  struct Node {
    std::string ask_topic;
    bool alive = false;
    std::uint8_t next = 0;                             // number of its next message
    std::optional<std::uint64_t> session;              // metric "bdSeq"
    std::map<std::string, Scope, std::less<>> scopes;  // "" is the edge node's own
    std::int64_t asked_ms = 0, pause_ms = 0;
  };

  void take(const SparkplugTopic& topic, std::string_view payload, std::vector<Row>& rows);
  void take_data(Node& node, const SparkplugTopic& topic, const SparkplugPayload& payload,
                 std::vector<Row>& rows);
  void take_birth(Node& node, const SparkplugTopic& topic, const SparkplugPayload& payload,
                  std::vector<Row>& rows);
  void define(Scope& scope, const SparkplugTopic& topic, const SparkplugPayload& payload);
  void take_death(Node& node, const SparkplugPayload& payload);
  void count_on(Node& node, const SparkplugPayload& payload);
  std::size_t name_of_metric(Node& node, const Scope& scope, const SparkplugMetric& metric);
  void take_values(Scope& scope, const SparkplugTopic& topic, const SparkplugPayload& payload,
                   const std::vector<std::size_t>& name_of, bool makes_rows,
                   std::vector<Row>& rows);
  Node& node_of(const SparkplugTopic& topic);
  Scope& scope_of(Node& node, const SparkplugTopic& topic);
  void own(const SparkplugTopic& topic);
  bool brings_units(const SparkplugTopic& topic) const;

  const SourceSettings& settings_;
  const std::vector<SparkplugName> names_;
  std::unordered_map<std::string_view, std::size_t> index_;  // of names
  std::unordered_map<std::string, Node> nodes_;
  // unit that the topic names -> its edge node or device
  std::unordered_map<std::string, std::string> owners_;
  std::set<Node*> asking_;
  std::size_t scopes_ = 0, aliases_ = 0;
};

}  // namespace wearwell::monitor
