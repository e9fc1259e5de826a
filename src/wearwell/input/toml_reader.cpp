#include "wearwell/input/toml_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

// Some text that is no TOML ("[.=") breaks an assertion of toml++, and without its assertions the
// behaviour is undefined. So they are on here, and throw: in the headers, because Debian's library
// is built without.
namespace wearwell {
namespace {
struct NoToml {};
[[noreturn]] void assertion_failed() {
  throw NoToml();
}
}  // namespace
}  // namespace wearwell
#undef NDEBUG
#undef TOML_SHARED_LIB
#undef TOML_HEADER_ONLY
#define TOML_HEADER_ONLY 1
#define TOML_ASSERT(expr) ((expr) ? static_cast<void>(0) : wearwell::assertion_failed())
#define TOML_MAX_NESTED_VALUES 32
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/base/printable.h"

namespace wearwell {
namespace {

constexpr int most_parts = 32;  // of a dotted key

/// The length of the string or comment that begins at `at`; 0 where none does.
std::size_t skipped(const std::string& text, std::size_t at) {
  const char quote = text[at];
  if (quote == '#') return std::min(text.find('\n', at), text.size()) - at;
  if (quote != '"' && quote != '\'') return 0;
  const bool long_one = text.compare(at, 3, std::string(3, quote)) == 0;
  const std::string end(long_one ? 3 : 1, quote);
  for (std::size_t i = at + end.size(); i < text.size(); ++i) {
    if (quote == '"' && text[i] == '\\') {
      ++i;
    } else if (text.compare(i, end.size(), end) == 0) {
      return i + end.size() - at;
    } else if (text[i] == '\n' && !long_one) {
      return i - at;  // never closed, which the parser says better
    }
  }
  return text.size() - at;
}

/// toml++ goes down a call for each part of a dotted key; a key of many thousands is a table that
/// the stack cannot hold.
void refuse_long_keys(const std::string& text, const std::string& name) {
  int parts = 1, line = 1;
  for (std::size_t i = 0; i < text.size();) {
    if (const std::size_t length = skipped(text, i)) {
      line += static_cast<int>(std::count(text.begin() + static_cast<std::ptrdiff_t>(i),
                                          text.begin() + static_cast<std::ptrdiff_t>(i + length),
                                          '\n'));
      i += length;
      continue;
    }
    const char c = text[i++];
    if (c == '.') {
      if (++parts > most_parts)
        throw InputError(fmt::format("{}:{}: a key of more than {} parts is none of a study", name,
                                     line, most_parts));
    } else if (c == '=' || c == ',' || c == '[' || c == ']' || c == '{' || c == '}' || c == '\n') {
      parts = 1;
      if (c == '\n') ++line;
    }
  }
}

/// The line at which an assertion fails: no shorter part of the text breaks it.
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

}  // namespace

struct TomlReader::State {
  std::shared_ptr<const toml::table> root;  // keeps `table` alive
  const toml::table* table = nullptr;
  std::string file;
  std::string name;  // "prior.k"; empty for the whole file
  std::set<std::string, std::less<>> asked;
  std::map<std::string, std::shared_ptr<State>, std::less<>> children;

