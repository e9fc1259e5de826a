#include "wearwell/input/toml_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/base/printable.h"
#include "wearwell/input/guarded_toml.h"
#include "wearwell/input/toml_text.h"

// Longer than others: one class, a function for each kind of value.

namespace wearwell {
namespace {

/// The line at which an assertion of toml++ fails: the shortest prefix of the text that fails.
std::size_t line_of_failure(std::string_view text) {
  std::vector<std::size_t> ends;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text[at] == '\n' || at + 1 == text.size()) ends.push_back(at + 1);
  }
  const auto fails = [&](std::size_t end) {
    try {
      static_cast<void>(toml::parse(text.substr(0, end), std::string_view()));
    } catch (const toml::parse_error&) {
    } catch (const NoToml&) {
      return true;
    }
    return false;
  };
  const auto first =
      std::partition_point(ends.begin(), ends.end(), [&](std::size_t end) { return !fails(end); });
  return static_cast<std::size_t>(first - ends.begin()) + 1;
}

/// "and is a list".
std::string not_a(const toml::node& node) {
  const char* is = node.is_table()            ? "a table"
                   : node.is_array()          ? "a list"
                   : node.is_string()         ? "a text"
                   : node.is_boolean()        ? "true or false"
                   : node.is_integer()        ? "a whole number"
                   : node.is_floating_point() ? "a number"
                                              : "a date or a time";
  return fmt::format("and is {}", is);
}

}  // namespace

struct TomlReader::State {
  std::shared_ptr<const toml::table> root;  // owns `table`
  const toml::table* table = nullptr;
  std::string file;
  std::shared_ptr<const std::string> text;  // text of the file
  std::string name;                         // "prior.k"; empty for the whole file
  std::map<std::string, std::set<std::string>, std::less<>> asked;  // and the expected kind
  std::map<std::string, std::shared_ptr<State>, std::less<>> children;

  const toml::node* find(std::string_view key, std::string kind = {}) {
    std::set<std::string>& kinds = asked[std::string(key)];
    if (!kind.empty()) kinds.insert(std::move(kind));
    return table->get(key);
  }
  std::string path(std::string_view key) const {
    return name.empty() ? std::string(key) : fmt::format("{}.{}", name, key);
  }
};

TomlReader::TomlReader(std::shared_ptr<State> state) : state_(std::move(state)) {}
TomlReader::TomlReader(const TomlReader&) = default;
TomlReader::TomlReader(TomlReader&&) noexcept = default;
TomlReader::~TomlReader() = default;

TomlReader TomlReader::parse_file(const std::filesystem::path& file) {
  return parse(read_text_file(file));
}

TomlReader TomlReader::parse(const TextFile& file) {
  const std::string name = valid_utf8(file.path.string());
  refuse_long_keys(file.text, name);
  try {
    auto state = std::make_shared<State>();
    state->root = std::make_shared<const toml::table>(
        toml::parse(std::string_view(file.text), std::string_view(name)));
    state->table = state->root.get();
    state->file = name;
    state->text = std::make_shared<const std::string>(file.text);
    if (state->table->empty()) throw InputError(fmt::format("{} is empty", name));
    return TomlReader(state);
  } catch (const toml::parse_error& error) {
    const toml::source_position at = error.source().begin;
    std::string what = common_slip(file.text, at.line);
    if (what.empty()) what = in_our_words(error.description());
    throw InputError(fmt::format("{}:{}:{}: {}{}", name, at.line, at.column, what,
                                 study_excerpt(valid_utf8(file.text), at.line, at.column)));
  } catch (const NoToml&) {
    throw InputError(
        fmt::format("{}:{}: invalid TOML: a key or a value is missing after '[' or '='", name,
                    line_of_failure(file.text)));
  }
}

void TomlReader::fail(std::string_view key, const std::string& message,
                      const Repair& repair) const {
  const toml::node* node = state_->table->get(key);
  const toml::source_position at = (node ? node->source() : state_->table->source()).begin;
  const std::string where = state_->name.empty() ? std::string(key)
                            : key.empty()        ? fmt::format("[{}]", state_->name)
                                                 : fmt::format("{}.{}", state_->name, key);
  // A message about the text of a formula has its own excerpt.
  const bool has_excerpt = message.find('\n') != message.npos;
  // A missing key has no line.
  const bool shows = !has_excerpt && (node || !state_->name.empty());
  throw InputError(fmt::format("{}:{}:{}: {}: {}{}", state_->file, at.line, at.column, where,
                               message, shows ? excerpt(at.line, at.column, repair) : ""));
}

std::string TomlReader::excerpt(std::size_t line, std::size_t column, const Repair& repair) const {
  return study_excerpt(*state_->text, line, column, repair);
}

