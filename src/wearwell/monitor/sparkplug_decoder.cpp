#include "wearwell/monitor/sparkplug_decoder.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"

namespace wearwell::monitor {
namespace {

constexpr std::size_t unnamed = SIZE_MAX;  // a metric that the configuration does not name
constexpr std::size_t most_scopes = 100'000, most_aliases = 5'000'000;
constexpr std::int64_t shortest_pause_ms = 2000, longest_pause_ms = 300'000;

std::string shown_text(std::string_view text) {
  return printable(shortened(text));
}

std::string shown_node(const SparkplugTopic& topic) {
  return shown_text(topic.device.empty()
                        ? fmt::format("{}/{}", topic.group, topic.edge)
                        : fmt::format("{}/{}/{}", topic.group, topic.edge, topic.device));
}

}  // namespace

SparkplugDecoder::SparkplugDecoder(const SourceSettings& settings)
    : settings_(settings), names_(sparkplug_names(settings.mapping)) {
  for (std::size_t i = 0; i < names_.size(); ++i) index_.emplace(names_[i].text, i);
}

void SparkplugDecoder::forget() {
  nodes_.clear();
  owners_.clear();
  asking_.clear();
  scopes_ = aliases_ = 0;
}

void SparkplugDecoder::read(std::string_view text, std::string_view payload,
                            std::vector<Row>& rows) {
  const auto topic = sparkplug_topic(text);
  const std::string_view type = topic ? topic->type : "";
  if (type == "NCMD" || type == "DCMD") return;  // of hosts
  std::string unit;
  std::vector<Row> made;
  try {
    const std::string_view of_device = topic && !topic->device.empty() ? "D" : "N";
    if (!type.starts_with(of_device) ||
        (type.substr(1) != "BIRTH" && type.substr(1) != "DATA" && type.substr(1) != "DEATH"))
      throw InputError("is not a topic of an edge node or a device of Sparkplug B");
    if (names_by_topic(settings_.mapping.unit) && brings_units(*topic))
      unit = name_of_topic(settings_.mapping.unit, *topic);
    take(*topic, payload, made);
  } catch (const InputError& error) {
    made.clear();
    made.push_back(
        {unit, {}, fmt::format("the message of topic '{}' {}", shown_text(text), error.what())});
  }
  std::move(made.begin(), made.end(), std::back_inserter(rows));
}

void SparkplugDecoder::take(const SparkplugTopic& topic, std::string_view message,
                            std::vector<Row>& rows) {
  Node& node = node_of(topic);
  SparkplugPayload payload;
  try {
    payload = read_sparkplug(message);
  } catch (const InputError&) {
    // The content of its birth certificate is unknown.
    node.alive = false;
    asking_.insert(&node);
    throw;
  }
  if (topic.type == "NDEATH") return take_death(node, payload);
  if (topic.type == "NBIRTH") return take_birth(node, topic, payload, rows);
  count_on(node, payload);
  if (topic.type == "DBIRTH") return take_birth(node, topic, payload, rows);
  if (topic.type == "DDEATH") {
    scope_of(node, topic).alive = false;
    return;
  }
  take_data(node, topic, payload, rows);
}

void SparkplugDecoder::count_on(Node& node, const SparkplugPayload& payload) {
  if (!node.alive) {
    asking_.insert(&node);
    throw InputError("comes before a birth certificate, which is requested");
  }
  if (payload.sequence == node.next) {
    ++node.next;
    return;
  }
  // The changes of the missing message are unknown: neither the current values nor aliases are
  // valid.
  node.alive = false;
  for (const auto& [device, scope] : node.scopes) aliases_ -= scope.aliases.size();
  scopes_ -= node.scopes.size();
  node.scopes.clear();
  asking_.insert(&node);
  throw InputError(fmt::format(
      "has number {} instead of {}: a message is missing, and the birth certificate is requested",
      payload.sequence, node.next));
}

void SparkplugDecoder::take_birth(Node& node, const SparkplugTopic& topic,
                                  const SparkplugPayload& payload, std::vector<Row>& rows) {
  if (topic.device.empty()) {
    node.alive = true;
    node.next = static_cast<std::uint8_t>(payload.sequence + 1);
    node.session.reset();
    for (const SparkplugMetric& each : payload.metrics) {
      if (each.name == "bdSeq") node.session = each.bits;
    }
    for (auto& [device, scope] : node.scopes) scope.alive = false;
    asking_.erase(&node);
  }
  Scope& scope = scope_of(node, topic);
  scope.alive = true;
  scope.problem.clear();
  if (!brings_units(topic)) return;
  try {
    define(scope, topic, payload);
  } catch (const InputError& error) {
    scope.problem = fmt::format("follows a birth certificate that {}", error.what());
    throw;
  }
  std::vector<std::size_t> name_of;
  for (const SparkplugMetric& each : payload.metrics) {
    const auto found = index_.find(*each.name);
    name_of.push_back(found == index_.end() ? unnamed : found->second);
  }
  take_values(scope, topic, payload, name_of, settings_.births_are_readings, rows);
}

void SparkplugDecoder::define(Scope& scope, const SparkplugTopic& topic,
                              const SparkplugPayload& payload) {
  own(topic);
  aliases_ -= scope.aliases.size();
  scope.aliases.clear();
  scope.known.resize(names_.size());
  for (KnownMetric& each : scope.known) {
    each.born = false;
    if (each.now) each.before = std::exchange(each.now, {});
  }
  for (const SparkplugMetric& each : payload.metrics) {
    if (!each.name) throw InputError("has a metric without a name");
    const auto found = index_.find(*each.name);
    const std::size_t name = found == index_.end() ? unnamed : found->second;
    if (name != unnamed) {
      if (scope.known[name].born)
        throw InputError(fmt::format("has metric {} twice", shown_text(*each.name)));
      be_born(scope.known[name], names_[name], each, settings_.mapping);
    }
    if (!each.alias) continue;
    if (aliases_ == most_aliases)
      throw InputError(
          fmt::format("has more aliases than the limit of {} for all edge nodes", most_aliases));
    if (!scope.aliases.emplace(*each.alias, name).second)
      throw InputError(fmt::format("gives alias {} to two metrics", *each.alias));
    ++aliases_;
  }
}

void SparkplugDecoder::take_death(Node& node, const SparkplugPayload& payload) {
  // One of an earlier connection came late, and does not concern this one.
  for (const SparkplugMetric& each : payload.metrics) {
    if (each.name == "bdSeq" && node.session && each.bits != *node.session) return;
  }
  node.alive = false;
  for (auto& [device, scope] : node.scopes) scope.alive = false;
}

std::size_t SparkplugDecoder::name_of_metric(Node& node, const Scope& scope,
                                             const SparkplugMetric& metric) {
  const auto ask = [&](const std::string& what) {
    asking_.insert(&node);
    return InputError(fmt::format("has {}, which is in no birth certificate", what));
  };
  if (metric.alias) {
    const auto found = scope.aliases.find(*metric.alias);
    if (found != scope.aliases.end()) return found->second;
    if (!metric.name) throw ask(fmt::format("alias {}", *metric.alias));
  }
  if (!metric.name) throw InputError("has a metric with neither a name nor an alias");
  const auto found = index_.find(*metric.name);
  if (found == index_.end()) return unnamed;
  if (!scope.known[found->second].born)
    throw ask(fmt::format("metric {}", shown_text(*metric.name)));
  return found->second;
}

void SparkplugDecoder::take_data(Node& node, const SparkplugTopic& topic,
                                 const SparkplugPayload& payload, std::vector<Row>& rows) {
  Scope& scope = scope_of(node, topic);
  if (!scope.alive) {
    asking_.insert(&node);
    throw InputError("comes before its own birth certificate, which is requested");
  }
  if (!scope.problem.empty()) throw InputError(scope.problem);
  if (!brings_units(topic)) return;
  std::vector<std::size_t> name_of;
  for (const SparkplugMetric& each : payload.metrics)
    name_of.push_back(name_of_metric(node, scope, each));
  take_values(scope, topic, payload, name_of, true, rows);
}

void SparkplugDecoder::take_values(Scope& scope, const SparkplugTopic& topic,
                                   const SparkplugPayload& payload,
                                   const std::vector<std::size_t>& name_of, bool makes_rows,
                                   std::vector<Row>& rows) {
  for (const bool historical : {true, false}) {
    SparkplugValues values(names_.size());
    bool any = false;
    for (std::size_t i = 0; i < name_of.size(); ++i) {
      const SparkplugMetric& metric = payload.metrics[i];
      const std::size_t name = name_of[i];
      if (name == unnamed || metric.historical != historical) continue;
      values[name].push_back(
          value_of(scope.known[name], names_[name], metric, payload.timestamp, settings_.mapping));
      any = true;
    }
    if (!any) continue;
    for (auto& each : values)
      std::stable_sort(each.begin(), each.end(),
                       [](const auto& a, const auto& b) { return a.time_ms < b.time_ms; });
    if (makes_rows) {
      for (auto& reading : readings_of(names_, scope.known, values, historical)) {
        Row row{"", std::move(reading.fields), std::move(reading.problem)};
        const auto add = [&](const std::string& field) {
          if (!names_by_topic(field)) return;
          row.fields.push_back({field, Field::Kind::text});
          row.fields.back().text = name_of_topic(field, topic);
        };
        add(settings_.mapping.unit);
        for (const std::string& label : settings_.mapping.labels) add(label);
        if (const Field* unit = find_field(row.fields, settings_.mapping.unit))
          row.unit = unit->text;
        rows.push_back(std::move(row));
      }
    }
    hold(names_, values, historical, scope.known);
  }
}

SparkplugDecoder::Node& SparkplugDecoder::node_of(const SparkplugTopic& topic) {
  const std::string key = fmt::format("{}/{}", topic.group, topic.edge);
  const auto found = nodes_.find(key);
  if (found != nodes_.end()) return found->second;
  if (nodes_.size() == most_scopes)
    throw InputError(fmt::format("is of a new edge node; the limit is {}", most_scopes));
  Node& node = nodes_[key];
  node.ask_topic = fmt::format("spBv1.0/{}/NCMD/{}", topic.group, topic.edge);
  return node;
}

SparkplugDecoder::Scope& SparkplugDecoder::scope_of(Node& node, const SparkplugTopic& topic) {
  const auto found = node.scopes.find(topic.device);
  if (found != node.scopes.end()) return found->second;
  if (scopes_ == most_scopes)
    throw InputError(fmt::format("is of a new device; the limit is {}", most_scopes));
  ++scopes_;
  return node.scopes[std::string(topic.device)];
}

bool SparkplugDecoder::brings_units(const SparkplugTopic& topic) const {
  const std::string& unit = settings_.mapping.unit;
  if (!names_by_topic(unit)) return true;
  return (unit.find("{device}") != unit.npos) == !topic.device.empty();
}

// Two devices of one name at two edge nodes are two machines, and must not be mixed, even if one of
// them is dead now.
void SparkplugDecoder::own(const SparkplugTopic& topic) {
  if (!names_by_topic(settings_.mapping.unit)) return;
  const std::string who = shown_node(topic);
  if (owners_.size() == most_scopes) owners_.clear();
  const auto [owner, is_new] = owners_.emplace(name_of_topic(settings_.mapping.unit, topic), who);
  if (!is_new && owner->second != who)
    throw InputError(
        fmt::format("has unit '{}', as does {}; distinguish them, for example with unit = "
                    "\"{{edge}}/{{device}}\"",
                    shown_text(owner->first), owner->second));
}

std::vector<std::string> SparkplugDecoder::rebirths(std::int64_t clock_ms) {
  std::vector<std::string> topics;
  for (auto each = asking_.begin(); each != asking_.end();) {
    Node& node = **each;
    if (node.pause_ms != 0 && clock_ms - node.asked_ms < node.pause_ms) {
      ++each;
      continue;
    }
    constexpr std::int64_t long_ago = 10;
    const bool again = node.pause_ms != 0 && clock_ms - node.asked_ms < long_ago * node.pause_ms;
    node.pause_ms = again ? std::min(2 * node.pause_ms, longest_pause_ms) : shortest_pause_ms;
    node.asked_ms = clock_ms;
    topics.push_back(node.ask_topic);
    each = asking_.erase(each);
  }
  return topics;
}

}  // namespace wearwell::monitor
