#include "wearwell/input/json_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"

namespace wearwell {
namespace {

using Json = nlohmann::ordered_json;

// Files of wearwell need less than a dozen levels; later code recurses over the tree.
constexpr int deepest = 64;

// Line and column of the text, as in editors.
std::string place_of(const std::string& text, std::size_t byte) {
  std::size_t line = 1, column = 1;
  for (std::size_t i = 0; i + 1 < std::min(byte, text.size()); ++i) {
    ++column;
    if (text[i] == '\n') {
      ++line;
      column = 1;
    }
  }
  return fmt::format("line {}, column {}", line, column);
}

std::string described(const Json& json) {
  if (json.is_null()) return "null";
  if (json.is_boolean()) return json.get<bool>() ? "true" : "false";
  if (json.is_number()) return json.dump();
  if (json.is_string()) {
    return fmt::format("the text '{}'",
                       printable(shortened(json.get_ref<const std::string&>(), 40)));
  }
  return json.is_array() ? fmt::format("a list of {}", json.size()) : "an object";
}

}  // namespace

nlohmann::ordered_json read_json(const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) {
    throw InputError(fmt::format("{} is a folder, not a file", file.string()));
  }
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    const bool is_there = std::filesystem::exists(file, ignored);
    throw InputError((is_there ? "cannot read " : "no such file: ") + file.string());
  }
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  const auto bounded = [&](int depth, Json::parse_event_t event, const Json&) {
    const bool opens =
        event == Json::parse_event_t::array_start || event == Json::parse_event_t::object_start;
    if (opens && depth >= deepest) {
      throw InputError(fmt::format("{} is nested more than {} deep", file.string(), deepest));
    }
    return true;
  };
  try {
    return Json::parse(text, bounded);
  } catch (const Json::parse_error& error) {
    throw InputError(fmt::format("{} is not valid JSON: error at {}", file.string(),
                                 place_of(text, error.byte)));
  } catch (const Json::out_of_range&) {
    throw InputError(
        fmt::format("{} cannot be read as JSON: a number is too large", file.string()));
  }
}

JsonReader::JsonReader(const Json& json, const std::filesystem::path& file)
    : json_(&json), file_(file.string()) {}

void JsonReader::fail(std::string_view what) const {
  throw InputError(fmt::format("{} is not what wearwell writes: {} {}", file_,
                               key_.empty() ? "it" : printable(shortened(key_, 120)), what));
}

void JsonReader::expected(std::string_view what) const {
  fail(fmt::format("should be {}, and is {}", what, described(*json_)));
}

void JsonReader::require_object() const {
  if (!json_->is_object()) expected("an object");
}

JsonReader JsonReader::at(const std::string& key) const {
  require_object();
  const auto found = json_->find(key);
  const std::string path = key_.empty() ? key : key_ + "." + key;
  if (found == json_->end()) JsonReader{*json_, file_, path}.fail("is missing");
  return {*found, file_, path};
}

std::optional<JsonReader> JsonReader::find(const std::string& key) const {
  require_object();
  if (!json_->contains(key)) return {};
  return at(key);
}

const Json& JsonReader::list() const {
  if (!json_->is_array()) expected("a list");
  return *json_;
}

std::vector<JsonReader> JsonReader::items() const {
  std::vector<JsonReader> all;
  for (const Json& each : list()) {
    all.push_back({each, file_, fmt::format("{}[{}]", key_, all.size())});
  }
  return all;
}

std::vector<std::pair<std::string, JsonReader>> JsonReader::members() const {
  require_object();
  std::vector<std::pair<std::string, JsonReader>> all;
  for (const auto& [name, each] : json_->items()) {
    all.emplace_back(name, JsonReader{each, file_, key_.empty() ? name : key_ + "." + name});
  }
  return all;
}

double JsonReader::any_number() const {
  if (!json_->is_number()) expected("a number");
  return json_->get<double>();
}

double JsonReader::number() const {
  const double value = any_number();
  if (!std::isfinite(value)) expected("a finite number");
  return value;
}

double JsonReader::number(double least) const {
  const double value = number();
  if (!(value >= least)) expected(fmt::format("a number, {:g} or more", least));
  return value;
}

double JsonReader::positive() const {
  const double value = number();
  if (!(value > 0)) expected("a positive number");
  return value;
}

double JsonReader::number_or(double null) const {
  return json_->is_null() ? null : any_number();
}

std::vector<double> JsonReader::numbers_or(double null) const {
  std::vector<double> values;
  values.reserve(list().size());
  for (const Json& each : *json_) {
    if (!each.is_number() && !each.is_null()) {
      items()[values.size()].expected("a number or null");
    }
    values.push_back(each.is_null() ? null : each.get<double>());
  }
  return values;
}

std::vector<double> JsonReader::numbers() const {
  std::vector<double> values;
  for (const Json& each : list()) {
    if (!each.is_number() || !std::isfinite(each.get<double>())) {
      items()[values.size()].expected("a finite number");
    }
    values.push_back(each.get<double>());
  }
  return values;
}

long long JsonReader::integer(long long least, long long most) const {
  const bool fits = json_->is_number_integer() &&
                    !(json_->is_number_unsigned() &&
                      json_->get<std::uint64_t>() > static_cast<std::uint64_t>(most));
  if (!fits || json_->get<long long>() < least || json_->get<long long>() > most) {
    expected(most == std::numeric_limits<long long>::max()
                 ? fmt::format("a whole number, {} or more", least)
                 : fmt::format("a whole number from {} to {}", least, most));
  }
  return json_->get<long long>();
}

std::uint64_t JsonReader::natural() const {
  if (!json_->is_number_unsigned()) expected("a whole number, 0 or more");
  return json_->get<std::uint64_t>();
}

bool JsonReader::flag() const {
  if (!json_->is_boolean()) expected("true or false");
  return json_->get<bool>();
}

std::string JsonReader::text() const {
  if (!json_->is_string()) expected("a text");
  return json_->get<std::string>();
}

std::string JsonReader::one_of(std::initializer_list<const char*> allowed) const {
  const std::string value = text();
  for (const char* each : allowed) {
    if (value == each) return value;
  }
  expected(fmt::format("one of \"{}\"", fmt::join(allowed, "\", \"")));
}

}  // namespace wearwell