bool TomlReader::has(std::string_view key) const {
  return state_->find(key) != nullptr;
}

bool TomlReader::is_text(std::string_view key) const {
  const toml::node* node = state_->find(key);
  return node && node->is_string();
}

bool TomlReader::is_integer(std::string_view key) const {
  const toml::node* node = state_->find(key);
  return node && node->is_integer();
}

std::optional<std::string> TomlReader::text_as(std::string_view key, std::string kind) const {
  const toml::node* node = state_->find(key, std::move(kind));
  if (!node) return {};
  if (!node->is_string()) fail(key, fmt::format("must be a text in quotes, {}", not_a(*node)));
  return node->as_string()->get();
}

std::optional<std::string> TomlReader::text(std::string_view key) const {
  return text_as(key, "text");
}

std::string TomlReader::required_text(std::string_view key) const {
  const auto value = text(key);
  if (!value) fail(key, "is missing");
  return *value;
}

std::vector<std::string> TomlReader::texts(std::string_view key) const {
  const toml::node* node = state_->find(key, "text, or a list of them");
  if (!node) return {};
  if (!node->is_array()) return {*text_as(key, {})};
  std::vector<std::string> values;
  for (const toml::node& each : *node->as_array()) {
    if (!each.is_string()) fail(key, "must be a text in quotes, or a list of them");
    values.push_back(each.as_string()->get());
  }
  return values;
}

std::optional<std::string> TomlReader::choice(std::string_view key,
                                              const std::vector<std::string>& allowed) const {
  auto value = text_as(key, fmt::format("`\"{}\"`", fmt::join(allowed, "\"`, `\"")));
  if (value && std::find(allowed.begin(), allowed.end(), *value) == allowed.end()) {
    if (allowed.size() == 1)
      fail(key, fmt::format("'{}' is not allowed; only '{}' is", *value, allowed.front()));
    const std::string nearest = nearest_name(*value, allowed);
    fail(key,
         fmt::format("'{}' is not allowed; use one of {} (nearest: '{}')", *value,
                     fmt::join(allowed, ", "), nearest),
         near_name(*value, allowed) ? Repair{*value, nearest} : Repair{});
  }
  return value;
}

std::optional<bool> TomlReader::boolean(std::string_view key) const {
  const toml::node* node = state_->find(key, "true or false");
  if (!node) return {};
  if (!node->is_boolean()) fail(key, fmt::format("must be true or false, {}", not_a(*node)));
  return node->as_boolean()->get();
}

std::optional<long long> TomlReader::integer(std::string_view key, long long least,
                                             long long most) const {
  const bool bounded = most < std::numeric_limits<long long>::max();
  const toml::node* node =
      state_->find(key, bounded ? fmt::format("whole number, {} to {}", least, most)
                                : fmt::format("whole number from {}", least));
  if (!node) return {};
  if (!node->is_integer()) fail(key, fmt::format("must be a whole number, {}", not_a(*node)));
  const long long value = node->as_integer()->get();
  if (value < least || value > most) {
    fail(key, fmt::format("{} is out of range; use {} to {}", value, least, most));
  }
  return value;
}

namespace {

// The values allowed for a key with such a quantity.
std::string kind_of_quantity(std::string_view si) {
  if (si == "1") return "number";
  return may_be_plain(si) ? fmt::format("number, or text like `\"1 {}\"`", si)
                          : fmt::format("text like `\"1 {}\"`", si);
}

// The quantity in a node; throws InputError without a position.
Quantity read_node(const toml::node& node, std::string_view si) {
  if (const auto text = node.value_exact<std::string>()) {
    const Quantity quantity = read_quantity(*text, si);
    if (!std::isfinite(quantity.si())) throw InputError(fmt::format("'{}' is too large", *text));
    return quantity;
  }
  const auto number = node.value<double>();
  if (!number || node.is_boolean()) {
    throw InputError(may_be_plain(si)
                         ? fmt::format("must be a number, {}", not_a(node))
                         : fmt::format("must be a number with a unit, a text like '1.5 {}', {}", si,
                                       not_a(node)));
  }
  if (!std::isfinite(*number)) throw InputError("must be finite");
  if (!may_be_plain(si)) {
    throw InputError(
        fmt::format("{} has no unit (write one like \"{} {}\")", *number, *number, si));
  }
  return {*number, Unit{"1", 1, 0}};
}

// The repair of a number without a unit.
Repair unit_of_its_own(const toml::node& node, std::string_view si) {
  const auto number = node.value<double>();
  if (!number || node.is_boolean() || may_be_plain(si)) return {};
  const std::string text = fmt::format("{}", *number);
  return {text, fmt::format("\"{} {}\"", text, si)};
}

}  // namespace

