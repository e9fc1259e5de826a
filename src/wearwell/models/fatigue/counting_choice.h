#pragma once

#include <string>

#include "wearwell/models/fatigue/load_history.h"
#include "wearwell/models/fatigue/signal_file.h"

namespace wearwell::fatigue {

/// A signal and the counting method, as a user writes them.
struct CountingChoice {
  SignalChoice signal = {};
  std::string method = "four-point", residual = "half";

  /// Throws InputError that names the option: another word.
  CountingRule rule(double class_width = 0) const;
};

/// The place of `word` among `words`. Throws InputError that begins with the option and lists the words.
std::size_t choice_among(const std::string& option, const std::string& word,
                         const std::vector<std::string>& words);

}  // namespace wearwell::fatigue
