#include "wearwell/models/joint/work_history.h"

#include <algorithm>
#include <cmath>

namespace wearwell::joint {

WorkHistory::WorkHistory(const std::vector<double>& cycles, const std::vector<double>& work,
                         std::optional<double> rate)
    : rate_(rate.value_or(0)) {
  points_.push_back({0, 0});
  for (std::size_t i = 0; i < cycles.size(); ++i) points_.push_back({cycles[i], work[i]});
  std::stable_sort(points_.begin(), points_.end(),
                   [](const Point& a, const Point& b) { return a.cycles < b.cycles; });
}

double WorkHistory::work_at(double cycles) const {
  const auto after = std::find_if(points_.begin(), points_.end(),
                                  [&](const Point& p) { return p.cycles > cycles; });
  const Point& before = after == points_.begin() ? points_.front() : *(after - 1);
  if (after == points_.end()) {
    return rate_ > 0 ? before.work + (cycles - before.cycles) * rate_ : before.work;
  }
  return std::lerp(before.work, after->work,
                   (cycles - before.cycles) / (after->cycles - before.cycles));
}

double WorkHistory::cycles_at(double work) const {
  if (work <= 0) return 0;
  for (std::size_t i = 1; i < points_.size(); ++i) {
    const Point &a = points_[i - 1], &b = points_[i];
    if (work > b.work) continue;
    return work <= a.work ? a.cycles
                          : std::lerp(a.cycles, b.cycles, (work - a.work) / (b.work - a.work));
  }
  const Point& last = points_.back();
  if (work <= last.work) return last.cycles;
  return rate_ > 0 ? last.cycles + (work - last.work) / rate_ : INFINITY;
}

}  // namespace wearwell::joint