std::optional<Quantity> TomlReader::quantity(std::string_view key, std::string_view si) const {
  const toml::node* node = state_->find(key, kind_of_quantity(si));
  if (!node) return {};
  try {
    return read_node(*node, si);
  } catch (const InputError& error) {
    fail(key, error.what(), unit_of_its_own(*node, si));
  }
}

Quantity TomlReader::required_quantity(std::string_view key, std::string_view si) const {
  const auto value = quantity(key, si);
  if (!value && si == "1") fail(key, "is missing (a number)");
  if (!value) fail(key, fmt::format("is missing (a quantity like '1 {}')", si));
  return *value;
}

std::vector<Quantity> TomlReader::quantities(std::string_view key, std::string_view si) const {
  const toml::node* node = state_->find(key, kind_of_quantity(si) + ", or a list");
  if (!node) return {};
  std::vector<Quantity> values;
  const auto read = [&](const toml::node& each, const std::string& where) {
    try {
      values.push_back(read_node(each, si));
    } catch (const InputError& error) {
      fail(key, where + error.what(), unit_of_its_own(each, si));
    }
  };
  if (!node->is_array()) {
    read(*node, "");
    return values;
  }
  for (const toml::node& each : *node->as_array())
    read(each, fmt::format("entry {}: ", values.size() + 1));
  return values;
}

std::optional<TomlReader> TomlReader::table(std::string_view key) const {
  const toml::node* node = state_->find(key, "table");
  if (!node) return {};
  if (!node->is_table())
    fail(key, fmt::format("must be a table ([{}] on a line of its own), {}", state_->path(key),
                          not_a(*node)));
  auto& child = state_->children[std::string(key)];
  if (!child) {
    child = std::make_shared<State>();
    child->root = state_->root;
    child->table = node->as_table();
    child->file = state_->file;
    child->text = state_->text;
    child->name = state_->path(key);
  }
  return TomlReader(child);
}

TomlReader TomlReader::required_table(std::string_view key) const {
  const auto value = table(key);
  if (!value) fail(key, "is missing (a table)");
  return *value;
}

std::vector<std::string> TomlReader::keys() const {
  std::vector<std::pair<toml::source_position, std::string>> found;
  for (const auto& [key, node] : *state_->table) {
    found.emplace_back(key.source().begin, std::string(key.str()));
  }
  std::sort(found.begin(), found.end());
  std::vector<std::string> names;
  for (auto& [position, name] : found) names.push_back(std::move(name));
  return names;
}

namespace {

void add_present(const toml::table& table, const std::string& name,
                 std::vector<std::pair<toml::source_position, TomlReader::Present>>& found) {
  for (const auto& [key, node] : table) {
    const toml::source_position at = node.source().begin;
    const std::string path =
        name.empty() ? std::string(key.str()) : fmt::format("{}.{}", name, key.str());
    found.push_back({key.source().begin,
                     {path, node.is_table(), node.value_exact<std::string>().value_or(""),
                      fmt::format("{}:{}", at.line, at.column), at.line, at.column}});
    if (node.is_table()) add_present(*node.as_table(), path, found);
  }
}

}  // namespace

std::vector<TomlReader::Present> TomlReader::present() const {
  std::vector<std::pair<toml::source_position, Present>> found;
  add_present(*state_->table, state_->name, found);
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Present> all;
  for (auto& [position, each] : found) all.push_back(std::move(each));
  return all;
}

std::map<std::string, std::set<std::string>> TomlReader::asked() const {
  std::map<std::string, std::set<std::string>> all;
  for (const auto& [key, kinds] : state_->asked)
    all[state_->path(key)].insert(kinds.begin(), kinds.end());
  for (const auto& [key, child] : state_->children) all.merge(TomlReader(child).asked());
  return all;
}

const std::string& TomlReader::file() const {
  return state_->file;
}

void TomlReader::finish() const {
  for (const std::string& key : keys()) {
    if (state_->asked.contains(key)) continue;
    std::vector<std::string> allowed;
    for (const auto& [name, kinds] : state_->asked) allowed.push_back(name);
    if (allowed.empty()) fail(key, "unknown key; no keys are allowed here");
    fail(key,
         fmt::format("unknown key; did you mean '{}'? (possible: {})", nearest_name(key, allowed),
                     fmt::join(allowed, ", ")),
         near_name(key, allowed) ? Repair{key, nearest_name(key, allowed), true} : Repair{});
  }
  for (const auto& [key, child] : state_->children) TomlReader(child).finish();
}

}  // namespace wearwell
