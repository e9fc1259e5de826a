#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace wearwell {

/// Checks values by the part of JSON Schema that our descriptions use: type, enum, properties, required,
/// additionalProperties, items, anyOf and $ref into the same document. A keyword that it does not know fails.
class JsonSchema {
 public:
  explicit JsonSchema(const nlohmann::json& document) : document_(document) {}

  /// Why a value is not as described; empty if it is.
  std::vector<std::string> problems(const nlohmann::json& schema,
                                    const nlohmann::json& value) const {
    std::vector<std::string> found;
    check(schema, value, "", found);
    return found;
  }

 private:
  using Json = nlohmann::json;

  static bool is_type(const std::string& type, const Json& value) {
    return type == "null"      ? value.is_null()
           : type == "boolean" ? value.is_boolean()
           : type == "string"  ? value.is_string()
           : type == "integer" ? value.is_number_integer()
           : type == "number"  ? value.is_number()
           : type == "array"   ? value.is_array()
                               : type == "object" && value.is_object();
  }

  void check(const Json& schema, const Json& value, const std::string& place,
             std::vector<std::string>& found) const {
    for (const auto& [key, rule] : schema.items()) {
      if (key == "$ref") {
        check(document_.at(Json::json_pointer(rule.get<std::string>().substr(1))), value, place,
              found);
      } else if (key == "type") {
        const Json types = rule.is_array() ? rule : Json::array({rule});
        if (std::none_of(types.begin(), types.end(),
                         [&](const Json& type) { return is_type(type, value); }))
          found.push_back(
              fmt::format("{}: {} is not of type {}", place, value.dump(), rule.dump()));
      } else if (key == "enum") {
        if (std::find(rule.begin(), rule.end(), value) == rule.end())
          found.push_back(fmt::format("{}: {} is none of {}", place, value.dump(), rule.dump()));
      } else if (key == "anyOf") {
        if (std::none_of(rule.begin(), rule.end(),
                         [&](const Json& each) { return problems(each, value).empty(); }))
          found.push_back(fmt::format("{}: {} fits none of the alternatives", place, value.dump()));
      } else if (key == "required") {
        for (const Json& name : rule) {
          if (value.is_object() && !value.contains(name))
            found.push_back(fmt::format("{}: {} is missing", place, name.dump()));
        }
      } else if (key == "items") {
        for (std::size_t i = 0; value.is_array() && i < value.size(); ++i)
          check(rule, value[i], fmt::format("{}[{}]", place, i), found);
      } else if (key == "properties" || key == "additionalProperties") {
        check_properties(schema, key, rule, value, place, found);
      } else if (key != "description") {
        found.push_back(fmt::format("{}: the schema has the unknown keyword {}", place, key));
      }
    }
  }
  void check_properties(const Json& schema, const std::string& key, const Json& rule,
                        const Json& value, const std::string& place,
                        std::vector<std::string>& found) const {
    if (!value.is_object()) return;
    const Json known = schema.value("properties", Json::object());
    for (const auto& [name, each] : value.items()) {
      const std::string at = place + "/" + name;
      if (key == "properties") {
        if (known.contains(name)) check(known[name], each, at, found);
      } else if (!known.contains(name)) {
        if (rule == false) {
          found.push_back(at + " is not described");
        } else if (rule.is_object()) {
          check(rule, each, at, found);
        }
      }
    }
  }

  const Json& document_;
};

}  // namespace wearwell
