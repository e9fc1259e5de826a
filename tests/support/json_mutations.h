#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

namespace wearwell {

/// Calls `use` with what was changed and the JSON: every value in turn is missing, or something else
/// than it was. The first two of a list stand for all.
inline void mutations(
    const nlohmann::ordered_json& whole,
    const std::function<void(const std::string&, const nlohmann::ordered_json&)>& use) {
  using Json = nlohmann::ordered_json;
  const std::function<void(const Json&, const std::string&, std::set<std::string>&)> walk =
      [&](const Json& json, const std::string& at, std::set<std::string>& places) {
        if (!at.empty()) places.insert(at);
        if (json.is_object()) {
          for (const auto& [key, each] : json.items()) walk(each, at + "/" + key, places);
        } else if (json.is_array()) {
          for (std::size_t i = 0; i < std::min<std::size_t>(2, json.size()); ++i) {
            walk(json[i], at + "/" + std::to_string(i), places);
          }
        }
      };
  std::set<std::string> places;
  walk(whole, "", places);
  const Json replacements[] = {nullptr, -1,           1e308,         18446744073709551615u,
                               true,    "<b>\x1b[2J", Json::array(), Json::object()};
  Json json = whole;  // changed in place and restored: a copy for each change is slow
  for (const std::string& place : places) {
    const Json::json_pointer pointer(place);
    Json& value = json[pointer];
    const Json original = value;
    for (const Json& other : replacements) {
      value = other;
      use(place + " = " + other.dump(), json);
    }
    value = original;
    Json& parent = json[pointer.parent_pointer()];
    const Json whole_parent = parent;
    if (parent.is_array()) {
      parent.erase(std::stoul(pointer.back()));
    } else {
      parent.erase(pointer.back());
    }
    use(place + " erased", json);
    parent = whole_parent;
  }
}

}  // namespace wearwell
