#include "wearwell/prob/plotting_positions.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "wearwell/math/constants.h"

namespace wearwell {
namespace {

std::vector<PlottingPosition> by_kaplan_meier(std::span<const Response> responses,
                                              std::span<const int> counts) {
  std::map<double, double> failures;
  for (std::size_t i = 0; i < responses.size(); ++i) {
    if (responses[i].seen == Censoring::none) failures[responses[i].at] += counts[i];
  }
  std::vector<PlottingPosition> all;
  double survival = 1;
  for (const auto& [at, failed] : failures) {
    double at_risk = 0;
    for (std::size_t i = 0; i < responses.size(); ++i) {
      if (responses[i].at >= at && responses[i].entry < at) at_risk += counts[i];
    }
    const double before = survival;
    survival *= 1 - failed / at_risk;
    all.push_back({at, 1 - 0.5 * (before + survival)});
  }
  return all;
}

// An observation in (from, to], or at one value.
struct Known {
  double from, to, count;
};

// The intervals that can have mass: from a left end to a right end with no other end between.
std::vector<Known> innermost(const std::vector<Known>& all) {
  struct End {
    double at;
    int order;  // order at one value: an inclusive left end, a right end, an exclusive left end
  };
  std::vector<End> ends;
  for (const Known& each : all) {
    ends.push_back({each.from, each.from == each.to ? 0 : 2});
    ends.push_back({each.to, 1});
  }
  std::sort(ends.begin(), ends.end(), [](const End& a, const End& b) {
    return a.at < b.at || (a.at == b.at && a.order < b.order);
  });
  std::vector<Known> result;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    if (ends[i].order != 1 && ends[i + 1].order == 1)
      result.push_back({ends[i].at, ends[i + 1].at, 0});
  }
  return result;
}

bool within(const Known& inner, const Known& outer) {
  if (outer.from == outer.to) return inner.from == outer.from && inner.to == outer.to;
  return inner.from >= outer.from && inner.to <= outer.to &&
         !(inner.from == inner.to && inner.from == outer.from);
}

// Turnbull's self-consistency: distributes each observation by the current estimate until it
// converges.
std::vector<PlottingPosition> by_turnbull(const std::vector<Known>& all) {
  constexpr int most_rounds = 5000;
  constexpr double still = 1e-10;
  const std::vector<Known> cells = innermost(all);
  std::vector<double> share(cells.size(), 1 / static_cast<double>(cells.size()));
  double number = 0;
  std::vector<std::vector<std::size_t>> held;
  for (const Known& each : all) {
    number += each.count;
    held.emplace_back();
    for (std::size_t c = 0; c < cells.size(); ++c) {
      if (within(cells[c], each)) held.back().push_back(c);
    }
  }
  for (int round = 0; round < most_rounds; ++round) {
    std::vector<double> next(cells.size(), 0);
    for (std::size_t i = 0; i < all.size(); ++i) {
      double sum = 0;
      for (const std::size_t c : held[i]) sum += share[c];
      for (const std::size_t c : held[i]) next[c] += all[i].count * share[c] / sum / number;
    }
    double moved = 0;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      moved = std::max(moved, std::abs(next[c] - share[c]));
    }
    share = std::move(next);
    if (moved < still) break;
  }
  std::vector<PlottingPosition> result;
  double below = 0;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    below += share[c];
    if (share[c] > 1e-6 && cells[c].to < infinity && below < 1 - 1e-9) {
      result.push_back({cells[c].to, below});
    }
  }
  return result;
}

}  // namespace

std::vector<PlottingPosition> plotting_positions(std::span<const Response> responses,
                                                 std::span<const int> counts) {
  bool entries = false, intervals = false;
  std::map<std::pair<double, double>, double> alike;
  for (std::size_t i = 0; i < responses.size(); ++i) {
    const Response& y = responses[i];
    entries |= y.entry > -infinity;
    intervals |= y.seen == Censoring::left || y.seen == Censoring::interval;
    const double from = y.seen == Censoring::left ? -infinity : y.at;
    const double to = y.seen == Censoring::right      ? infinity
                      : y.seen == Censoring::interval ? y.until
                                                      : y.at;
    alike[{from, to}] += counts[i];
  }
  if (!intervals) return by_kaplan_meier(responses, counts);
  if (entries) return {};
  std::vector<Known> all;
  for (const auto& [ends, count] : alike) all.push_back({ends.first, ends.second, count});
  return by_turnbull(all);
}

}  // namespace wearwell
