#include "wearwell/predict/cell_mixture.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "wearwell/base/stop_scope.h"
#include "wearwell/math/constants.h"

namespace wearwell {
namespace {

// The integral of a density between node i and the next, from the polynomial through six equally
// spaced nodes.
double between(std::span<const double> share, std::size_t i) {
  const auto at = [&](std::size_t k) {  // index 0 is two nodes before i; zero beyond the ends
    return i + k >= 2 && i + k - 2 < share.size() ? share[i + k - 2] : 0;
  };
  const double mass = (11 * (at(0) + at(5)) - 93 * (at(1) + at(4)) + 802 * (at(2) + at(3))) / 1440;
  return std::max(mass, 0.0);
}

// The derivative at equally spaced nodes by the step, of fourth order where neighbours exist; uses
// only nodes from `first` to `last`.
double derivative(std::span<const double> value, std::size_t i, std::size_t first,
                  std::size_t last) {
  const auto y = [&](std::size_t k) { return value[k]; };
  if (i >= first + 2 && i + 2 <= last) {
    return (y(i - 2) - 8 * y(i - 1) + 8 * y(i + 1) - y(i + 2)) / 12;
  }
  if (i >= first + 1 && i + 1 <= last) return 0.5 * (y(i + 1) - y(i - 1));
  if (i + 2 <= last) return -1.5 * y(i) + 2 * y(i + 1) - 0.5 * y(i + 2);
  if (i >= first + 2) return 1.5 * y(i) - 2 * y(i - 1) + 0.5 * y(i - 2);
  return i + 1 <= last ? y(i + 1) - y(i) : y(i) - y(i - 1);
}

// A probable bracket of the quantile, from a sample of the cells. Not used for few cells.
template <class Cells>
std::pair<double, double> about(const Cells& cells, double share) {
  constexpr std::size_t some = 1024;
  constexpr double margin = 0.06;  // three standard deviations of a proportion of the sample size
  if (cells.size() < 8 * some) return {-infinity, infinity};
  std::vector<std::pair<double, double>> sample;
  double all = 0;
  for (std::size_t k = 0; k < some; ++k) {
    const auto& cell = cells[k * 0x9E3779B97F4A7C15ULL % cells.size()];
    sample.emplace_back(cell.high == infinity ? infinity : 0.5 * cell.low + 0.5 * cell.high,
                        cell.weight);
    all += cell.weight;
  }
  std::sort(sample.begin(), sample.end());
  std::pair<double, double> found = {-infinity, infinity};
  double sum = 0;
  for (const auto& [middle, weight] : sample) {
    sum += weight;
    if (sum <= (share - margin) * all) found.first = middle;
    if (sum < (share + margin) * all) continue;
    found.second = middle;
    break;
  }
  return found;
}

}  // namespace

void CellMixture::add(double weight, double a, double b) {
  if (weight > 0)
    cells_.push_back({.weight = weight, .low = std::min(a, b), .high = std::max(a, b)});
}

void CellMixture::add(const CellMixture& other) {
  cells_.insert(cells_.end(), other.cells_.begin(), other.cells_.end());
}

void CellMixture::add(const QuantityDistribution& other) {
  const std::size_t before = cells_.size();
  other.visit([this](double weight, double center, double half_width) {
    add(weight, center - half_width, center + half_width);
  });
  if (cells_.size() == before) add(1, std::nan(""), std::nan(""));
}

double CellMixture::add_curve(double weight, std::span<const double> share,
                              std::span<const double> value, double from) {
  const std::size_t n = share.size();
  if (n == 0) return 0;
  if (n == 1) {
    const double w = weight * share[0];
    if (std::isnan(value[0]) || value[0] > from) {
      add(w, value[0], value[0]);
      return w;
    }
    return 0;
  }
  double all = 0, inside = 0, beyond = 0;
  for (std::size_t i = 0; i < n; ++i) all += share[i];
  for (std::size_t i = 0; i + 1 < n; ++i) inside += between(share, i);
  const double scale = weight * all / inside;
  // Follows the curve where numbers are finite.
  std::size_t first = 0, last = n - 1;
  while (first < last && !std::isfinite(value[first])) ++first;
  while (last > first && !std::isfinite(value[last])) --last;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    Cell cell{scale * between(share, i), std::min(value[i], value[i + 1]),
              std::max(value[i], value[i + 1])};
    if (!(cell.weight > 0)) continue;
    const double length = value[i + 1] - value[i];
    if (std::isnan(length) && !(std::isinf(value[i]) && std::isinf(value[i + 1]))) {
      add(cell.weight, value[i], value[i + 1]);
      beyond += cell.weight;
      continue;
    }
    if (!(cell.high > from)) continue;
    if (i >= first && i + 1 <= last && length != 0) {
      constexpr double most = 3;  // keeps the cubic monotone
      const double mean = cell.weight / scale;
      double ends[] = {share[i] * length / (mean * derivative(value, i, first, last)),
                       share[i + 1] * length / (mean * derivative(value, i + 1, first, last))};
      for (double& end : ends) end = end >= 0 ? std::min(end, most) : 1;
      if (length < 0) std::swap(ends[0], ends[1]);
      cell.at_low = static_cast<float>(ends[0]);
      cell.at_high = static_cast<float>(ends[1]);
    }
    if (cell.low < from && !cell.cut(from)) continue;
    beyond += cell.weight;
    cells_.push_back(cell);
  }
  return beyond;
}

