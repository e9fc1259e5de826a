#pragma once

#include "wearwell/models/fatigue/counting_choice.h"
#include "wearwell/models/fatigue/history_report.h"

namespace wearwell::fatigue {

/// The options of `wearwell fatigue rainflow`, as a user writes them.
struct HistoryRequest {
  CountingChoice counting = {};
  int bins = 32;         ///< largest number of displayed classes of range
  double bin_width = 0;  ///< their width, in the unit of the load; 0: a power of two
};

/// Counts all samples of the file after those that `history` has. Throws InputError: no rows, no
/// cycle, too many classes; Cancelled.
HistoryReport counted_history(const HistoryRequest& request, SignalFile& file,
                              LoadHistory& history);

}  // namespace wearwell::fatigue
