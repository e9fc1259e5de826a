#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace wearwell::monitor {

/// "spBv1.0/GROUP/TYPE/EDGE/DEVICE"; views into the text.
struct SparkplugTopic {
  std::string_view group, type, edge, device;  ///< `device` is "" of an edge node's own messages
};
/// Nothing where it is no such topic.
std::optional<SparkplugTopic> sparkplug_topic(std::string_view text);

/// Whether a field is made of the topic: "{edge}/{device}" and the like. Throws InputError for other braces.
bool names_by_topic(std::string_view field);
/// Such a field of a message of that topic.
std::string name_of_topic(std::string_view field, const SparkplugTopic& topic);

}  // namespace wearwell::monitor
