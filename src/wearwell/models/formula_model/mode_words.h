#pragma once

#include <functional>
#include <string>
#include <vector>

#include "wearwell/input/toml_reader.h"

namespace wearwell::formula_model {

/// What the words in a column of failure modes mean: `runout` and `unknown` of [failure_modes], folded.
struct ModeWords {
  std::vector<std::string> runout = {}, unknown = {};

  /// An empty cell, "unknown", or a word of the study.
  bool means_unknown(const std::string& text) const;
  /// A word of the study, if it has any; else one that is long enough to mean nothing else.
  bool means_runout(const std::string& text) const;
};

ModeWords read_mode_words(const TomlReader& failure_modes);

/// The failure modes that a cell names: one, or the possible ones of "A|B". Throws InputError that begins with `place` for an
/// empty one, and for one with both kinds of quotation marks.
std::vector<std::string> modes_in(const std::string& text,
                                  const std::function<std::string()>& place);

}  // namespace wearwell::formula_model
