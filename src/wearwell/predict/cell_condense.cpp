#include <algorithm>
#include <cmath>
#include <utility>

#include "wearwell/base/stop_scope.h"
#include "wearwell/math/constants.h"
#include "wearwell/predict/cell_mixture.h"

namespace wearwell {
namespace {

// Shares between 0 and 1, ascending: half of them evenly spaced, half with evenly spaced logits.
std::vector<double> shares_of_ends(std::size_t count) {
  const double last_logit = std::log(1e9);
  std::vector<double> shares;
  for (std::size_t k = 0; k < count / 2; ++k) {
    const double u = (static_cast<double>(k) + 0.5) / static_cast<double>(count / 2);
    shares.push_back(u);
    shares.push_back(1 / (1 + std::exp(last_logit * (1 - 2 * u))));
  }
  std::sort(shares.begin(), shares.end());
  return shares;
}

// Of points with weights, those where the weight up to them first reaches each share.
std::vector<double> ends_at(std::vector<std::pair<double, double>> points, double all,
                            const std::vector<double>& shares) {
  std::sort(points.begin(), points.end());
  std::vector<double> ends = {points.front().first};
  double sum = 0;
  auto share = shares.begin();
  for (const auto& [place, weight] : points) {
    sum += weight;
    if (share == shares.end() || sum < *share * all) continue;
    while (share != shares.end() && sum >= *share * all) ++share;
    if (place > ends.back()) ends.push_back(place);
  }
  if (points.back().first > ends.back()) ends.push_back(points.back().first);
  return ends;
}

// Ascending places, searched from a guess.
class Places {
 public:
  explicit Places(const std::vector<double>& all) : all_(all) {}

  // The index of the first place from x on; the last is at least x.
  std::size_t first_from(double x, std::size_t guess) const {
    constexpr int most_steps = 6;
    guess = std::min(guess, all_.size() - 1);
    for (int step = 0; step < most_steps; ++step) {
      if (all_[guess] < x) {
        ++guess;
      } else if (guess > 0 && !(all_[guess - 1] < x)) {
        --guess;
      } else {
        return guess;
      }
    }
    return static_cast<std::size_t>(std::lower_bound(all_.begin(), all_.end(), x) - all_.begin());
  }

 private:
  const std::vector<double>& all_;
};

// Of a cell from `low` on: its weight up to each of these places within it, and its density there.
struct Cubic {
  double weight, at_low, at_high;
};
void add_cubic(const Cubic& cell, double low, double length, std::span<const double> places,
               double* __restrict up_to, double* __restrict density) {
  const double weight = cell.weight, a = cell.at_low, b = cell.at_high;
  const double square = 3 - 2 * a - b, cube = a + b - 2, scale = 1 / length;
  const double* __restrict at = places.data();
  for (std::size_t k = 0; k < places.size(); ++k) {
    const double u = (at[k] - low) * scale;
    up_to[k] += weight * u * (a + u * (square + u * cube));
    density[k] += weight * scale * (a + u * (2 * square + u * 3 * cube));
  }
}

// Takes away the weights of large points, which stay points, and of those at the first end.
std::vector<double> take_large(std::vector<double>& at, double largest) {
  std::vector<double> large(at.size());
  for (std::size_t k = 0; k < at.size(); ++k) {
    if (k == 0 || at[k] > largest) std::swap(large[k], at[k]);
  }
  return large;
}

// Many small points stand for a density: those at an end count half on either side (at the last end before it), and all give
// the density at each end by the weight about it.
void spread(const std::vector<double>& ends, const std::vector<double>& at,
            std::vector<double>& inside, std::vector<double>& density) {
  const std::size_t n = ends.size();
  for (std::size_t k = 1; k < n; ++k) {
    const double share = k + 1 < n ? 0.5 : 1;
    inside[k] += share * at[k];
    if (k + 1 < n) inside[k + 1] += share * at[k];
  }
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t from = k > 0 ? k - 1 : k, to = std::min(k + 1, n - 1);
    double weight = 0;
    for (std::size_t i = from + 1; i <= to; ++i) weight += inside[i];
    if (weight > 0) density[k] += weight / (ends[to] - ends[from]);
  }
}

}  // namespace

