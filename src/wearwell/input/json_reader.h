#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace wearwell {

/// Throws InputError with file, line and column of invalid or too deeply nested JSON.
nlohmann::ordered_json read_json(const std::filesystem::path& file);

/// A value in an untrusted JSON file. Every access is checked; InputError names the file, the key
/// ("parameters.k.mean", "stages[3].rows") and the allowed values. Refers to the JSON it was made
/// from.
class JsonReader {
 public:
  using Json = nlohmann::ordered_json;

  JsonReader(const Json& json, const std::filesystem::path& file);

  /// The member of an object.
  JsonReader at(const std::string& key) const;
  std::optional<JsonReader> find(const std::string& key) const;  ///< when it is there
  std::vector<JsonReader> items() const;                         ///< of a list
  std::vector<std::pair<std::string, JsonReader>> members() const;

  double number() const;                ///< finite
  double number(double least) const;    ///< finite, at least `least`
  double positive() const;              ///< finite
  double number_or(double null) const;  ///< JSON writes values that are not finite as null
  std::vector<double> numbers_or(double null) const;
  std::vector<double> numbers() const;  ///< each finite
  long long integer(long long least, long long most = std::numeric_limits<long long>::max()) const;
  std::uint64_t natural() const;
  bool flag() const;
  std::string text() const;
  std::string one_of(std::initializer_list<const char*> allowed) const;
  bool is_null() const { return json_->is_null(); }

  const Json& json() const { return *json_; }
  const std::string& key() const { return key_; }  ///< from the root of the file
  /// "FILE is not what wearwell writes: KEY WHAT".
  [[noreturn]] void fail(std::string_view what) const;

 private:
  JsonReader(const Json& json, std::string file, std::string key)
      : json_(&json), file_(std::move(file)), key_(std::move(key)) {}
  [[noreturn]] void expected(std::string_view what) const;
  const Json& list() const;
  void require_object() const;
  double any_number() const;

  const Json* json_;
  std::string file_, key_;
};

}  // namespace wearwell
