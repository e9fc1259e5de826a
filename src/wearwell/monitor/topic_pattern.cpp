#include "wearwell/monitor/topic_pattern.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"

namespace wearwell::monitor {
namespace {

constexpr std::string_view unit_level = "{unit}";

std::vector<std::string> levels_of(std::string_view topic) {
  std::vector<std::string> levels;
  for (;;) {
    const std::size_t end = topic.find('/');
    levels.emplace_back(topic.substr(0, end));
    if (end == topic.npos) return levels;
    topic.remove_prefix(end + 1);
  }
}

}  // namespace

TopicPattern::TopicPattern(std::string_view text) : text_(text), levels_(levels_of(text)) {
  const auto refuse = [&](const char* why) {
    throw InputError(fmt::format("'{}' {}", printable(shortened(text_)), why));
  };
  constexpr std::size_t longest = 1000;
  if (text.empty() || text.size() > longest) refuse("is not a topic");
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    const std::string& level = levels_[i];
    if (level == unit_level) {
      if (unit_) refuse("has {unit} twice");
      unit_ = i;
    } else if (level.find_first_of("{}") != level.npos) {
      refuse("may hold {unit} as a whole level, and no other braces");
    } else if (level.find_first_of("+#") != level.npos && level.size() > 1) {
      refuse("has a wildcard, + or #, that is not a whole level");
    } else if (level == "#" && i + 1 < levels_.size()) {
      refuse("has # before its end");
    }
  }
}

std::string TopicPattern::filter() const {
  std::vector<std::string> levels = levels_;
  if (unit_) levels[*unit_] = "+";
  return fmt::format("{}", fmt::join(levels, "/"));
}

std::optional<std::string> TopicPattern::unit(std::string_view topic) const {
  if (!unit_) return {};
  const std::vector<std::string> levels = levels_of(topic);
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    if (levels_[i] == "#") break;
    if (i >= levels.size()) return {};
    const bool any = i == *unit_ || levels_[i] == "+";
    if (!any && levels_[i] != levels[i]) return {};
  }
  if (levels.size() > levels_.size() && levels_.back() != "#") return {};
  return levels[*unit_];
}

std::string topic_level(std::string_view unit) {
  std::string level;
  for (const char c : unit) {
    const bool plain = static_cast<unsigned char>(c) >= 32 && c != 127 &&
                       std::string_view("/+#%").find(c) == std::string_view::npos;
    level += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return level;
}

}  // namespace wearwell::monitor
