#include "wearwell/monitor/config_problems.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <utility>

#include "wearwell/base/error.h"
#include "wearwell/base/input_errors.h"
#include "wearwell/base/nearest.h"

namespace wearwell::monitor {
namespace {

/// Line and column of a message "FILE:LINE:COLUMN: ..."; the largest ones if it has no place.
std::pair<std::size_t, std::size_t> place_of(const std::string& message) {
  constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  std::size_t end = message.find(": "), line = none, column = none;
  for (std::size_t* number : {&column, &line}) {
    const std::size_t colon = end == message.npos || end == 0 ? end : message.rfind(':', end - 1);
    if (colon == message.npos) return {none, none};
    const char* last = message.data() + end;
    const auto [rest, error] = std::from_chars(message.data() + colon + 1, last, *number);
    if (error != std::errc() || rest != last) return {none, none};
    end = colon;
  }
  return {line, column};
}

}  // namespace

bool Problems::in(const std::function<void()>& part, const std::string& example) {
  try {
    part();
    return true;
  } catch (const InputErrors& errors) {
    for (const std::string& each : errors.all) add(each);
  } catch (const InputError& error) {
    const std::string what = error.what();
    const bool has_excerpt = what.find("\n    ") != what.npos;
    add(example.empty() || what.find("\n    right: ") != what.npos ? what
        : has_excerpt ? fmt::format("{}\n    right: {}", what, example)
                      : fmt::format("{}; for example:\n    {}", what, example));
  }
  return false;
}

void Problems::add(const std::string& text) {
  if (std::find(all_.begin(), all_.end(), text) == all_.end()) all_.push_back(text);
}

void Problems::unknown_keys(const TomlReader& table, const std::string& path) {
  const auto asked = table.asked();
  const std::string prefix = path.empty() ? path : path + ".";
  std::vector<std::string> allowed;
  for (const auto& [name, kinds] : asked) {
    const std::string key = name.substr(prefix.size());
    if (key.find('.') == key.npos) allowed.push_back(key);
  }
  for (const std::string& key : table.keys()) {
    const std::string name = prefix + key;
    if (!asked.contains(name)) {
      in([&] {
        if (allowed.empty()) table.fail(key, "unknown key; no keys are allowed here");
        const std::string nearest = nearest_name(key, allowed);
        table.fail(key,
                   fmt::format("unknown key; did you mean '{}'? (possible: {})", nearest,
                               fmt::join(allowed, ", ")),
                   near_name(key, allowed) ? Repair{key, nearest, true} : Repair{});
      });
      continue;
    }
    const std::string below = name + ".";
    const auto first = asked.lower_bound(below);
    if (first == asked.end() || !first->first.starts_with(below)) continue;
    if (const auto inner = table.table(key)) unknown_keys(*inner, name);
  }
}

void Problems::finish() const {
  if (all_.empty()) return;
  std::vector<std::string> sorted = all_;
  std::stable_sort(sorted.begin(), sorted.end(), [](const std::string& a, const std::string& b) {
    return place_of(a) < place_of(b);
  });
  throw InputErrors(std::move(sorted));
}

}  // namespace wearwell::monitor
