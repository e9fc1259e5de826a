#include "wearwell/monitor/sparkplug_topic.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"

namespace wearwell::monitor {

std::optional<SparkplugTopic> sparkplug_topic(std::string_view text) {
  std::vector<std::string_view> levels;
  for (;;) {
    const std::size_t end = text.find('/');
    levels.push_back(text.substr(0, end));
    if (end == text.npos) break;
    text.remove_prefix(end + 1);
  }
  if (levels.size() < 4 || levels.size() > 5 || levels[0] != "spBv1.0") return {};
  if (std::any_of(levels.begin(), levels.end(), [](auto each) { return each.empty(); })) return {};
  SparkplugTopic topic{levels[1], levels[2], levels[3], ""};
  if (levels.size() == 5) topic.device = levels[4];
  return topic;
}

bool names_by_topic(std::string_view field) {
  if (field.find_first_of("{}") == field.npos) return false;
  const std::string rest = name_of_topic(field, {"", "", "", ""});
  if (rest.find_first_of("{}") != rest.npos)
    throw InputError(fmt::format("'{}' has braces other than {{group}}, {{edge}}, {{device}}",
                                 printable(shortened(field))));
  return true;
}

std::string name_of_topic(std::string_view field, const SparkplugTopic& topic) {
  std::string name;
  constexpr std::string_view placeholders[] = {"{group}", "{edge}", "{device}"};
  while (!field.empty()) {
    std::size_t length = 1;
    std::string_view piece = field.substr(0, 1);
    const std::string_view parts[] = {topic.group, topic.edge, topic.device};
    for (std::size_t i = 0; i < 3; ++i) {
      if (!field.starts_with(placeholders[i])) continue;
      length = placeholders[i].size();
      piece = parts[i];
    }
    name += piece;
    field.remove_prefix(length);
  }
  return name;
}

}  // namespace wearwell::monitor
