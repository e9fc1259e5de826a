#pragma once

#include "wearwell/models/clutch/campaign.h"

namespace wearwell::clutch {

/// Largest share of the cycles between two weighings that may be missing from the log and filled
/// in.
inline constexpr double most_missing = 0.05;

/// Fills cycles between two weighings that were not logged with copies of the previous logged cycle
/// (at the start of a block, of the next one), and reports this in `Campaign::filled`. This is
/// unbiased if cycles are lost at random. Throws InputError as worn_blocks does for cycles out of
/// order, and if more than `most_missing` of a block is missing.
void fill_missing_cycles(Campaign& campaign);

}  // namespace wearwell::clutch
