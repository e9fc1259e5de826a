#include "wearwell/models/formula_model/mode_words.h"

#include <fmt/format.h>

#include <algorithm>

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

}  // namespace wearwell::formula_model
