#include "wearwell/models/clutch/missing_cycles.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "wearwell/base/error.h"
#include "wearwell/models/clutch/wear_points.h"

namespace wearwell::clutch {
namespace {

using Cycles = std::vector<Cycle>;

/// The cycles of one plate.
struct Span {
  Cycles::const_iterator first, last;
};

std::map<int, Span> by_plate(const Cycles& cycles) {
  std::map<int, Span> spans;
  for (auto first = cycles.begin(); first != cycles.end();) {
    const auto last = std::find_if(first, cycles.end(),
                                   [&](const Cycle& each) { return each.plate != first->plate; });
    spans[first->plate] = {first, last};
    first = last;
  }
  return spans;
}

/// The cycles between two weighings, including those that were not logged.
void add_block(Span logged, long long after, long long until, Cycles& out) {
  Cycle last = *logged.first;
  for (long long number = after + 1; number <= until; ++number) {
    if (logged.first != logged.last && logged.first->number == number) last = *logged.first++;
    last.number = number;
    out.push_back(last);
  }
}

}  // namespace

void fill_missing_cycles(Campaign& campaign) {
  require_ordered_cycles(campaign);
  const auto spans = by_plate(campaign.cycles);
  std::map<int, Cycles> filled;                            // up to the last weighing
  std::map<int, std::pair<long long, long long>> missing;  // number, by plate
  for (std::size_t i = 1; i < campaign.weighings.size(); ++i) {
    const Weighing &before = campaign.weighings[i - 1], &after = campaign.weighings[i];
    const auto span = spans.find(after.plate);
    const long long ran = after.cycle - before.cycle;
    if (before.plate != after.plate || ran <= 0 || span == spans.end()) continue;
    const auto behind = [](long long number, const Cycle& cycle) { return number < cycle.number; };
    const auto [all_first, all_last] = span->second;
    const Span logged{std::upper_bound(all_first, all_last, before.cycle, behind),
                      std::upper_bound(all_first, all_last, after.cycle, behind)};
    const long long count = logged.last - logged.first;
    const auto share = static_cast<double>(ran - count) / static_cast<double>(ran);
    if (count == 0 || share > most_missing)
      throw InputError(fmt::format(
          "{}, row {}: plate {}: {} of the {} cycles between the weighings at {} and {} are "
          "missing "
          "({:.3g} %); at most {:g} % can be filled in",
          campaign.weighings_source, i + 1, campaign.plate_name(after.plate), ran - count, ran,
          before.cycle, after.cycle, 100 * share, 100 * most_missing));
    add_block(logged, before.cycle, after.cycle, filled[after.plate]);
    missing[after.plate].first += ran - count;
    missing[after.plate].second += ran;
  }
  Cycles all;
  for (auto first = campaign.cycles.cbegin(); first != campaign.cycles.cend();) {
    const auto last = spans.at(first->plate).last;
    const Cycles& block = filled[first->plate];
    all.insert(all.end(), block.begin(), block.end());
    const long long until = block.empty() ? 0 : block.back().number;
    std::copy_if(first, last, std::back_inserter(all),
                 [&](const Cycle& cycle) { return cycle.number > until; });
    first = last;
  }
  campaign.cycles = std::move(all);
  for (const auto& [plate, counts] : missing) {
    const auto& [lost, ran] = counts;
    if (lost > 0)
      campaign.filled.push_back(
          fmt::format("plate {}: {} of {} cycles ({:.2g} %) were not logged; each counts as a copy "
                      "of the previous cycle",
                      campaign.plate_name(plate), lost, ran,
                      100 * static_cast<double>(lost) / static_cast<double>(ran)));
  }
}

}  // namespace wearwell::clutch
