#include "wearwell/models/bearing/rate_grid.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "wearwell/math/constants.h"
#include "wearwell/models/bearing/rate_integral.h"
#include "wearwell/models/bearing/seen_bearing.h"

namespace wearwell::bearing {
namespace {

constexpr double tail = -16;       // log of the omitted part relative to the maximum
constexpr double rule_step = 0.8;  // of a width: range of one point's integrand
// Of the mean width: if sigma is known there is one class, else 32 of them are dense together.
constexpr double grid_step = 0.25, grid_step_alone = 0.06;
constexpr std::size_t sigma_classes = 32;

// One point of the posterior, and the likelihood of the bearing's rows at it.
struct PointOf {
  double log_k, sigma, scatter, log_scatter;
  double
      // weight before rows that the posterior does not contain, over its likelihood of this
      // bearing's rows
      log_weight;
  double log_all = 0;      // the integral over all rows
  double from, to, width;  // of ln k
  double total() const { return log_weight + log_all; }
};

// Fractional parts of multiples of the golden ratio are evenly distributed.
double fraction(std::size_t i) {
  constexpr double golden = 0.6180339887498949;
  const double x = golden * static_cast<double>(i);
  return x - std::floor(x);
}

double log_sum(const std::vector<RateNode>& nodes, double top) {
  double sum = 0;
  for (const RateNode& each : nodes) sum += std::exp(each.log_weight - top);
  return top + std::log(sum);
}

void look(const BearingRows& rows, std::size_t i, PointOf& point) {
  if (!rows.all) {
    constexpr double end = 5.6;
    point.from = point.log_k - end * point.scatter;
    point.to = point.log_k + end * point.scatter;
    point.width = point.scatter;
    return;
  }
  const std::vector<RateNode> nodes =
      rate_nodes(*rows.all, point.log_k, point.sigma, point.scatter, rule_step, fraction(i));
  double top = -infinity, sum = 0, mean = 0, square = 0, from = infinity, to = -infinity;
  for (const RateNode& each : nodes) top = std::max(top, each.log_weight);
  for (const RateNode& each : nodes) {
    if (each.log_weight < top + tail) continue;
    const double share = std::exp(each.log_weight - top);
    sum += share;
    mean += share * each.z;
    square += share * each.z * each.z;
    from = std::min(from, each.z);
    to = std::max(to, each.z);
  }
  point.log_all = nodes.empty() ? -infinity : log_sum(nodes, top);
  if (nodes.empty()) return;
  mean /= sum;
  const double spread = std::sqrt(std::max(square / sum - mean * mean, 1e-24));
  point.width = point.scatter * spread;
  point.from = point.log_k + point.scatter * (from - spread);
  point.to = point.log_k + point.scatter * (to + spread);
}

std::vector<PointOf> points_of(const WearModel& model, const ThinnedPosterior& points,
                               const BearingRows& rows) {
  const double seen = rows.seen ? static_cast<double>(rows.seen->size()) : 0;
  const double fresh = (rows.all ? static_cast<double>(rows.all->size()) : 0) - seen;
  std::vector<PointOf> all;
  for (std::size_t i = 0; i < points.weights.size(); ++i) {
    const double* x = points.values.row(static_cast<Eigen::Index>(i)).data();
    PointOf point{std::log(x[0]),
                  model.sigma(x),
                  model.scatter(x),
                  std::log(model.scatter(x)),
                  std::log(points.weights[i]),
                  0,
                  std::log(x[0]),
                  std::log(x[0]),
                  0};
    // The likelihood of the normal family comes without these factors.
    if (model.family == ObservationFamily::normal)
      point.log_weight -= fresh * (std::log(point.sigma) + half_log_two_pi);
    if (point.scatter > 0) {
      if (rows.seen)
        point.log_weight -=
            log_rate_integral(*rows.seen, point.log_k, point.sigma, point.scatter).value;
      look(rows, i, point);
    } else if (rows.all) {
      point.log_all = rows.all->at(point.log_k, point.sigma).value;
      if (rows.seen) point.log_all -= rows.seen->at(point.log_k, point.sigma).value;
    }
    if (point.total() > -infinity && point.total() < infinity) all.push_back(point);
  }
  return all;
}

struct Nodes {
  std::vector<double> log_k, sigma, log_weight;
};

// Points of nearly equal sigma.
void place_class(const std::span<const PointOf> points, const BearingRows& rows, double step,
                 double most_nodes, double shift, Nodes& nodes) {
  double top = -infinity, sum = 0, sigma = 0, from = infinity, to = -infinity;
  for (const PointOf& each : points) top = std::max(top, each.total());
  for (const PointOf& each : points) {
    const double share = std::exp(each.total() - top);
    sum += share;
    sigma += share * each.sigma;
    if (each.total() < top + tail) continue;
    from = std::min(from, each.from);
    to = std::max(to, each.to);
  }
  sigma /= sum;
  step *= std::max(1.0, std::ceil((to - from) / (step * most_nodes)));
  std::vector<double> term(points.size());
  // Places are even over all classes together, not within each from its start.
  for (double n = std::floor(from / step); (n + shift) * step <= to; ++n) {
    const double u = (n + shift) * step;
    double highest = -infinity, likelihood = 0, of_sigma = -1;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const PointOf& point = points[i];
      if (rows.all && point.sigma != of_sigma) {
        likelihood = rows.all->at(u, point.sigma).value;
        of_sigma = point.sigma;
      }
      const double z = (u - point.log_k) / point.scatter;
      term[i] = point.log_weight + likelihood - 0.5 * z * z - point.log_scatter - half_log_two_pi;
      highest = std::max(highest, term[i]);
    }
    if (!(highest > -infinity)) continue;
    double here = 0;
    for (const double each : term) here += std::exp(each - highest);
    nodes.log_k.push_back(u);
    nodes.sigma.push_back(sigma);
    nodes.log_weight.push_back(highest + std::log(here * step));
  }
}

prognosis::NodeCloud cloud_of(const Nodes& nodes, bool with_sigma) {
  double top = -infinity;
  for (const double each : nodes.log_weight) top = std::max(top, each);
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < nodes.log_weight.size(); ++i) {
    if (nodes.log_weight[i] > top + tail) kept.push_back(i);
  }
  prognosis::NodeCloud cloud{Points(static_cast<Eigen::Index>(kept.size()), 1 + with_sigma), {}};
  for (std::size_t n = 0; n < kept.size(); ++n) {
    const auto row = static_cast<Eigen::Index>(n);
    cloud.values(row, 0) = nodes.log_k[kept[n]];
    if (with_sigma) cloud.values(row, 1) = nodes.sigma[kept[n]];
    cloud.log_weight.push_back(nodes.log_weight[kept[n]]);
  }
  return cloud;
}

}  // namespace

