#include "wearwell/input/heading.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <regex>

#include "wearwell/base/error.h"
#include "wearwell/base/trimmed.h"
#include "wearwell/base/unit_hint.h"
#include "wearwell/base/unit_system.h"

namespace wearwell {
namespace {

/// A factor written as a unit, 1000 or 10^6; not the number of a column.
bool is_power_of_ten(const std::string& text) {
  const auto unit = parse_unit(text);
  if (!unit || !unit->dimension.empty() || !(unit->scale > 1)) return false;
  const double power = std::log10(unit->scale);
  return std::abs(power - std::round(power)) < 1e-9;
}

bool is_unit(const std::string& text, std::string_view si) {
  if (text.empty()) return false;
  try {
    if (si.empty()) return parse_unit(text).has_value();
    read_unit(text, si);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

/// 2024-02-01, 01.02.2024, 2024-02, 01/2024, 12:30, which units of digits alone could be; a factor 1/1000 is none.
bool is_date(const std::string& text) {
  static const std::regex form(
      R"(\d{1,4}[-/.]\d{1,2}[-/.]\d{1,4}([ T].*)?|(19|20)\d\d[-/.]\d{1,2}|\d{1,2}[-/.](19|20)\d\d|\d{1,2}:\d\d.*)");
  return std::regex_match(text, form);
}

/// The bracket that matches the last closing one.
std::size_t opening(std::string_view text, char open, char close) {
  int depth = 0;
  for (std::size_t i = text.size(); i-- > 0;) {
    depth += text[i] == close;
    depth -= text[i] == open;
    if (depth == 0) return i;
  }
  return text.npos;
}

std::optional<Heading> in_brackets(std::string_view text, char open, char close) {
  if (!text.ends_with(close)) return {};
  const std::size_t at = opening(text, open, close);
  if (at == text.npos) return {};
  return Heading{std::string(trimmed(text.substr(0, at))),
                 std::string(trimmed(text.substr(at + 1, text.size() - at - 2))), false};
}

/// Square brackets followed by words: "depth [um] (left)", but not "a (log10[MPa])".
std::optional<Heading> within(const std::string& text) {
  const std::size_t last = text.rfind(']');
  if (last == text.npos) return {};
  auto found = in_brackets(text.substr(0, last + 1), '[', ']');
  if (!found) return {};
  const auto count = [&](char c) { return std::count(found->name.begin(), found->name.end(), c); };
  if (count('(') != count(')')) return {};
  found->name = trimmed(found->name + text.substr(last + 1));
  found->unit = bare_unit(found->unit);
  found->certain = true;
  return found;
}

}  // namespace

bool is_unit_of_heading(const std::string& text, std::string_view si, bool suffix) {
  const bool number = !text.empty() && text.front() >= '0' && text.front() <= '9' &&
                      text.find('/') == text.npos && text.find(' ') == text.npos;
  return !(number && (suffix || !is_power_of_ten(text))) && is_unit(text, si);
}

Heading read_heading(std::string_view heading, std::string_view si) {
  const std::string text(trimmed(heading));
  if (auto found = in_brackets(text, '[', ']')) {
    found->unit = bare_unit(found->unit);
    found->certain = true;
    return *found;
  }
  if (auto found = in_brackets(text, '(', ')'); found && !found->name.empty()) {
    found->unit = bare_unit(found->unit);
    if (found->name.ends_with('/'))
      found->name = trimmed(found->name.substr(0, found->name.size() - 1));
    found->certain = without_times(found->unit) != found->unit;
    if (found->certain || is_unit_of_heading(found->unit, si)) return *found;
  }
  // Tries the longest unit first: "speed in 1/min" is not "speed in 1" per minute.
  constexpr std::array<std::string_view, 4> separators = {" / ", " in ", ", ", "/"};
  for (const std::string_view separator : separators) {
    const std::size_t at = text.find(separator);
    if (at == text.npos || at == 0) continue;
    const Heading found{std::string(trimmed(text.substr(0, at))),
                        bare_unit(text.substr(at + separator.size())), false};
    if (is_unit_of_heading(found.unit, si)) return found;
  }
  for (std::size_t at = text.find('_'); at != text.npos && at > 0; at = text.find('_', at + 1)) {
    const Heading found{text.substr(0, at), text.substr(at + 1), false, true};
    if (is_unit_of_heading(found.unit, si, true)) return found;
  }
  if (const auto found = within(text)) return *found;
  return {text, "", false};
}

std::string bare_unit(std::string_view text) {
  std::string unit(trimmed(text));
  for (const auto& [open, close] : {std::pair{'[', ']'}, {'(', ')'}}) {
    if (unit.size() > 1 && unit.front() == open && opening(unit, open, close) == 0)
      unit = trimmed(unit.substr(1, unit.size() - 2));
  }
  return unit == "-" || unit == "\u2013" ? "1" : unit;
}

bool is_unit_cell(std::string_view cell) {
  const std::string text(trimmed(cell));
  if (text.empty()) return false;
  if (text.front() == '[' && text.back() == ']') return true;
  return !is_date(text) && is_unit(bare_unit(text), "");
}

}  // namespace wearwell