  const toml::node* find(std::string_view key) {
    asked.emplace(key);
    return table->get(key);
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
    if (state->table->empty()) throw InputError(fmt::format("{} is empty", name));
    return TomlReader(state);
  } catch (const toml::parse_error& error) {
    throw InputError(fmt::format("{}:{}:{}: {}", name, error.source().begin.line,
                                 error.source().begin.column, error.description()));
  } catch (const NoToml&) {
    throw InputError(fmt::format(
        "{}:{}: no TOML: a key or a value is missing where one must stand, behind '[' or '='", name,
        line_of_failure(file.text)));
  }
}

void TomlReader::fail(std::string_view key, const std::string& message) const {
  const toml::node* node = state_->table->get(key);
  const toml::source_region& source = node ? node->source() : state_->table->source();
  const std::string where = state_->name.empty() ? std::string(key)
                            : key.empty()        ? fmt::format("[{}]", state_->name)
                                                 : fmt::format("{}.{}", state_->name, key);
  throw InputError(fmt::format("{}:{}:{}: {}: {}", state_->file, source.begin.line,
                               source.begin.column, where, message));
}

bool TomlReader::has(std::string_view key) const {
  return state_->find(key) != nullptr;
}

bool TomlReader::is_text(std::string_view key) const {
  const toml::node* node = state_->find(key);
  return node && node->is_string();
}

std::optional<std::string> TomlReader::text(std::string_view key) const {
  const toml::node* node = state_->find(key);
  if (!node) return {};
  if (!node->is_string()) fail(key, "must be a text in quotes");
  return node->as_string()->get();
}

std::string TomlReader::required_text(std::string_view key) const {
  const auto value = text(key);
  if (!value) fail(key, "is missing");
  return *value;
}

std::vector<std::string> TomlReader::texts(std::string_view key) const {
  const toml::node* node = state_->find(key);
  if (!node) return {};
  if (!node->is_array()) return {*text(key)};
  std::vector<std::string> values;
  for (const toml::node& each : *node->as_array()) {
    if (!each.is_string()) fail(key, "must be a text in quotes, or a list of them");
    values.push_back(each.as_string()->get());
  }
  return values;
}

std::optional<std::string> TomlReader::choice(std::string_view key,
                                              const std::vector<std::string>& allowed) const {
  auto value = text(key);
  if (value && std::find(allowed.begin(), allowed.end(), *value) == allowed.end()) {
    fail(key, fmt::format("'{}' is not possible; it is one of {} (nearest: '{}')", *value,
                          fmt::join(allowed, ", "), nearest_name(*value, allowed)));
  }
  return value;
}

std::optional<long long> TomlReader::integer(std::string_view key, long long least,
                                             long long most) const {
  const toml::node* node = state_->find(key);
  if (!node) return {};
  if (!node->is_integer()) fail(key, "must be a whole number");
  const long long value = node->as_integer()->get();
  if (value < least || value > most) {
    fail(key, fmt::format("{} is out of range, {} to {} is possible", value, least, most));
  }
  return value;
}

namespace {

// What a node holds as a quantity; throws InputError without a place.
Quantity read_node(const toml::node& node, std::string_view si) {
  if (const auto text = node.value_exact<std::string>()) {
    const Quantity quantity = read_quantity(*text, si);
    if (!std::isfinite(quantity.si()))
      throw InputError(fmt::format("'{}' is too large a number", *text));
    return quantity;
  }
  const auto number = node.value<double>();
  if (!number || node.is_boolean()) throw InputError("must be a number, or a text like '1.5 mm'");
  if (!std::isfinite(*number)) throw InputError("must be finite");
  if (!may_be_plain(si)) {
    throw InputError(
        fmt::format("{} has no unit (write one like \"{} {}\")", *number, *number, si));
  }
  return {*number, Unit{"1", 1, 0}};
}

}  // namespace

std::optional<Quantity> TomlReader::quantity(std::string_view key, std::string_view si) const {
  const toml::node* node = state_->find(key);
  if (!node) return {};
  try {
    return read_node(*node, si);
  } catch (const InputError& error) {
    fail(key, error.what());
  }
}

Quantity TomlReader::required_quantity(std::string_view key, std::string_view si) const {
  const auto value = quantity(key, si);
  if (!value) fail(key, fmt::format("is missing (a quantity like '1 {}')", si));
  return *value;
}

std::vector<Quantity> TomlReader::quantities(std::string_view key, std::string_view si) const {
  const toml::node* node = state_->find(key);
  if (!node) return {};
  if (!node->is_array()) return {*quantity(key, si)};
  std::vector<Quantity> values;
  for (const toml::node& each : *node->as_array()) {
    try {
      values.push_back(read_node(each, si));
    } catch (const InputError& error) {
      fail(key, fmt::format("entry {}: {}", values.size() + 1, error.what()));
    }
  }
  return values;
}

std::optional<TomlReader> TomlReader::table(std::string_view key) const {
  const toml::node* node = state_->find(key);
  if (!node) return {};
  if (!node->is_table()) fail(key, "must be a table");
  auto& child = state_->children[std::string(key)];
  if (!child) {
    child = std::make_shared<State>();
    child->root = state_->root;
    child->table = node->as_table();
    child->file = state_->file;
    child->name = state_->name.empty() ? std::string(key) : fmt::format("{}.{}", state_->name, key);
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

void TomlReader::finish() const {
  for (const std::string& key : keys()) {
    if (state_->asked.count(key)) continue;
    const std::vector<std::string> allowed(state_->asked.begin(), state_->asked.end());
    if (allowed.empty()) fail(key, "unknown key; nothing may stand here");
    fail(key, fmt::format("unknown key; did you mean '{}'? (possible: {})",
                          nearest_name(key, allowed), fmt::join(allowed, ", ")));
  }
  for (const auto& [key, child] : state_->children) TomlReader(child).finish();
}

}  // namespace wearwell
