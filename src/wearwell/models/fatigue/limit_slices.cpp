#include "wearwell/models/fatigue/limit_slices.h"

#include <algorithm>
#include <cmath>

namespace wearwell::fatigue {
namespace {

constexpr std::size_t limit_slices = 40;
constexpr double negligible_share = 1e-9;
constexpr double golden_shift = 0.6180339887498949;  // its multiples are the most even modulo 1

// With a limit that is subtracted from the stress, slices as in each_life.
std::vector<LimitSlice> even_slices(StandardDistribution limit, std::size_t index) {
  const double first = quantile(limit, negligible_share);
  const double width = (quantile(limit, 1 - negligible_share) - first) / limit_slices;
  double whole = 0;
  const double shift = std::modf((static_cast<double>(index) + 0.5) * golden_shift, &whole);
  std::vector<LimitSlice> slices;
  double below = 0;
  for (std::size_t k = 0; k <= limit_slices; ++k) {
    const double until = first + (static_cast<double>(k) + shift) * width;
    const double through = k == limit_slices ? 1 : cdf(limit, until);
    slices.push_back({through - below, until - 0.5 * width});
    below = through;
  }
  return slices;
}

// Where the limit only decides whether a stress does damage: between the stresses nothing changes.
std::vector<LimitSlice> slices_between(const SnLaw& law, const double* x,
                                       std::span<const double> log10_reversed) {
  std::vector<double> edges;
  for (const double each : log10_reversed)
    if (std::isfinite(each)) edges.push_back(law.limit_place(x, each));
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  if (edges.empty()) return {{1, 0}};
  std::vector<LimitSlice> slices = {{cdf(*law.limit, edges.front()), edges.front() - 1}};
  for (std::size_t k = 1; k < edges.size(); ++k)
    slices.push_back({cdf(*law.limit, edges[k]) - cdf(*law.limit, edges[k - 1]),
                      0.5 * (edges[k - 1] + edges[k])});
  slices.push_back({1 - cdf(*law.limit, edges.back()), edges.back() + 1});
  return slices;
}

}  // namespace

std::vector<LimitSlice> slices_of_limits(const SnLaw& law, const double* x,
                                         std::span<const double> log10_reversed,
                                         std::size_t index) {
  return law.integrated() ? even_slices(*law.limit, index) : slices_between(law, x, log10_reversed);
}

}  // namespace wearwell::fatigue
