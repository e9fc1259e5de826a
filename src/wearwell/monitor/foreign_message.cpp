#include "wearwell/monitor/foreign_message.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/monitor/time_text.h"

// Longer than others: two protocols, which share how a text is divided into messages.
namespace wearwell::monitor {
namespace {

using Json = nlohmann::ordered_json;

std::string quoted_part(std::string_view text) {
  return fmt::format("'{}'", printable(shortened(text)));
}

std::string_view without_blanks(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n";
  const std::size_t from = text.find_first_not_of(blanks);
  if (from == text.npos) return {};
  return text.substr(from, text.find_last_not_of(blanks) - from + 1);
}

/// One line of the line protocol, from its beginning to its end.
class InfluxLine {
 public:
  InfluxLine(std::string_view line, std::int64_t per_second)
      : rest_(line), per_second_(per_second) {}

  Fields read() {
    put("{measurement}", name(", "));
    while (take(',')) {
      const std::string key = name("=, ");
      if (!take('=')) fail(fmt::format("tag {} has no value", quoted_part(key)));
      put(key, name(", "));
    }
    if (!take(' ')) fail("has no fields");
    skip_blanks();
    do {
      const std::string key = name("=, ");
      if (!take('=')) fail(fmt::format("field {} has no value", quoted_part(key)));
      put_value(key);
    } while (take(','));
    skip_blanks();
    if (!rest_.empty()) put_time();
    return std::move(fields_);
  }

 private:
  [[noreturn]] static void fail(const std::string& problem) { throw InputError(problem); }

  bool take(char c) {
    if (!rest_.starts_with(c)) return false;
    rest_.remove_prefix(1);
    return true;
  }
  void skip_blanks() {
    while (take(' ')) {
    }
  }
  /// Up to one of these characters; a backslash escapes them.
  std::string name(std::string_view ends) {
    std::string text;
    while (!rest_.empty() && ends.find(rest_.front()) == ends.npos) {
      const bool escapes = rest_.front() == '\\' && rest_.size() > 1 &&
                           std::string_view(",= \\").find(rest_[1]) != std::string_view::npos;
      if (escapes) rest_.remove_prefix(1);
      text += rest_.front();
      rest_.remove_prefix(1);
    }
    if (text.empty()) fail("has an empty name or value");
    return text;
  }
  Field& add(const std::string& key, Field::Kind kind) {
    if (find_field(fields_, key)) fail(fmt::format("has {} twice", quoted_part(key)));
    if (fields_.size() == most_fields) fail(fmt::format("has more than {} fields", most_fields));
    fields_.push_back({key, kind});
    return fields_.back();
  }
  void put(const std::string& key, std::string value) {
    add(key, Field::Kind::text).text = std::move(value);
  }
  void put_value(const std::string& key) {
    if (rest_.starts_with('"')) return put(key, string_value());
    const std::string_view word = rest_.substr(0, rest_.find_first_of(", "));
    rest_.remove_prefix(word.size());
    for (const char* flag :
         {"t", "T", "true", "True", "TRUE", "f", "F", "false", "False", "FALSE"}) {
      if (word == flag) {
        add(key, Field::Kind::flag);
        return;
      }
    }
    const bool whole = word.ends_with('i') || word.ends_with('u');
    const std::string_view digits = whole ? word.substr(0, word.size() - 1) : word;
    const char *begin = digits.data(), *end = begin + digits.size();
    Field& field = add(key, Field::Kind::number);
    const auto [last, error] = std::from_chars(begin, end, field.number);
    if (error != std::errc() || last != end || !std::isfinite(field.number))
      fail(fmt::format("{} is {}, but must be a number, true, false, or a text in quotes",
                       quoted_part(key), quoted_part(word)));
    constexpr double exact = 9007199254740992.0;  // 2^53
    if (whole) {
      const auto [rest, fault] = std::from_chars(begin, end, field.integer);
      if (fault != std::errc() || rest != end)
        fail(fmt::format("{} is {}, but must be a whole number", quoted_part(key),
                         quoted_part(word)));
      field.whole = true;
    } else if (field.number == std::floor(field.number) && std::abs(field.number) <= exact) {
      field.whole = true;
      field.integer = static_cast<std::int64_t>(field.number);
    }
  }
  std::string string_value() {
    std::string text;
    rest_.remove_prefix(1);
    while (!take('"')) {
      if (rest_.empty()) fail("has an unclosed quote");
      if (rest_.front() == '\\' && rest_.size() > 1 && (rest_[1] == '"' || rest_[1] == '\\'))
        rest_.remove_prefix(1);
      text += rest_.front();
      rest_.remove_prefix(1);
    }
    return text;
  }
  void put_time() {
    std::int64_t time = 0;
    const char* end = rest_.data() + rest_.size();
    const auto [last, error] = std::from_chars(rest_.data(), end, time);
    if (error != std::errc() || last != end)
      fail(fmt::format("has the time {}, which is not a whole number", quoted_part(rest_)));
    // Another unit would be another century: the four are factors of a thousand apart.
    const double seconds = static_cast<double>(time) / static_cast<double>(per_second_);
    constexpr double year_1990 = 631'152'000;
    if (!(seconds >= year_1990 && 1000 * seconds <= static_cast<double>(latest_unix_ms)))
      fail(fmt::format(
          "has the time {}, which does not lie between 1990 and 2200 in the source's precision",
          time));
    Field& field = add("{timestamp}", Field::Kind::number);
    field.integer = per_second_ >= 1000 ? time / (per_second_ / 1000) : time * 1000;
    field.number = static_cast<double>(field.integer);
    field.whole = true;
  }

