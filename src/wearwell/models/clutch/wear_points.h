#pragma once

#include <string>
#include <vector>

#include "wearwell/models/clutch/campaign.h"

namespace wearwell::clutch {

/// The cycles of a plate between two weighings, and their wear.
struct WornBlock {
  int plate = 0;
  Block block = Block::run_in;
  int point = 0;
  std::string sequence;
  /// its cycles, indices into Campaign::cycles, `last` is one past the end
  std::size_t first = 0, last = 0;
  OperatingPoint mean;       ///< of its cycles
  double energy_before = 0;  ///< absorbed by the plate earlier, J
  double energy = 0;         ///< of its cycles, J
  double volume = 0;         ///< (m_before - m_after)/density, m^3
  double w = 0;              ///< volume/energy, m^3/J
  double balance_sd = 0;     ///< of w, from two weighings: sqrt(2) balance_sd/(density energy)

  double cycles() const { return static_cast<double>(last - first); }
};

struct WornBlocks {
  std::vector<WornBlock> blocks;   ///< in the order of the weighings
  std::vector<std::string> flags;  ///< unusual but possible facts, one sentence each
};

/// Wear of every block (Haramina et al. 2025, section 2.3). Throws InputError, naming row, plate
/// and cycle, for a plate without a first weighing, two weighings at one cycle, cycles or weighings
/// out of order, cycles missing from a block or an energy that is not positive, and for a plate
/// that gained more mass than the error of the balance explains (4 standard deviations of a
/// difference). A smaller gain is flagged and kept; cycles that no weighing follows are flagged.
WornBlocks worn_blocks(const Campaign& campaign);

/// One sentence for each input whose mean over the block of a point lies farther from the design than
/// a rig does: a table has another unit, or points have other numbers. The worst point is named.
std::vector<std::string> off_design(const Campaign& campaign, const std::vector<WornBlock>& blocks);

/// Throws InputError as worn_blocks does for the cycles alone.
void require_ordered_cycles(const Campaign& campaign);

}  // namespace wearwell::clutch
