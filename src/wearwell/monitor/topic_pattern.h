#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace wearwell::monitor {

/// Topics of MQTT of which one level may name the unit: "plant/{unit}/wear", "plant/+/{unit}/#".
class TopicPattern {
 public:
  TopicPattern() = default;
  /// Throws InputError without a place: an empty or too long pattern, a level that is part name and part wildcard, {unit} twice.
  explicit TopicPattern(std::string_view text);

  bool names_unit() const { return unit_.has_value(); }
  /// The subscription: "plant/+/wear".
  std::string filter() const;
  /// The unit in a topic; empty if it has none.
  std::optional<std::string> unit(std::string_view topic) const;
  const std::string& text() const { return text_; }

 private:
  std::string text_;
  std::vector<std::string> levels_;
  std::optional<std::size_t> unit_;
};

/// A unit's name as one level of a topic: "/", "+", "#", "%" and controls as "%2F".
std::string topic_level(std::string_view unit);

}  // namespace wearwell::monitor
