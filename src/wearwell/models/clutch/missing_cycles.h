#pragma once

#include "wearwell/models/clutch/campaign.h"

namespace wearwell::clutch {

/// Of the cycles between two weighings at most this share may be missing from the log and filled in.
inline constexpr double most_missing = 0.05;

/// Puts a copy of the logged cycle before it (at the beginning of a block of the one behind it) where a
/// cycle that ran between two weighings was not logged, and says so in `Campaign::filled`. That is unbiased
/// where cycles are lost at random. Throws InputError as worn_blocks does for cycles that are out of order,
/// and where more than `most_missing` of a block is missing.
void fill_missing_cycles(Campaign& campaign);

}  // namespace wearwell::clutch