void CellMixture::add_curve(double weight, std::span<const double> share,
                            std::span<const double> value) {
  add_curve(weight, share, value, -infinity);
}

double CellMixture::Cell::below(double x) const {
  const double u = (x - low) / (high - low);
  const double a = at_low, b = at_high;
  return weight * u * (a * (1 - u) * (1 - u) + u * (3 - 2 * u) - b * u * (1 - u));
}

// Deflates the cubic.
bool CellMixture::Cell::cut(double from) {
  if (!std::isfinite(high)) return true;
  const double u = (from - low) / (high - low), a = at_low, b = at_high;
  const double rest = 1 - below(from) / weight;
  const double density = a * (1 - u) * (1 - 3 * u) + 6 * u * (1 - u) + b * u * (3 * u - 2);
  if (!(rest > 0)) return false;
  weight *= rest;
  low = from;
  at_low = static_cast<float>(density * (1 - u) / rest);
  at_high = static_cast<float>(b * (1 - u) / rest);
  return true;
}

double CellMixture::mean() const {
  double sum = 0, all = 0;
  for (const Cell& cell : cells_) {
    if (std::isnan(cell.low) || std::isnan(cell.high)) return std::nan("");
    // The integral of the cubic cdf of a cell is 1/2 + (at_low - at_high)/12.
    const double place = 0.5 - (static_cast<double>(cell.at_low) - cell.at_high) / 12;
    sum +=
        cell.weight * (std::isfinite(cell.high) ? std::lerp(cell.low, cell.high, place) : infinity);
    all += cell.weight;
  }
  return sum / all;
}

CellMixture CellMixture::beyond(double x) const {
  CellMixture rest;
  for (Cell cell : cells_) {
    if (cell.high <= x || (cell.low < x && !cell.cut(x))) continue;
    cell.low -= x;
    cell.high -= x;
    rest.cells_.push_back(cell);
  }
  return rest;
}

double CellMixture::mass() const {
  double sum = 0;
  for (const Cell& cell : cells_) sum += cell.weight;
  return sum;
}

double CellMixture::cdf(double x) const {
  check_stop();
  double below = 0, all = 0;
  for (const Cell& cell : cells_) {
    all += cell.weight;
    if (std::isnan(cell.low) || std::isnan(cell.high)) return std::nan("");
    if (cell.high == infinity) continue;
    if (x >= cell.high) {
      below += cell.weight;
    } else if (x > cell.low) {
      below += cell.below(x);
    }
  }
  return below / all;
}

double CellMixture::quantile(double p) const {
  double low = infinity, high = -infinity, all = 0, ended = 0;
  for (const Cell& cell : cells_) {
    if (std::isnan(cell.low) || std::isnan(cell.high)) return std::nan("");
    all += cell.weight;
    if (cell.high == infinity) continue;
    ended += cell.weight;
    low = std::min(low, cell.low);
    high = std::max(high, cell.high);
  }
  const double wanted = p * all;
  if (!(ended > wanted)) return infinity;
  const auto weight_below = [](std::span<const Cell> cells, double x) {
    double sum = 0;
    for (const Cell& cell : cells) {
      if (x >= cell.high) {
        sum += cell.weight;
      } else if (x > cell.low && cell.high < infinity) {
        sum += cell.below(x);
      }
    }
    return sum;
  };
  const auto [before, behind] = about(cells_, p);
  for (const double place : {before, behind}) {
    if (!(place > low && place < high)) continue;
    (weight_below(cells_, place) < wanted ? low : high) = place;
  }
  double below = 0;        // the weight of cells below the remaining ones
  std::vector<Cell> open;  // cells that the search may still cut
  for (const Cell& cell : cells_) {
    if (cell.high <= low) {
      below += cell.weight;
    } else if (cell.low < high && cell.high < infinity) {
      open.push_back(cell);
    }
  }
  for (int step = 0; step < 200 && high - low > 1e-13 * std::abs(high); ++step) {
    // Uses the geometric mean if lives span orders of magnitude.
    const double middle = low > 0 && high > 4 * low ? std::sqrt(low * high) : 0.5 * (low + high);
    if (!(middle > low && middle < high)) break;
    if (below + weight_below(open, middle) < wanted) {
      low = middle;
      for (const Cell& cell : open) below += cell.high <= middle ? cell.weight : 0;
      std::erase_if(open, [&](const Cell& cell) { return cell.high <= middle; });
    } else {
      high = middle;
      std::erase_if(open, [&](const Cell& cell) { return cell.low >= middle; });
    }
  }
  return 0.5 * (low + high);
}

}  // namespace wearwell
