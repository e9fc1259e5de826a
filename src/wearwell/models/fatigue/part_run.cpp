#include "wearwell/models/fatigue/part_run.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace wearwell::fatigue {

bool is_same_stress(const Stress& a, const Stress& b) {
  constexpr double same = 1e-6;
  const double size = std::max(std::abs(a.alternating), std::abs(b.alternating));
  return std::abs(a.alternating - b.alternating) <= same * size &&
         std::abs(a.mean - b.mean) <= same * size;
}

void PartRun::add(double until, const Stress& stress) {
  last = stress;
  if (!(until > now)) return;
  const auto at = std::find_if(cycles.begin(), cycles.end(), [&](const LoadCycle& each) {
    return is_same_stress(each.stress, stress);
  });
  if (at != cycles.end()) {
    at->count += until - now;
    last = at->stress;
  } else {
    const auto before = [](const LoadCycle& a, const LoadCycle& b) {
      return std::pair(a.stress.alternating, a.stress.mean) <
             std::pair(b.stress.alternating, b.stress.mean);
    };
    const LoadCycle added{stress, until - now};
    cycles.insert(std::upper_bound(cycles.begin(), cycles.end(), added, before), added);
  }
  now = until;
  // Without the rounding of sums: one stress is the same however its cycles were read.
  if (cycles.size() == 1) cycles.front().count = now;
}

bool PartRun::is_under(const Stress& stress) const {
  return cycles.empty() || (cycles.size() == 1 && is_same_stress(cycles.front().stress, stress));
}

namespace {

void sort_along_life(std::vector<RunReading>& readings) {
  std::stable_sort(readings.begin(), readings.end(),
                   [](const RunReading& a, const RunReading& b) { return a.cycles < b.cycles; });
}

}  // namespace

std::optional<Stress> stress_until(const PartRun& begun, std::vector<RunReading> readings,
                                   double cycles) {
  sort_along_life(readings);
  std::optional<Stress> last = begun.last, found;
  for (const RunReading& each : readings) {
    if (each.cycles > cycles) break;
    if (each.stress) last = each.stress;
    if (each.cycles == cycles && !found) found = last;
  }
  return found;
}

PartRun run_after(PartRun begun, std::vector<RunReading> readings) {
  sort_along_life(readings);
  bool any = begun.now > 0;
  for (const RunReading& each : readings) {
    const std::optional<Stress> stress = each.stress ? each.stress : begun.last;
    if (!stress || each.cycles < begun.now || (any && each.cycles == begun.now)) continue;
    begun.add(each.cycles, *stress);
    any = true;
  }
  return begun;
}

}  // namespace wearwell::fatigue
