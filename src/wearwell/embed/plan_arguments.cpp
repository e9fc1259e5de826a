#include "wearwell/embed/plan_arguments.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/base/printable.h"

namespace wearwell::embed {
namespace {

using Json = nlohmann::ordered_json;

std::string kind_of(const Json& value) {
  if (value.is_boolean()) return "a truth value";
  if (value.is_number()) return "a number";
  if (value.is_string()) return "a text";
  return value.is_object() ? "named values" : "a list";
}

double number_of(const char* name, const Json& value) {
  if (!value.is_number() || !std::isfinite(value.get<double>()))
    throw InputError(fmt::format("{} is {}; it is a number", name, kind_of(value)));
  return value.get<double>();
}

}  // namespace

PlanArguments::PlanArguments(std::string function, const Json& arguments)
    : function_(std::move(function)), arguments_(arguments) {
  if (!arguments_.is_object()) throw InputError(fmt::format("{}: arguments have names", function_));
}

const Json* PlanArguments::find(const char* name) {
  if (std::find(known_.begin(), known_.end(), name) == known_.end()) {
    known_.emplace_back(name);
    std::string option = std::string("--") + name;
    std::replace(option.begin(), option.end(), '_', '-');
    options_.emplace_back(std::move(option), name);
  }
  const auto at = arguments_.find(name);
  return at == arguments_.end() || at->is_null() ? nullptr : &*at;
}

std::string PlanArguments::one_text(const char* name, const Json& value) const {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_float()) return fmt::format("{}", value.get<double>());
  if (value.is_number()) return value.dump();
  throw InputError(fmt::format("{} is {}; it is a text or a number", name, kind_of(value)));
}

void PlanArguments::text(const char* name, std::string& to) {
  if (const Json* value = find(name)) to = one_text(name, *value);
}

void PlanArguments::texts(const char* name, std::vector<std::string>& to) {
  const Json* value = find(name);
  if (!value) return;
  to.clear();
  if (value->is_object()) {
    for (const auto& [key, each] : value->items())
      to.push_back(fmt::format("{} = {}", key, one_text(name, each)));
  } else if (value->is_array()) {
    for (const Json& each : *value) to.push_back(one_text(name, each));
  } else {
    to.push_back(one_text(name, *value));
  }
}

std::string PlanArguments::listed(const char* name, const Json& value) const {
  if (!value.is_array()) return one_text(name, value);
  std::string all;
  for (const Json& each : value) all += (all.empty() ? "" : ", ") + one_text(name, each);
  return all;
}

void PlanArguments::list(const char* name, std::string& to) {
  if (const Json* value = find(name)) to = listed(name, *value);
}

void PlanArguments::clauses(const char* name, std::string& to) {
  const Json* value = find(name);
  if (!value) return;
  if (!value->is_object()) {
    to = one_text(name, *value);
    return;
  }
  to.clear();
  for (const auto& [key, each] : value->items())
    to += fmt::format("{}{} = {}", to.empty() ? "" : "; ", key, listed(name, each));
}

void PlanArguments::named_texts(const char* name,
                                std::vector<std::pair<std::string, std::string>>& to) {
  const Json* value = find(name);
  if (!value) return;
  if (!value->is_object())
    throw InputError(fmt::format("{} is {}; it holds texts by name", name, kind_of(*value)));
  to.clear();
  for (const auto& [key, each] : value->items()) to.emplace_back(key, one_text(name, each));
}

void PlanArguments::numbers(const char* name, std::vector<double>& to) {
  const Json* value = find(name);
  if (!value) return;
  to.clear();
  if (!value->is_array()) return to.push_back(number_of(name, *value));
  for (const Json& each : *value) to.push_back(number_of(name, each));
}

void PlanArguments::number(const char* name, std::optional<double>& to) {
  if (const Json* value = find(name)) to = number_of(name, *value);
}

void PlanArguments::number(const char* name, double& to) {
  std::optional<double> value;
  number(name, value);
  if (value) to = *value;
}

std::optional<std::size_t> PlanArguments::whole_of(const char* name, std::size_t least,
                                                   std::size_t most) {
  const Json* value = find(name);
  if (!value) return {};
  const double number =
      value->is_number() ? value->get<double>() : std::numeric_limits<double>::quiet_NaN();
  if (number != std::floor(number) || !(number >= static_cast<double>(least)) ||
      !(number <= static_cast<double>(most)))
    throw InputError(fmt::format("{} is {}; it is a whole number from {} to {}", name,
                                 value->is_number() ? value->dump() : kind_of(*value), least,
                                 most));
  return static_cast<std::size_t>(number);
}

void PlanArguments::truth(const char* name, bool& to) {
  const Json* value = find(name);
  if (!value) return;
  if (!value->is_boolean())
    throw InputError(fmt::format("{} is {}; it is true or false", name, kind_of(*value)));
  to = value->get<bool>();
}

void PlanArguments::seed(const char* name, std::uint64_t& to) {
  const Json* value = find(name);
  if (!value) return;
  if (value->is_string()) {
    const auto& text = value->get_ref<const std::string&>();
    const char* const end = text.data() + text.size();
    const auto [at, error] = std::from_chars(text.data(), end, to);
    if (error == std::errc{} && at == end && !text.empty()) return;
  } else if (value->is_number_unsigned()) {
    to = value->get<std::uint64_t>();
    return;
  }
  throw InputError(fmt::format("{} is {}; it is a whole number from 0 to 2^64 - 1", name,
                               value->is_structured() ? kind_of(*value) : value->dump()));
}

void PlanArguments::finish() const {
  for (const auto& [name, value] : arguments_.items()) {
    if (std::find(known_.begin(), known_.end(), name) == known_.end())
      throw InputError(fmt::format("{} has no argument '{}'{} (arguments: {})", function_,
                                   printable(name), did_you_mean(name, known_),
                                   fmt::join(known_, ", ")));
  }
}

void PlanArguments::call_option(const std::string& option, const std::string& argument) {
  options_.emplace_back(option, argument);
}

std::string PlanArguments::in_arguments(const std::string& text) const {
  const auto in_word = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_';
  };
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const bool begins = at == 0 || !in_word(text[at - 1]);
    const auto option = std::find_if(options_.begin(), options_.end(), [&](const auto& each) {
      const std::size_t end = at + each.first.size();
      return text.compare(at, each.first.size(), each.first) == 0 &&
             (end == text.size() || !in_word(text[end]));
    });
    if (begins && option != options_.end()) {
      result += option->second;
      at += option->first.size();
    } else {
      result += text[at++];
    }
  }
  return result;
}

}  // namespace wearwell::embed
