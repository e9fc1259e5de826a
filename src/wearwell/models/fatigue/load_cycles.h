#pragma once

#include <optional>
#include <string>

#include "wearwell/models/fatigue/damage.h"
#include "wearwell/models/fatigue/load_history.h"
#include "wearwell/models/fatigue/signal_file.h"

namespace wearwell::fatigue {

/// The source of the cycles of one block: a signal, which is counted, or a table of counted cycles
/// with columns `range` or `amplitude`, `mean` or `stress_ratio`, and `cycles` (or `count`); for a
/// load, a force or a strain with these names too (`force_range`, `mean_force`).
struct BlockChoice {
  SignalChoice signal;  ///< with a named column it is a signal
  CountingRule rule;
  std::string scale;             ///< "0.35 MPa/N": from load to stress; empty for none
  bool with_mean = true;         ///< whether the mean stress matters
  bool timed = false;            ///< whether the duration of the signal is needed
  std::string stress_si = "Pa";  ///< of the S-N curve
};

struct Block {
  LoadCycles cycles;
  double count = 0;                    ///< of all cycles
  std::string description;             ///< description of the input, a sentence
  std::optional<double> seconds = {};  ///< duration, if requested and known from a column of times
  /// For a signal if the mean stress does not matter: the largest mean in `cycles`.
  double largest_mean_left_out = 0;
};

/// Throws InputError: neither kind or both, no unit or two, a load of another dimension than the
/// curve's stress without a scale, amplitude and range not distinguished, no mean where it matters,
/// an invalid count or amplitude.
Block read_block(const BlockChoice& choice);

/// Cycles of at most this many stresses: close ones are merged into one at their mean. Without
/// `with_mean` the mean stress is left out.
LoadCycles reduced(const LoadCycles& cycles, std::size_t most, bool with_mean);

}  // namespace wearwell::fatigue