void CellMixture::condense(std::size_t most) {
  if (cells_.size() <= most + 2) return;
  double never = 0, ended = 0, lowest = infinity, highest = -infinity;
  std::vector<std::pair<double, double>> points;
  points.reserve(cells_.size() + 2);
  for (const Cell& cell : cells_) {
    if (std::isnan(cell.low) || std::isnan(cell.high) || cell.low == -infinity) return;
    if (cell.high == infinity) {
      never += cell.weight;
      continue;
    }
    ended += cell.weight;
    points.emplace_back(0.5 * cell.low + 0.5 * cell.high, cell.weight);
    lowest = std::min(lowest, cell.low);
    highest = std::max(highest, cell.high);
  }
  std::vector<Cell> few;
  if (never > 0) few.push_back({.weight = never, .low = infinity, .high = infinity});
  if (points.empty()) {
    cells_ = std::move(few);
    return;
  }
  points.emplace_back(lowest, 0);
  points.emplace_back(highest, 0);
  const std::vector<double> ends = ends_at(std::move(points), ended, shares_of_ends(most - 1));
  // Weight up to each end and density there, of cells that reach beyond it; weight of the cells that
  // end there; densities of cells that only begin (right) or end (left) there. Of points: the weight
  // at each end, and between it and the end before.
  const std::size_t n = ends.size();
  std::vector<double> up_to(n), density(n), ended_here(n), left(n), right(n), at(n), inside(n);
  // Cells that follow each other are often neighbours of about equal length.
  const Places places(ends);
  std::size_t near = 0, across = 0;
  for (const Cell& cell : cells_) {
    check_stop();
    if (cell.high == infinity) continue;
    std::size_t k = places.first_from(cell.low, near);
    const double length = cell.high - cell.low, a = cell.at_low, b = cell.at_high;
    if (!(length > 0)) {
      (ends[k] == cell.low ? at : inside)[k] += cell.weight;
      continue;
    }
    if (ends[k] == cell.low) right[k++] += cell.weight * a / length;
    const std::size_t past = places.first_from(cell.high, k + across);
    across = past - k;
    near = past;
    add_cubic({cell.weight, a, b}, cell.low, length, std::span(ends).subspan(k, past - k),
              up_to.data() + k, density.data() + k);
    k = past;
    if (ends[k] == cell.high) left[k] += cell.weight * b / length;
    ended_here[k] += cell.weight;
  }
  const std::vector<double> large = take_large(at, 4 * ended / static_cast<double>(most));
  for (std::size_t k = 0; k < n; ++k) {
    if (large[k] > 0) few.push_back({.weight = large[k], .low = ends[k], .high = ends[k]});
  }
  spread(ends, at, inside, density);
  double sum = 0;
  for (std::size_t k = 0; k < n; ++k) up_to[k] += sum += ended_here[k] + inside[k];
  for (std::size_t k = 0; k + 1 < n; ++k) {
    constexpr double most_relative = 3;  // keeps the cubic monotone
    Cell cell{.weight = up_to[k + 1] - up_to[k], .low = ends[k], .high = ends[k + 1]};
    if (!(cell.weight > 0)) continue;
    const double mean = cell.weight / (cell.high - cell.low);
    const auto relative = [&](double slope) {
      return static_cast<float>(std::clamp(slope / mean, 0.0, most_relative));
    };
    cell.at_low = relative(density[k] + right[k]);
    cell.at_high = relative(density[k + 1] + left[k + 1]);
    few.push_back(cell);
  }
  cells_ = std::move(few);
}

void CellMixture::limit_size(std::size_t most) {
  constexpr std::size_t few = 256;
  if (size() > most) condense(few);
}

}  // namespace wearwell
