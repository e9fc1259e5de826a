#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace wearwell::monitor {

/// "spBv1.0/GROUP/TYPE/EDGE/DEVICE"; views into the text.
struct SparkplugTopic {
  std::string_view group, type, edge, device;  ///< `device` is "" for an edge node's own messages
};
/// Empty if it is not such a topic.
std::optional<SparkplugTopic> sparkplug_topic(std::string_view text);

/// Whether a field contains parts of the topic: "{edge}/{device}" and the like. Throws InputError
/// for other braces.
bool names_by_topic(std::string_view field);
/// Such a field for a message of that topic.
std::string name_of_topic(std::string_view field, const SparkplugTopic& topic);

}  // namespace wearwell::monitor
