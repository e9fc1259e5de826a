#include "wearwell/workbench/study_form.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/input/study_keys.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/study/scaffold.h"
#include "wearwell/workbench/formulas_view.h"

namespace wearwell::workbench {
namespace {

using nlohmann::ordered_json;

// The byte at a line and a column, both from 1; columns count characters.
std::size_t offset_at(std::string_view text, std::size_t line, std::size_t column) {
  std::size_t at = 0;
  for (; line > 1; --line) {
    at = text.find('\n', at);
    if (at == text.npos) return text.size();
    ++at;
  }
  while (column > 1 && at < text.size()) {
    ++at;
    if (at >= text.size() || (static_cast<unsigned char>(text[at]) & 0xc0) != 0x80) --column;
  }
  return at;
}

// The end of the TOML string that begins at `at`.
std::size_t end_of_string(std::string_view text, std::size_t at) {
  const char mark = text[at];
  const std::string three(3, mark);
  if (text.substr(at, 3) == three) {
    const std::size_t end = text.find(three, at + 3);
    return end == text.npos ? text.size()
                            : std::min(text.find_first_not_of(mark, end), text.size());
  }
  for (++at; at < text.size() && text[at] != mark && text[at] != '\n'; ++at) {
    if (mark == '"' && text[at] == '\\') ++at;
  }
  return std::min(at + 1, text.size());
}

// The end of the TOML value that begins at `at`.
std::size_t end_of_value(std::string_view text, std::size_t at) {
  int depth = 0;
  while (at < text.size()) {
    const char each = text[at];
    if (each == '"' || each == '\'') {
      at = end_of_string(text, at);
      if (depth == 0) return at;
      continue;
    }
    if (depth > 0 && each == '#') {
      at = std::min(text.find('\n', at), text.size());
      continue;
    }
    if (each == '[' || each == '{') ++depth;
    if (each == ']' || each == '}') {
      --depth;
      if (depth == 0) return at + 1;
      if (depth < 0) break;  // of the inline table that holds it
    }
    if (depth == 0 && (each == ',' || each == '#' || each == '\n' || each == '\r')) break;
    ++at;
  }
  while (at > 0 && (text[at - 1] == ' ' || text[at - 1] == '\t')) --at;
  return at;
}

struct Place {
  std::size_t begin = 0, end = 0;
};

Place place_of(std::string_view text, const TomlReader::Present& key) {
  const std::size_t begin = offset_at(text, key.line, key.column);
  return {begin, begin < text.size() ? end_of_value(text, begin) : begin};
}

bool is_quoted(std::string_view text, const Place& place) {
  return place.begin < text.size() && (text[place.begin] == '"' || text[place.begin] == '\'');
}

// A text without its quotes, anything else as it is written.
std::string shown_value(const std::string& text, const TomlReader::Present& key) {
  const Place place = place_of(text, key);
  return is_quoted(text, place) ? key.text : text.substr(place.begin, place.end - place.begin);
}

// A text in quotes; over several lines if it has them and the marks that stand there allow it.
std::string quoted_value(const std::string& mark, const std::string& value) {
  const bool is_long = mark == "'''" || mark == "\"\"\"";
  if (!is_long || value.find('\n') == value.npos) return toml_text(value);
  if (mark == "'''" && value.find("'''") == value.npos && value.back() != '\'')
    return "'''\n" + value + "'''";
  std::string out = "\"\"\"\n";
  for (const char each : value) {
    if (each == '"' || each == '\\') out += '\\';
    out += each;
  }
  return out + "\"\"\"";
}

std::string text_at(const TomlReader& root, const std::string& path) {
  for (const TomlReader::Present& each : root.present())
    if (each.path == path) return each.text;
  return "";
}

std::vector<std::string> paths_of(const TomlReader& root) {
  std::vector<std::string> paths;
  for (const TomlReader::Present& each : root.present()) paths.push_back(each.path);
  return paths;
}

StudyKeys keys_of(const TomlReader& root, Models models) {
  if (!root.has("model") || !root.is_text("model")) return {};
  const std::string name = *root.text("model");
  for (const Model& model : models)
    if (model.key == name && model.keys) return model.keys();
  return {};
}

ordered_json form_json(const TomlReader& root, const std::string& text, Models models) {
  const StudyKeys known = keys_of(root, models);
  ordered_json keys = ordered_json::array();
  for (const TomlReader::Present& each : root.present()) {
    if (each.is_table) continue;
    ordered_json key = {{"path", printable(each.path)},
                        {"value", shown_value(text, each)},
                        {"text", is_quoted(text, place_of(text, each))},
                        {"line", each.line}};
    const auto found = std::find_if(known.begin(), known.end(), [&](const StudyKey& one) {
      return matches_key(one.path, each.path);
    });
    if (found != known.end()) {
      key["meaning"] = found->meaning;
      key["example"] = found->example;
    }
    keys.push_back(std::move(key));
  }
  return keys;
}

// "study.toml:12:7: prior.k: ..." -> 12, 7.
void add_position(const std::string& message, const std::string& file, ordered_json& json) {
  const std::size_t at = message.find(file + ":");
  if (at == message.npos) return;
  const char *next = message.data() + at + file.size() + 1, *end = message.data() + message.size();
  for (const char* key : {"line", "column"}) {
    std::size_t number = 0;
    const auto [last, error] = std::from_chars(next, end, number);
    if (error != std::errc{} || last == end || *last != ':') return;
    json[key] = number;
    next = last + 1;
  }
}

void add_problem(std::string message, const std::filesystem::path& file, ordered_json& json) {
  // Names of this folder need no path.
  const std::string folder = file.parent_path().string() + "/";
  for (std::size_t at = 0; (at = message.find(folder, at)) != message.npos;)
    message.erase(at, folder.size());
  json["problem"] = printable_lines(message);
  add_position(message, file.filename().string(), json);
}

}  // namespace

ordered_json study_form(const std::filesystem::path& file, const std::string& text, Models models) {
  ordered_json json = {{"keys", ordered_json::array()}};
  try {
    json["keys"] = form_json(TomlReader::parse(TextFile{file, text}), text, models);
    json["formulas"] = formulas_json(json["keys"]);
  } catch (const InputError& error) {
    add_problem(error.what(), file, json);
  }
  return json;
}

ordered_json checked_study(const std::filesystem::path& file, const std::string& text,
                           Models models) {
  ordered_json json = study_form(file, text, models);
  if (json.contains("problem")) return json;
  try {
    json["description"] =
        printable_lines(read_study({TextFile{file, text}}, models)->description());
  } catch (const InputError& error) {
    add_problem(error.what(), file, json);
  }
  return json;
}

std::string value_of(const std::string& text, const std::string& path) {
  for (const TomlReader::Present& each : TomlReader::parse({"the study", text}).present())
    if (!each.is_table && printable(each.path) == path) return shown_value(text, each);
  throw InputError(fmt::format("the study has no key {}", printable(shortened(path))));
}

std::string with_value(const std::string& text, const std::string& path, const std::string& value) {
  const TomlReader root = TomlReader::parse({"the study", text});
  for (const TomlReader::Present& each : root.present()) {
    if (each.is_table || printable(each.path) != path) continue;
    const Place place = place_of(text, each);
    const bool quoted = is_quoted(text, place);
    std::string changed = text;
    changed.replace(place.begin, place.end - place.begin,
                    quoted ? quoted_value(text.substr(place.begin, 3), value) : value);
    const TomlReader after = TomlReader::parse({"the study", changed});
    if (paths_of(after) != paths_of(root) || (quoted && text_at(after, each.path) != value))
      throw InputError(
          fmt::format("{}: \"{}\" is not one value", path, printable(shortened(value))));
    return changed;
  }
  throw InputError(fmt::format("the study has no key {}", printable(shortened(path))));
}

}  // namespace wearwell::workbench