RateGrid rate_grid(const WearModel& model, const ThinnedPosterior& points,
                   const BearingRows& rows) {
  std::vector<PointOf> all = points_of(model, points, rows);
  RateGrid grid;
  double top = -infinity, sum = 0, square = 0, width = 0;
  for (const PointOf& each : all) top = std::max(top, each.total());
  for (const PointOf& each : all) {
    sum += std::exp(each.total() - top);
    width += std::exp(each.total() - top) * each.width;
    square += std::exp(2 * (each.total() - top));
  }
  grid.effective = square > 0 ? sum * sum / square : 0;
  Nodes nodes;
  if (!model.has_scatter) {
    for (const PointOf& each : all) {
      nodes.log_k.push_back(each.log_k);
      nodes.sigma.push_back(each.sigma);
      nodes.log_weight.push_back(each.total());
    }
    grid.nodes = cloud_of(nodes, !model.depth_error);
    return grid;
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const PointOf& a, const PointOf& b) { return a.sigma < b.sigma; });
  // Classes of even weight.
  const std::size_t classes = model.depth_error ? 1 : sigma_classes;
  const double step = (model.depth_error ? grid_step_alone : grid_step) * width / sum;
  const double most_nodes = model.depth_error ? 800 : 400;
  std::size_t begin = 0;
  double before = 0;
  for (std::size_t c = 0; c < classes && begin < all.size(); ++c) {
    std::size_t end = begin;
    const double until = sum * static_cast<double>(c + 1) / static_cast<double>(classes);
    while (end < all.size() && (before < until || c + 1 == classes))
      before += std::exp(all[end++].total() - top);
    if (end > begin)
      place_class(std::span(all).subspan(begin, end - begin), rows, step, most_nodes, fraction(c),
                  nodes);
    begin = end;
  }
  grid.nodes = cloud_of(nodes, !model.depth_error);
  return grid;
}

}  // namespace wearwell::bearing
