#include "wearwell/formula/symbols.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>

#include "wearwell/base/error.h"
#include "wearwell/formula/words.h"

namespace wearwell::formula {

void check_name(const std::string& name, const std::string& what) {
  const auto letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
  const auto inner = [&](char c) {
    return letter(c) || std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '_';
  };
  if (name.empty() || !letter(name.front()) || !std::all_of(name.begin(), name.end(), inner)) {
    throw InputError(
        fmt::format("the {} '{}' does not have a valid name; a name consists of letters a-z, "
                    "digits and _, and begins with a letter",
                    what, name));
  }
  if (name.size() > longest_name)
    throw InputError(fmt::format("the name of the {} '{}' is longer than {} characters", what, name,
                                 longest_name));
  if (is_word_of_language(name)) {
    throw InputError(
        fmt::format("the {} '{}' has the name of a keyword; give it another name", what, name));
  }
}

void check(const Symbols& symbols) {
  std::map<std::string, std::string> known;
  const auto add = [&](const std::string& name, const std::string& what) {
    check_name(name, what);
    const auto [at, is_new] = known.emplace(name, what);
    if (is_new) return;
    throw InputError(at->second == what
                         ? fmt::format("there are two {}s '{}'", what, name)
                         : fmt::format("'{}' is the name of a {} and of a {}; give one of them "
                                       "another name",
                                       name, at->second, what));
  };
  for (const auto& each : symbols.columns) add(each.name, "column");
  for (const auto& each : symbols.labels) add(each.name, "label");
  for (const auto& each : symbols.parameters) add(each.name, "parameter");
  for (const auto& each : symbols.constants) add(each.name, "constant");
  for (const auto& each : symbols.parameters) {
    if (each.scope != Scope::per_level) continue;
    const bool found = std::any_of(symbols.labels.begin(), symbols.labels.end(),
                                   [&](const auto& label) { return label.name == each.label; });
    if (!found) {
      throw InputError(fmt::format("the parameter '{}' varies by '{}', which is not a label",
                                   each.name, each.label));
    }
  }
}

std::vector<std::size_t> slots(const Symbols& symbols) {
  std::vector<std::size_t> first(1, 0);
  for (const ParameterSymbol& each : symbols.parameters) {
    std::size_t count = each.scope == Scope::one ? 1 : 0;
    if (each.scope == Scope::per_level) {
      for (const LabelSymbol& label : symbols.labels)
        if (label.name == each.label) count = label.levels.size();
    }
    first.push_back(first.back() + count);
  }
  return first;
}

}  // namespace wearwell::formula
