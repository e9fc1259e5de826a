#include "wearwell/bayes/weighted_draws.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "wearwell/bayes/cell_shares.h"
#include "wearwell/bayes/sections.h"
#include "wearwell/math/constants.h"
#include "wearwell/math/quantile.h"
#include "wearwell/math/root.h"

namespace wearwell {

namespace {

// The position of a cell's node along one axis and the moments of its mass, in cell lengths.
struct Along {
  double node = 0, mean = 0, square = 1.0 / 12;

  Along(const WeightedDraws& draws, Eigen::Index i, std::size_t axis) {
    if (!draws.has_cells()) return;
    const auto a = static_cast<Eigen::Index>(axis);
    node = draws.cells.node(i, a);
    mean = draws.cells.mean(i, a);
    square = draws.cells.square(i, a);
  }

  // The weights of the lower and the upper end in the parabola through the values at the node and
  // at both ends, evaluated at `at` with mean square `squared`.
  double of_lower(double at, double squared) const {
    return (squared - at * (node + 0.5) + 0.5 * node) / (0.5 + node);
  }
  double of_upper(double at, double squared) const {
    return (squared - at * (node - 0.5) - 0.5 * node) / (0.5 - node);
  }
};

// The mean of a quantity over a cell, and the half-width over which its mass is spread evenly, with
// the part along the widest axis.
struct Spread {
  double center = 0, half_width = 0;
  // The largest half-width over the axes, the squares of the others, and the offset of the mass
  // from the middle of the largest.
  double widest = 0, others = 0, off = 0;
  double lowest, highest;  // at the node and the ends of the axes