  std::string_view rest_;
  std::int64_t per_second_;
  Fields fields_;
};

/// By the two highest bits of its 32; a signed number stands for the same bits. A status of another
/// kind says nothing good of its value. Null, or an object without a code: good.
bool is_bad(const Json& status) {
  const bool has_code = status.is_object() && status.contains("Code");
  const Json& code = has_code ? status["Code"] : status;
  if (code.is_null()) return false;
  if (code.is_object()) {  // good ones may leave out their code, which is 0
    const std::string symbol = code.value("Symbol", Json("Good")).dump();
    return !symbol.starts_with("\"Good");
  }
  if (!code.is_number_integer()) return true;
  return (code.get<std::uint64_t>() >> 30 & 3) >= 2;
}

std::string bad_status(const Json& status) {
  return fmt::format(
      "the bad status {}",
      printable(shortened(status.dump(-1, ' ', false, Json::error_handler_t::replace))));
}

/// A plain value of a DataValue or a Variant; null, and the reason in `lost`, if its status is bad.
Json plain_value(Json value, std::string& lost) {
  constexpr int deepest = 4;
  for (int i = 0; i < deepest && value.is_object(); ++i) {
    for (const char* key : {"Status", "StatusCode"}) {
      if (!value.contains(key) || !is_bad(value[key])) continue;
      lost = "it has " + bad_status(value[key]);
      return nullptr;
    }
    const char* inner = value.contains("Body")    ? "Body"
                        : value.contains("Value") ? "Value"
                                                  : nullptr;
    if (!inner) break;
    value = Json(value[inner]);
  }
  return value;
}

std::string kind_of_message(const Json& message) {
  const auto kind = message.find("MessageType");
  return kind != message.end() && kind->is_string() ? kind->get<std::string>() : std::string();
}

void read_data_set(const Json& message, const Json& publisher,
                   const std::function<void(const Fields&)>& row) {
  if (!message.is_object()) throw InputError("has a data set message that is not an object");
  const std::string kind = kind_of_message(message);
  if (kind == "ua-keepalive" || kind == "ua-metadata") return;
  if (kind == "ua-deltaframe")
    throw InputError(
        "is a delta frame, which has only what has changed; let the publisher send key frames "
        "(KeyFrameCount = 1)");
  const auto payload = message.find("Payload");
  if (payload == message.end() || !payload->is_object())
    throw InputError("has no Payload with fields");
  if (message.contains("Status") && is_bad(message["Status"]))
    throw InputError("has " + bad_status(message["Status"]));
  Json flat = Json::object();
  std::map<std::string, std::string> lost;
  for (const auto& [key, value] : payload->items()) {
    std::string why;
    flat[key] = plain_value(value, why);
    if (!why.empty()) lost[key] = why;
  }
  const auto header = [&](const char* field, const Json& value) {
    if (!value.is_null()) flat[field] = value;
  };
  header("{publisher}", publisher);
  const char* writer =
      message.contains("DataSetWriterName") ? "DataSetWriterName" : "DataSetWriterId";
  header("{writer}", message.value(writer, Json()));
  header("{sequence}", message.value("SequenceNumber", Json()));
  if (const Json time = message.value("Timestamp", Json()); !time.is_null()) {
    const auto ms = time.is_string() ? unix_ms_of_iso(time.get<std::string>()) : std::nullopt;
    if (!ms)
      throw InputError(
          fmt::format("has the Timestamp {}, but it must be a time with its zone like "
                      "2026-11-22T15:04:05Z",
                      quoted_part(time.dump())));
    flat["{timestamp}"] = *ms;
  }
  const std::string text = flat.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (text.size() > longest_row)
    throw InputError(fmt::format("has {} bytes; the limit is {}", text.size(), longest_row));
  Fields fields = fields_of_json(text);
  for (Field& each : fields) {
    const auto why = lost.find(each.name);
    if (why != lost.end() && each.kind == Field::Kind::null) each.text = why->second;
  }
  row(fields);
}

void read_network_message(const Json& message, const std::function<void(const Fields&)>& row,
                          const std::function<void(const std::string&)>& bad) {
  const auto guarded = [&](const Json& each, const Json& publisher) {
    try {
      read_data_set(each, publisher, row);
    } catch (const InputError& error) {
      bad(error.what());
    }
  };
  if (!message.is_object()) return bad("is not a message of OPC UA PubSub");
  const std::string kind = kind_of_message(message);
  if (!kind.empty() && kind != "ua-data" && !message.contains("Payload") &&
      !message.contains("Messages"))
    return;  // metadata, status and discovery are not readings
  const Json publisher = message.value("PublisherId", Json());
  const auto messages = message.find("Messages");
  if (messages == message.end()) {
    if (!message.contains("Payload"))
      return bad("is not a message of OPC UA PubSub: it has neither Messages nor Payload");
    return guarded(message, publisher);
  }
  if (!messages->is_array()) return guarded(*messages, publisher);
  for (const Json& each : *messages) guarded(each, publisher);
}

/// Throws InputError for too deep a nesting and for repeated names.
Json parsed(std::string_view text) {
  std::vector<std::set<std::string>> names;
  const auto check = [&](int depth, Json::parse_event_t event, Json& value) {
    const auto level = static_cast<std::size_t>(depth);
    if (level > deepest_message)
      throw InputError(fmt::format("is nested more than {} deep", deepest_message));
    names.resize(std::max(names.size(), level + 2));
    if (event == Json::parse_event_t::object_start) names[level + 1].clear();
    if (event == Json::parse_event_t::key && !names[level].insert(value.get<std::string>()).second)
      throw InputError(fmt::format("has {} twice", quoted_part(value.get<std::string>())));
    return true;
  };
  return Json::parse(text, check);
}

void read_opc_ua_text(std::string_view text, const std::function<void(const Fields&)>& row,
                      const std::function<void(const std::string&)>& bad) {
  Json json;
  try {
    json = parsed(text);
  } catch (const Json::exception&) {
    return bad("is not JSON");
  } catch (const InputError& error) {
    return bad(error.what());
  }
  if (!json.is_array()) return read_network_message(json, row, bad);
  for (const Json& each : json) read_network_message(each, row, bad);
}

void for_lines(std::string_view text, const std::function<void(std::string_view)>& visit) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = without_blanks(text.substr(0, end));
    if (!line.empty()) visit(line);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

/// Whether a text that is not JSON has lines that are: a malformed text over several lines has none.
bool are_messages(std::string_view text) {
  if (text.find('\n') == text.npos || Json::accept(text)) return false;
  bool some = false;
  for_lines(text, [&](std::string_view line) {
    some = some || ((line.front() == '{' || line.front() == '[') && Json::accept(line));
  });
  return some;
}

/// Whether it can be read at all.
bool has_size(std::string_view payload, const std::function<void(const std::string&)>& bad) {
  if (payload.size() > longest_message) {
    bad(fmt::format("has {} bytes; the limit is {}", payload.size(), longest_message));
    return false;
  }
  if (!without_blanks(payload).empty()) return true;
  bad("is empty");
  return false;
}

}  // namespace

bool is_place_of(Form form, std::string_view field) {
  if (field == "{timestamp}") return form == Form::influx || form == Form::opc_ua;
  if (form == Form::influx) return field == "{measurement}";
  return form == Form::opc_ua &&
         (field == "{publisher}" || field == "{writer}" || field == "{sequence}");
}

void read_influx(std::string_view payload, std::int64_t per_second,
                 const std::function<void(const Fields&)>& row,
                 const std::function<void(const std::string& problem)>& bad) {
  if (!has_size(payload, bad)) return;
  for_lines(payload, [&](std::string_view line) {
    if (line.starts_with('#')) return;
    try {
      if (line.size() > longest_row)
        throw InputError(fmt::format("has a line of {} bytes", line.size()));
      row(InfluxLine(line, per_second).read());
    } catch (const InputError& error) {
      bad(error.what());
    }
  });
}

void read_opc_ua(std::string_view payload, const std::function<void(const Fields&)>& row,
                 const std::function<void(const std::string& problem)>& bad, Form stream) {
  if (!has_size(payload, bad)) return;
  const std::string_view text = without_blanks(payload);
  if (stream != Form::json_lines && !are_messages(text)) return read_opc_ua_text(text, row, bad);
  for_lines(text, [&](std::string_view line) { read_opc_ua_text(line, row, bad); });
}

}  // namespace wearwell::monitor
