#include "wearwell/models/clutch/wear_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "wearwell/base/error.h"

namespace wearwell::clutch {
namespace {

constexpr double most_off_design = 0.25;  // of the designed value; a rig holds a few percent
constexpr double most_gain = 4;           // standard deviations of the difference of two weighings

/// "cycles.csv, row 12: plate 3"
std::string place(const Campaign& campaign, const std::string& source, std::size_t index,
                  int plate) {
  return fmt::format("{}, row {}: plate {}", source, index + 1, campaign.plate_name(plate));
}

/// Number of cycles by plate.
std::map<int, long long> checked_cycles(const Campaign& campaign) {
  std::map<int, long long> count;
  for (std::size_t i = 0; i < campaign.cycles.size(); ++i) {
    const Cycle& cycle = campaign.cycles[i];
    const auto here = [&] { return place(campaign, campaign.cycles_source, i, cycle.plate); };
    if (!(cycle.energy > 0))
      throw InputError(fmt::format("{}, cycle {}: the energy is {} J; it must be positive", here(),
                                   cycle.number, cycle.energy));
    const bool same = i > 0 && campaign.cycles[i - 1].plate == cycle.plate;
    if (same && cycle.number <= campaign.cycles[i - 1].number)
      throw InputError(fmt::format("{}, cycle {} follows cycle {}; cycles must ascend", here(),
                                   cycle.number, campaign.cycles[i - 1].number));
    if (++count[cycle.plate] > 1 && !same)
      throw InputError(fmt::format("{}: its cycles are not consecutive", here()));
  }
  return count;
}

}  // namespace

void require_ordered_cycles(const Campaign& campaign) {
  checked_cycles(campaign);
}

WornBlocks worn_blocks(const Campaign& campaign) {
  const auto& cycles = campaign.cycles;
  std::map<int, long long> unweighed = checked_cycles(campaign);
  WornBlocks result;
  std::set<int> seen;
  std::size_t next = 0;  // cycle
  double energy_before = 0;
  for (std::size_t i = 0; i < campaign.weighings.size(); ++i) {
    const Weighing& after = campaign.weighings[i];
    const std::string here = place(campaign, campaign.weighings_source, i, after.plate);
    if (i == 0 || campaign.weighings[i - 1].plate != after.plate) {
      if (!seen.insert(after.plate).second)
        throw InputError(fmt::format("{}: its weighings are not consecutive", here));
      if (after.block != Block::start)
        throw InputError(fmt::format("{}: its first weighing must be that of block 'start'", here));
      if (after.cycle != 0)
        throw InputError(
            fmt::format("{} starts at cycle {}; it must be new, at cycle 0", here, after.cycle));
      next = 0;
      while (next < cycles.size() && cycles[next].plate != after.plate) ++next;
      energy_before = 0;
      continue;
    }
    const Weighing& before = campaign.weighings[i - 1];
    if (after.cycle == before.cycle)
      throw InputError(fmt::format("{} is weighed twice at cycle {}", here, after.cycle));
    if (after.cycle < before.cycle)
      throw InputError(fmt::format("{}: the weighing at cycle {} follows that at cycle {}", here,
                                   after.cycle, before.cycle));
    if (after.block == Block::start)
      throw InputError(fmt::format("{} starts twice, again at cycle {}", here, after.cycle));
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
      throw InputError(
          fmt::format("{}: {} cycles are logged between the weighings at {} and {}, but {} ran{}",
                      here, block.cycles(), before.cycle, after.cycle, after.cycle - before.cycle,
                      block.cycles() < static_cast<double>(after.cycle - before.cycle)
                          ? "; if a log loses some cycles, data.missing_cycles = \"fill\" says so"
                          : ""));
    for (const Input& input : inputs) block.mean.*input.value /= block.cycles();
    const double loss = before.mass - after.mass;
    const double error = std::numbers::sqrt2 * campaign.balance_sd;
    const auto gain = [&] {
      return fmt::format("{} gained {:.4g} mg between cycles {} and {}", here, -loss * 1e6,
                         before.cycle, after.cycle);
    };
    if (loss < -most_gain * error)
      throw InputError(fmt::format("{}: more than {:.0f} standard deviations of the balance",
                                   gain(), most_gain));
    if (loss < 0) result.flags.push_back(gain() + ", within the error of the balance");
    block.volume = loss / campaign.density;
    block.w = block.volume / block.energy;
    block.balance_sd = error / (campaign.density * block.energy);
    energy_before += block.energy;
    unweighed[after.plate] -= after.cycle - before.cycle;
    result.blocks.push_back(std::move(block));
  }
  for (const auto& [plate, count] : unweighed) {
    if (count > 0)
      result.flags.push_back(fmt::format("{}: no weighing of plate {} follows {} of its cycles",
                                         campaign.cycles_source, campaign.plate_name(plate),
                                         count));
  }
  return result;
}

std::vector<std::string> off_design(const Campaign& campaign,
                                    const std::vector<WornBlock>& blocks) {
  std::map<int, const DesignPoint*> points;
  for (const DesignPoint& point : campaign.design) points[point.number] = &point;
  std::vector<std::string> found;
  for (const Input& input : inputs) {
    const bool celsius = input.value == &OperatingPoint::temperature;
    double worst = most_off_design;
    std::string sentence;
    for (const WornBlock& block : blocks) {
      const auto point = points.find(block.point);
      if (block.block != Block::point || point == points.end()) continue;
      const double designed = point->second->at.*input.value, ran = block.mean.*input.value;
      const double off = std::abs(ran - designed) / std::abs(designed + (celsius ? 273.15 : 0));
      if (!(off > worst)) continue;
      worst = off;
      sentence =
          fmt::format("{} of point {} is {:.4g} {} in the design, and its cycles ran at {:.4g}",
                      input.name, block.point, designed, celsius ? "degC" : input.si, ran);
    }
    if (!sentence.empty()) found.push_back(sentence);
  }
  return found;
}

}  // namespace wearwell::clutch