  Spread(const WeightedDraws& draws, Eigen::Index i, double at_node,
         const std::function<double(const double* x)>& quantity)
      : center(at_node), lowest(at_node), highest(at_node) {
    for (std::size_t axis = 0; std::isfinite(at_node) && axis < draws.lower.size(); ++axis) {
      const double a = quantity(draws.lower[axis].row(i).data());
      const double b = quantity(draws.upper[axis].row(i).data());
      const double half = 0.5 * b - 0.5 * a;
      if (!std::isfinite(half)) continue;
      lowest = std::min({lowest, a, b});
      highest = std::max({highest, a, b});
      const Along along(draws, i, axis);
      const double middle = 0.5 * a + 0.5 * b - at_node;
      const double moved = draws.has_cells()
                               ? along.of_lower(along.mean, along.square) * (a - at_node) +
                                     along.of_upper(along.mean, along.square) * (b - at_node)
                               : middle;
      center += moved;
      // Evenly spread mass has a variance of a third of the squared half-width. The squared width
      // may overflow.
      const double stretch = 12 * (along.square - along.mean * along.mean);
      if (std::abs(half) < 1e150 && std::abs(half) > 1e-150 && half_width < 1e150) {
        half_width = std::sqrt(half_width * half_width + half * half * stretch);
      } else {
        half_width = std::hypot(half_width, half * std::sqrt(stretch));
      }
      if (std::abs(half) > widest) {
        others += widest * widest;
        widest = std::abs(half);
        off = moved - middle;
      } else {
        others += half * half;
      }
    }
    // Where a quantity changes by orders of magnitude within a cell, the parabolas leave its range: a
    // mean life would be negative.
    if (std::isfinite(center)) center = std::clamp(center, lowest, highest);
  }
};

}  // namespace

namespace {

// Nodes with negligible total weight must not influence anything.
constexpr double negligible = 1e-8;

}  // namespace

double QuantityDistribution::least_weight(const WeightedDraws& draws) {
  return draws.lower.empty() ? 0 : negligible / static_cast<double>(draws.values.rows());
}

QuantityDistribution::QuantityDistribution(const WeightedDraws& draws,
                                           const std::function<double(const double* x)>& quantity)
    : cells_(!draws.lower.empty()) {
  const double least = least_weight(draws);
  std::vector<SpreadPoint> points, endless;
  double total = 0, undefined = 0;
  for (Eigen::Index i = 0; i < draws.values.rows(); ++i) {
    const double weight = draws.cell_weight(i);
    if (!(weight > least)) continue;
    const double at_node = quantity(draws.values.row(i).data());
    if (std::isnan(at_node)) {
      undefined += weight;
      continue;
    }
    const Spread spread(draws, i, at_node, quantity);
    double center = spread.center, half_width = spread.half_width;
    if (!std::isfinite(center + half_width) || !std::isfinite(center - half_width)) {
      center = at_node;
      half_width = 0;
    }
    lowest_ = std::min(lowest_, spread.lowest);
    highest_ = std::max(highest_, spread.highest);
    total += weight;
    (cells_ && !std::isfinite(center) ? endless : points).push_back({center, half_width, weight});
  }
  if (undefined > negligible * (total + undefined)) {  // the distribution is undefined
    points.clear();
    endless.clear();
  }
  const std::vector<std::size_t> ends = cells_ ? in_sections(points) : sorted_sections(points);
  for (std::size_t s = 0, i = 0; s < ends.size(); ++s) {
    Section section{ends[s], infinity, -infinity, 0};
    for (; i < ends[s]; ++i) {
      section.low = std::min(section.low, points[i].center - points[i].half_width);
      section.high = std::max(section.high, points[i].center + points[i].half_width);
      section.weight += points[i].weight;
    }
    sections_.push_back(section);
  }
  std::sort(endless.begin(), endless.end(),
            [](const SpreadPoint& a, const SpreadPoint& b) { return a.center < b.center; });
  points.insert(points.end(), endless.begin(), endless.end());
  for (const SpreadPoint& point : points) {
    center_.push_back(point.center);
    half_width_.push_back(point.half_width);
    weight_.push_back(point.weight);
  }
}

namespace {

bool even(std::span<const double> weights) {
  const auto [least, most] = std::minmax_element(weights.begin(), weights.end());
  return *most <= *least * (1 + 1e-9);
}

}  // namespace

double QuantityDistribution::mean() const {
  if (center_.empty()) return std::nan("");
  return std::inner_product(center_.begin(), center_.end(), weight_.begin(), 0.0);
}

double QuantityDistribution::sd() const {
  const double m = mean();
  double variance = 0;
  for (std::size_t i = 0; i < center_.size(); ++i) {
    variance += weight_[i] * (std::pow(center_[i] - m, 2) + std::pow(half_width_[i], 2) / 3);
  }
  // n/(n-1) for draws, as for the sd in R.
  const auto n = static_cast<double>(center_.size());
  return std::sqrt(cells_ || !even(weight_) ? variance : variance * n / (n - 1));
}

namespace {

// The weight below x of mass spread evenly over center +- half_width.
double share_below(double x, double center, double half_width, double weight) {
  return x >= center + half_width   ? weight
         : x <= center - half_width ? 0
                                    : weight * 0.5 * (1 + (x - center) / half_width);
}

}  // namespace

double QuantityDistribution::cdf(double x) const {
  double sum = 0;
  std::size_t i = 0;
  for (const Section& section : sections_) {
    if (x >= section.high) {
      sum += section.weight;
    } else if (x > section.low) {
      for (std::size_t j = i; j < section.end; ++j)
        sum += share_below(x, center_[j], half_width_[j], weight_[j]);
    }
    i = section.end;
  }
  for (; i < center_.size(); ++i) sum += share_below(x, center_[i], half_width_[i], weight_[i]);
  return sum;
}

void QuantityDistribution::visit(
    const std::function<void(double weight, double center, double half_width)>& each) const {
  for (std::size_t i = 0; i < center_.size(); ++i) each(weight_[i], center_[i], half_width_[i]);
}

double QuantityDistribution::quantile(double p) const {
  if (center_.empty()) return std::nan("");
  if (!cells_) {
    // Points with unequal weights, or nodes without cells, use the weighted type 7. No
    // interpolation between a finite value and infinity.
    const double q = even(weight_) ? wearwell::quantile(std::span<const double>(center_), p)
                                   : wearwell::quantile(center_, weight_, p);
    return std::isnan(q) ? center_.back() : q;
  }
  // Points at minus infinity come before all sections, those at infinity after.
  const std::size_t finite = sections_.back().end;
  double below = 0;
  for (std::size_t i = finite; i < center_.size(); ++i) {
    if (center_[i] < 0) below += weight_[i];
  }
  if (below > 0 && below >= p) return -infinity;
  double lowest = infinity, highest = -infinity, weight = below;
  const Section* around = nullptr;
  for (const Section& section : sections_) {
    lowest = std::min(lowest, section.low);
    highest = std::max(highest, section.high);
    weight += section.weight;
    if (around) continue;
    if (weight >= p)
      around = &section;
    else
      below = weight;
  }
  if (finite == 0 || (!around && finite < center_.size())) return center_.back();
  // The root lies between the outermost ends of finite cells, even if rounding changes their total
  // weight. The search starts at the cell that reaches p, because the width of the others is
  // irrelevant.
  const std::size_t i = around ? cell_at(*around, p - below) : cell_at(sections_.back(), infinity);
  const double step = std::max(
      {2 * half_width_[i], 1e-12 * std::abs(center_[i]), std::numeric_limits<double>::min()});
  const double found = solve_increasing([&](double x) { return cdf(x) - p; }, center_[i], step,
                                        {.relative = 0x1p-39}, lowest, highest);
  // Cells whose mass is spread evenly reach a little beyond all values, a share of survivors beyond 1.
  return std::clamp(found, lowest_, highest_);
}

std::size_t QuantityDistribution::cell_at(const Section& section, double weight) const {
  const auto s = static_cast<std::size_t>(&section - sections_.data());
  std::vector<std::size_t> order(section.end - (s == 0 ? 0 : sections_[s - 1].end));
  std::iota(order.begin(), order.end(), section.end - order.size());
  std::sort(order.begin(), order.end(),
            [this](std::size_t a, std::size_t b) { return center_[a] < center_[b]; });
  double below = 0;
  for (const std::size_t i : order) {
    below += weight_[i];
    if (below >= weight) return i;
  }
  return order.back();
}

std::vector<double> cell_shares(const WeightedDraws& draws,
                                const std::function<double(const double* x)>& quantity,
                                const std::vector<double>& edges) {
  // The mass below each edge, from cells that it cuts and cells that end before it.
  std::vector<double> cut(edges.size(), 0.0), whole(edges.size() + 1, 0.0);
  double total = 0;
  for (Eigen::Index i = 0; i < draws.values.rows(); ++i) {
    const double weight = draws.cell_weight(i);
    const double at_node = quantity(draws.values.row(i).data());
    if (!(weight > 0) || std::isnan(at_node)) continue;
    total += weight;
    Spread spread(draws, i, at_node, quantity);
    if (!(std::isfinite(spread.center) && spread.half_width < 1e150)) {
      spread.center = at_node;
      spread.half_width = spread.widest = spread.others = 0;
    }
    // Along the widest axis the density is linear, with the mean of the mass.
    const double a = spread.widest, b = std::sqrt(spread.others),
                 off = std::clamp(spread.off, -a / 3, a / 3), middle = spread.center - off;
    // The integral of its cdf up to x.
    const auto integral = [a, off](double x) {
      if (!(x < a)) return x - off;
      if (!(x > -a)) return 0.0;
      return (x + a) * (x + a) / (4 * a) + off * (0.25 * x * (x * x / (a * a) - 3) / a - 0.5);
    };
    const auto distribution = [a, off](double x) {
      return std::clamp(0.5 * (1 + x / a) + 0.75 * off / a * (x * x / (a * a) - 1), 0.0, 1.0);
    };
    const auto first = std::upper_bound(edges.begin(), edges.end(), middle - a - b);
    auto edge = static_cast<std::size_t>(first - edges.begin());
    for (; edge < edges.size() && edges[edge] < middle + a + b; ++edge) {
      const double x = edges[edge] - middle;
      cut[edge] +=
          weight * (b > 1e-6 * a ? (integral(x + b) - integral(x - b)) / (2 * b) : distribution(x));
    }
    whole[edge] += weight;
  }
  std::partial_sum(whole.begin(), whole.end(), whole.begin());
  std::vector<double> shares;
  for (std::size_t k = 0; k + 1 < edges.size(); ++k)
    shares.push_back(std::max(0.0, cut[k + 1] + whole[k + 1] - cut[k] - whole[k]) / total);
  return shares;
}

WeightedSampler::WeightedSampler(const WeightedDraws& draws) : draws_(draws) {
  double sum = 0;
  for (Eigen::Index i = 0; i < draws.weights.size(); ++i) {
    cumulated_.push_back(sum += draws.cell_weight(i));
  }
}

Eigen::VectorXd WeightedSampler::operator()(Rng& rng) const {
  const double u = rng.uniform() * cumulated_.back();
  const auto found = std::lower_bound(cumulated_.begin(), cumulated_.end(), u);
  const Eigen::Index i = found - cumulated_.begin();
  Eigen::VectorXd x = draws_.values.row(i);
  for (std::size_t axis = 0; axis < draws_.lower.size(); ++axis) {
    const auto lower = draws_.lower[axis].row(i), upper = draws_.upper[axis].row(i),
               node = draws_.values.row(i);
    if (!draws_.has_cells()) {
      const double t = rng.uniform() - 0.5;
      x += (t * (upper - lower) + (0.5 * (upper + lower) - node)).transpose();
      continue;
    }
    const Along along(draws_, i, axis);
    // Density 1 + tilt t over -1/2..1/2, by inversion.
    const double tilt = std::clamp(12 * along.mean, -2.0, 2.0), share = rng.uniform();
    const double root =
        std::sqrt(std::max(0.0, (1 - 0.5 * tilt) * (1 - 0.5 * tilt) + 2 * tilt * share));
    const double t = 2 * share / (root + 1 - 0.5 * tilt) - 0.5;
    x += (along.of_lower(t, t * t) * (lower - node) + along.of_upper(t, t * t) * (upper - node))
             .transpose();
  }
  return x;
}

}  // namespace wearwell
