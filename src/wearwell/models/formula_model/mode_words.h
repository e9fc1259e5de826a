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

/// Why the last of these modes may be none of its own: one before is spelled alike ("Seal", "seal"), or it names others
/// ("seal or gear", "seal/gear", "seal?"), and then these are not known. Empty if it is clear.
std::string doubt_of_mode(const std::string& mode, const std::vector<std::string>& others);

}  // namespace wearwell::formula_model
