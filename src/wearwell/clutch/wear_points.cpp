#include "wearwell/clutch/wear_points.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <set>

#include "wearwell/base/error.h"

namespace wearwell::clutch {
namespace {

constexpr double most_gain = 4;  // standard deviations of the difference of two weighings

void check_cycles(const std::vector<Cycle>& cycles) {
  std::set<int> seen;
  for (std::size_t i = 0; i < cycles.size(); ++i) {
    const Cycle& cycle = cycles[i];
    if (!(cycle.energy > 0))
      throw InputError(fmt::format("plate {}, cycle {}: the energy is {} J; it must be positive",
                                   cycle.plate, cycle.number, cycle.energy));
    const bool same = i > 0 && cycles[i - 1].plate == cycle.plate;
    if (same && cycle.number <= cycles[i - 1].number)
      throw InputError(fmt::format("plate {}: cycle {} follows cycle {}; cycles must ascend",
                                   cycle.plate, cycle.number, cycles[i - 1].number));
    if (!same && !seen.insert(cycle.plate).second)
      throw InputError(fmt::format("plate {}: its cycles are not together", cycle.plate));
  }
}

}  // namespace

WornBlocks worn_blocks(const Campaign& campaign) {
  const auto& cycles = campaign.cycles;
  check_cycles(cycles);
  WornBlocks result;
  std::set<int> seen;
  std::size_t next = 0;  // cycle
  double energy_before = 0;
  for (std::size_t i = 0; i < campaign.weighings.size(); ++i) {
    const Weighing& after = campaign.weighings[i];
    if (i == 0 || campaign.weighings[i - 1].plate != after.plate) {
      if (!seen.insert(after.plate).second)
        throw InputError(fmt::format("plate {}: its weighings are not together", after.plate));
      if (after.block != Block::start)
        throw InputError(
            fmt::format("plate {}: the first weighing must be that of block 'start'", after.plate));
      next = 0;
      while (next < cycles.size() && cycles[next].plate != after.plate) ++next;
      energy_before = 0;
      continue;
    }
    const Weighing& before = campaign.weighings[i - 1];
    if (after.cycle == before.cycle)
      throw InputError(
          fmt::format("plate {} was weighed twice at cycle {}", after.plate, after.cycle));
    if (after.cycle < before.cycle)
      throw InputError(fmt::format("plate {}: the weighing at cycle {} follows that at cycle {}",
                                   after.plate, after.cycle, before.cycle));
    if (after.block == Block::start)
      throw InputError(
          fmt::format("plate {} starts twice, again at cycle {}", after.plate, after.cycle));
    WornBlock block{after.plate, after.block, after.point, after.sequence,
                    next,        next,        {},          energy_before};
    for (; next < cycles.size() && cycles[next].plate == after.plate &&
           cycles[next].number <= after.cycle;
         ++next) {
      block.energy += cycles[next].energy;
      for (const Input& input : inputs) block.mean.*input.value += cycles[next].at.*input.value;
    }
    block.last = next;
    if (block.cycles() != static_cast<double>(after.cycle - before.cycle))
      throw InputError(fmt::format(
          "plate {}: {} cycles are logged between the weighings at {} and {}, where {} ran",
          after.plate, block.cycles(), before.cycle, after.cycle, after.cycle - before.cycle));
    for (const Input& input : inputs) block.mean.*input.value /= block.cycles();
    const double loss = before.mass - after.mass;
    const double error = std::numbers::sqrt2 * campaign.balance_sd;
    if (loss < -most_gain * error)
      throw InputError(
          fmt::format("plate {} gained {:.4g} mg between cycles {} and {}: more than {:.0f} "
                      "standard deviations of the balance",
                      after.plate, -loss * 1e6, before.cycle, after.cycle, most_gain));
    if (loss < 0)
      result.flags.push_back(fmt::format(
          "plate {} gained {:.4g} mg between cycles {} and {}, within the error of the balance",
          after.plate, -loss * 1e6, before.cycle, after.cycle));
    block.volume = loss / campaign.density;
    block.w = block.volume / block.energy;
    block.balance_sd = error / (campaign.density * block.energy);
    energy_before += block.energy;
    result.blocks.push_back(std::move(block));
  }
  return result;
}

}  // namespace wearwell::clutch
