#include "wearwell/predict/cell_mixture.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wearwell {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

void CellMixture::add(double weight, double a, double b) {
  if (weight > 0) cells_.push_back({weight, std::min(a, b), std::max(a, b)});
}

void CellMixture::add(const CellMixture& other) {
  cells_.insert(cells_.end(), other.cells_.begin(), other.cells_.end());
}

double CellMixture::add_beyond(double weight, double a, double b, double x) {
  const double low = std::min(a, b), high = std::max(a, b);
  if (low >= x || high == infinity || std::isnan(a) || std::isnan(b)) {
    add(weight, low - x, high - x);
    return weight;
  }
  if (!(high > x)) return 0;
  const double rest = weight * (high - x) / (high - low);
  add(rest, 0, high - x);
  return rest;
}

CellMixture CellMixture::beyond(double x) const {
  CellMixture rest;
  for (const Cell& cell : cells_) rest.add_beyond(cell.weight, cell.low, cell.high, x);
  return rest;
}

double CellMixture::mass() const {
  double sum = 0;
  for (const Cell& cell : cells_) sum += cell.weight;
  return sum;
}

double CellMixture::cdf(double x) const {
  double below = 0, all = 0;
  for (const Cell& cell : cells_) {
    all += cell.weight;
    if (std::isnan(cell.low) || std::isnan(cell.high)) return std::nan("");
    if (cell.high == infinity) continue;
    if (x >= cell.high) {
      below += cell.weight;
    } else if (x > cell.low) {
      below += cell.weight * (x - cell.low) / (cell.high - cell.low);
    }
  }
  return below / all;
}

double CellMixture::quantile(double p) const {
  double low = infinity, high = -infinity, all = 0, ended = 0;
  std::vector<Cell> open;  // those that the search still may cut
  for (const Cell& cell : cells_) {
    if (std::isnan(cell.low) || std::isnan(cell.high)) return std::nan("");
    all += cell.weight;
    if (cell.high == infinity) continue;
    ended += cell.weight;
    low = std::min(low, cell.low);
    high = std::max(high, cell.high);
    open.push_back(cell);
  }
  const double wanted = p * all;
  if (!(ended > wanted)) return infinity;
  double below = 0;  // the weight of cells below all that is left
  for (int step = 0; step < 200 && high - low > 1e-13 * std::abs(high); ++step) {
    // By the geometric mean where lives differ by orders of magnitude.
    const double middle = low > 0 && high > 4 * low ? std::sqrt(low * high) : 0.5 * (low + high);
    if (!(middle > low && middle < high)) break;
    double sum = below;
    for (const Cell& cell : open) {
      if (middle >= cell.high) {
        sum += cell.weight;
      } else if (middle > cell.low) {
        sum += cell.weight * (middle - cell.low) / (cell.high - cell.low);
      }
    }
    if (sum < wanted) {
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
