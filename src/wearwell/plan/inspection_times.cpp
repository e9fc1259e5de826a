#include "wearwell/plan/inspection_times.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wearwell::plan {
namespace {

constexpr double rounding = 1e-9;
// More inspections than anybody makes: a sign of a bound that is too small for the horizon.
constexpr std::size_t most_inspections = 100'000;

// Before the first inspection nothing is known but the present.
struct SinceInspection {
  double at = 0, reached = 0;
};

SinceInspection inspected(const LifeAhead& life, double time) {
  return {time, life.reached(time)};
}

double allowed(const SinceInspection& last, double risk) {
  return 1 - (1 - risk) * (1 - last.reached);
}

bool keeps(const LifeAhead& life, const SinceInspection& last, double time, double risk) {
  return life.reached(time) <= allowed(last, risk) + 1e-12;
}

// The latest time of the bound; NaN if there is none after the last inspection.
double latest_after(const LifeAhead& life, const SinceInspection& last, bool first,
                    const InspectionBounds& bounds) {
  const double p = allowed(last, bounds.risk);
  if (first && life.passed() > p) return 0;
  double time = life.latest(p);
  if (bounds.step > 0 && std::isfinite(time))
    time = bounds.step * std::floor(time / bounds.step * (1 + rounding));
  return time > last.at || (first && time == 0 && life.passed() > 0) ? time : std::nan("");
}

}  // namespace

InspectionTimes fewest_inspections(const LifeAhead& life, const InspectionBounds& bounds) {
  const Visits visits = fewest_visits({&life, 1}, {&bounds, 1});
  return {visits.of_unit[0], visits.visits.stuck};
}

Visits fewest_visits(std::span<const LifeAhead> units, std::span<const InspectionBounds> bounds) {
  constexpr double never = std::numeric_limits<double>::infinity();
  Visits plan;
  plan.of_unit.resize(units.size());
  std::vector<double>& times = plan.visits.times;
  while (times.size() < most_inspections) {
    const bool first = times.empty();
    double next = never;
    for (std::size_t u = 0; u < units.size(); ++u) {
      const SinceInspection last = first ? SinceInspection{} : inspected(units[u], times.back());
      if ((!first && bounds[u].until <= last.at) ||
          keeps(units[u], last, bounds[u].until, bounds[u].risk))
        continue;
      const double latest = latest_after(units[u], last, first, bounds[u]);
      if (std::isnan(latest)) {
        plan.visits.stuck = last.at;
        plan.stuck_unit = u;
        return plan;
      }
      next = std::min(next, latest);
    }
    if (!std::isfinite(next)) break;
    times.push_back(next);
  }
  if (times.size() == most_inspections) plan.visits.stuck = times.back();
  for (std::size_t u = 0; u < units.size(); ++u) {
    SinceInspection last;
    for (std::size_t k = 0; k < times.size(); ++k) {
      if (times[k] >= bounds[u].until) break;
      if (keeps(units[u], last, bounds[u].until, bounds[u].risk)) break;
      const double beyond = k + 1 < times.size() ? times[k + 1] : bounds[u].until;
      if (keeps(units[u], last, std::min(beyond, bounds[u].until), bounds[u].risk)) continue;
      plan.of_unit[u].push_back(times[k]);
      last = inspected(units[u], times[k]);
    }
  }
  return plan;
}

std::vector<double> risks_between(const LifeAhead& life, std::span<const double> times,
                                  double until) {
  std::vector<double> risks;
  SinceInspection last;
  const auto add = [&](double time) {
    const double alive = 1 - last.reached;
    risks.push_back(alive > 0 ? (life.reached(time) - last.reached) / alive : 0);
    last = inspected(life, time);
  };
  for (const double each : times) add(each);
  add(until);
  return risks;
}

double unforeseen(const LifeAhead& life, std::span<const double> times, double until,
                  double warning) {
  double sum = 0, foreseen = 0;
  const auto add = [&](double time) {
    sum += std::max(0.0, life.reached(time) - foreseen);
    foreseen = life.reached(std::min(time + warning, until));
  };
  for (const double each : times) add(each);
  add(until);
  return sum;
}

InspectionTimes fewest_for_total(const LifeAhead& life, const InspectionBounds& bounds,
                                 double total, double warning, std::span<const double> candidates) {
  constexpr double impossible = std::numeric_limits<double>::infinity();
  const std::size_t n = candidates.size();
  std::vector<double> reached(n), shown(n);
  for (std::size_t i = 0; i < n; ++i) {
    reached[i] = life.reached(candidates[i]);
    shown[i] = life.reached(std::min(candidates[i] + warning, bounds.until));
  }
  const double end = life.reached(bounds.until);
  const auto kept = [&](double from, double to) {
    return to <= 1 - (1 - bounds.risk) * (1 - from) + 1e-12;
  };
  if (end <= total && kept(0, end)) return {};
  // Least unforeseen share of a plan with so many inspections that ends with one at candidate i.
  std::vector<double> least(n);
  std::vector<std::vector<std::size_t>> before;
  for (std::size_t i = 0; i < n; ++i) least[i] = kept(0, reached[i]) ? reached[i] : impossible;
  before.emplace_back(n, n);
  for (std::size_t count = 1; count <= n; ++count) {
    std::size_t best = n;
    double value = impossible;
    for (std::size_t i = 0; i < n; ++i) {
      const double whole =
          kept(reached[i], end) ? least[i] + std::max(0.0, end - shown[i]) : impossible;
      if (whole < value) value = whole, best = i;
    }
    if (value <= total) {
      InspectionTimes plan;
      for (std::size_t k = count; k-- > 0; best = before[k][best])
        plan.times.push_back(candidates[best]);
      std::reverse(plan.times.begin(), plan.times.end());
      return plan;
    }
    std::vector<double> next(n, impossible);
    before.emplace_back(n, n);
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t i = 0; i < j; ++i) {
        const double whole = least[i] + std::max(0.0, reached[j] - std::min(shown[i], reached[j]));
        if (whole < next[j] && kept(reached[i], reached[j])) next[j] = whole, before[count][j] = i;
      }
    }
    least = std::move(next);
  }
  return {{}, bounds.until};
}

std::vector<double> candidate_times(const LifeAhead& life, const InspectionBounds& bounds,
                                    std::size_t count) {
  std::vector<double> times;
  if (life.passed() > 0) times.push_back(0);
  if (bounds.step > 0) {
    for (std::size_t k = 1; static_cast<double>(k) * bounds.step < bounds.until * (1 - rounding);
         ++k)
      times.push_back(static_cast<double>(k) * bounds.step);
    return times;
  }
  const double end = life.reached(bounds.until);
  for (std::size_t i = 1; i < count; i += 2) {
    const double share = static_cast<double>(i) / static_cast<double>(count);
    times.push_back(share * bounds.until);
    times.push_back(life.latest(life.passed() + share * (end - life.passed())));
  }
  std::sort(times.begin(), times.end());
  std::erase_if(times, [&](double x) { return !(x >= 0) || x >= bounds.until; });
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

}  // namespace wearwell::plan
