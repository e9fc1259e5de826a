#pragma once

#include <optional>
#include <string>

#include "wearwell/models/fatigue/damage.h"
#include "wearwell/models/fatigue/load_history.h"
#include "wearwell/models/fatigue/signal_file.h"

namespace wearwell::fatigue {

/// Where the cycles of one block stand: a signal, which is counted, or a table of counted cycles with
/// columns `range` or `amplitude`, `mean` or `stress_ratio`, and `cycles` (or `count`); of a load, a force
/// or a strain by these names too (`force_range`, `mean_force`).
struct BlockChoice {
  SignalChoice signal;  ///< with a column named it is a signal
  CountingRule rule;
  std::string scale;             ///< "0.35 MPa/N": from load to stress; empty for none
  bool with_mean = true;         ///< whether the mean stress matters
  bool timed = false;            ///< whether it is asked how long the signal lasts
  std::string stress_si = "Pa";  ///< of the curve that the cycles are for
};

struct Block {
  LoadCycles cycles;
  double count = 0;         ///< of all cycles
  std::string description;  ///< what was read, a sentence
  std::optional<double> seconds =
      {};  ///< that it lasts, where asked for and a column of times says it
  /// Of a signal where the mean stress does not matter: the largest that there is, as it would be in `cycles`.
  double largest_mean_left_out = 0;
};

/// Throws InputError: neither kind or both, no unit or two, a load of another dimension than the curve's
/// stress without a scale, amplitude and
/// range not told apart, no mean where it matters, a count or an amplitude that is none.
Block read_block(const BlockChoice& choice);

/// Cycles of at most so many stresses: near ones become one of their mean. Without `with_mean` the
/// mean stress is left out.
LoadCycles reduced(const LoadCycles& cycles, std::size_t most, bool with_mean);

}  // namespace wearwell::fatigue
