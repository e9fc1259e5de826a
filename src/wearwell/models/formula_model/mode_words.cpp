#include "wearwell/models/formula_model/mode_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <regex>

#include "wearwell/base/contains.h"
#include "wearwell/base/error.h"
#include "wearwell/input/cell_text.h"
#include "wearwell/input/status_words.h"
#include "wearwell/models/formula_model/failure_modes.h"

namespace wearwell::formula_model {

bool ModeWords::means_unknown(const std::string& text) const {
  if (text.empty() || is_missing_mark(text)) return true;
  const std::string word = folded_word(text);
  return word == "unknown" || contains(unknown, word);
}

bool ModeWords::means_runout(const std::string& text) const {
  const std::string word = folded_word(text);
  if (!runout.empty()) return contains(runout, word);
  if (text.empty()) return false;
  return censoring_by_word(text) == Censoring::right && word.size() >= shortest_runout_word;
}

// An empty word stands for empty cells.
ModeWords read_mode_words(const TomlReader& failure_modes) {
  ModeWords words;
  for (const std::string& each : failure_modes.texts("runout"))
    words.runout.push_back(folded_word(each));
  for (const std::string& each : failure_modes.texts("unknown"))
    words.unknown.push_back(folded_word(each));
  for (const std::string& each : words.unknown)
    if (contains(words.runout, each))
      failure_modes.fail("unknown", fmt::format("'{}' is a word of runout, too", each));
  return words;
}

std::vector<std::string> modes_in(const std::string& text,
                                  const std::function<std::string()>& place) {
  std::vector<std::string> modes;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t bar = std::min(text.find('|', at), text.size());
    std::string mode = text.substr(at, bar - at);
    mode.erase(0, std::min(mode.find_first_not_of(" \t"), mode.size()));
    mode.erase(mode.find_last_not_of(" \t") + 1);
    at = bar + 1;
    if (mode.empty())
      throw InputError(fmt::format(
          "{}: '{}' has an empty failure mode; write the possible ones as 'A|B'", place(), text));
    if (mode.find('\'') != mode.npos && mode.find('"') != mode.npos)
      throw InputError(fmt::format("{}: '{}' has both kinds of quotation marks", place(), mode));
    if (!contains(modes, mode)) modes.push_back(std::move(mode));
  }
  return modes;
}

namespace {

// Codes such as 1.1 and 11 differ in a mark.
bool is_spelled_alike(const std::string& a, const std::string& b) {
  const auto has_digit = [](const std::string& text) {
    return text.find_first_of("0123456789") != text.npos;
  };
  if (has_digit(a) || has_digit(b))
    return boost::algorithm::iequals(boost::algorithm::erase_all_copy(a, " "),
                                     boost::algorithm::erase_all_copy(b, " "));
  return !folded_word(a).empty() && folded_word(a) == folded_word(b);
}

// "seal or gear", "seal/gear", "seal?": what stands between the separators.
std::vector<std::string> named_together(const std::string& mode) {
  static const std::regex separator(R"(\s*[/,;+&?]\s*|\s+(or|and|oder|und|ou|et|o|y)\s+)",
                                    std::regex::icase);
  std::vector<std::string> parts;
  for (std::sregex_token_iterator at(mode.begin(), mode.end(), separator, -1), end; at != end; ++at)
    if (at->length() > 0) parts.push_back(at->str());
  return parts.size() == 1 && parts.front() == mode ? std::vector<std::string>() : parts;
}

}  // namespace

std::string doubt_of_mode(const std::string& mode, const std::vector<std::string>& others) {
  for (const std::string& other : others) {
    if (other != mode && is_spelled_alike(other, mode))
      return fmt::format(
          "'{}' beside '{}' can be one failure mode or two; write one spelling, or two names that "
          "differ in more than capitals, blanks and marks",
          mode, other);
  }
  std::vector<std::string> parts = named_together(mode);
  for (std::string& part : parts) {
    const auto known = std::find_if(others.begin(), others.end(), [&](const std::string& other) {
      return other != mode && is_spelled_alike(other, part);
    });
    if (known == others.end()) return "";
    part = *known;
  }
  if (parts.empty()) return "";
  return fmt::format(
      "'{0}' can mean that the failure mode is not known, or a mode of its own beside {1}; for the "
      "first write {2} in the cell; for the second give it a table [failure_modes.\"{0}\"], or "
      "another name",
      mode, fmt::join(parts, ", "),
      parts.size() > 1 ? fmt::format("'{}'", fmt::join(parts, "|")) : "'unknown'");
}

}  // namespace wearwell::formula_model
