#include <cmath>

#include "wearwell/infer/box_integrator.h"

namespace wearwell {
namespace {

// Omits nodes with less mass from the result.
constexpr double negligible_share = 1e-9;

}  // namespace

void BoxIntegrator::write_node(const Cell& cell, std::size_t index, Eigen::Index row,
                               WeightedDraws& nodes) const {
  nodes.weights[row] = values_[cell.first + index] * node_weight(index) * volume(cell) / mass_;
  Coordinates u;
  node(cell, index, u);
  nodes.values.row(row) = natural(u);
  for (int a = 0; a < d_; ++a, index /= p_) {
    const double at = u[a];
    const double middle = 0.5 * (cell.lower[a] + cell.upper[a]);
    const double half = 0.5 * (cell.upper[a] - cell.lower[a]);
    u[a] = middle + half * rule_.cell_edge[index % p_];
    nodes.lower[a].row(row) = natural(u);
    u[a] = middle + half * rule_.cell_edge[index % p_ + 1];
    nodes.upper[a].row(row) = natural(u);
    u[a] = at;
  }
}

ExactPosterior BoxIntegrator::result() {
  sum();
  ExactPosterior exact;
  exact.failure = failure_;
  exact.contradicted = contradicted_;
  exact.evaluations = evaluations_;
  exact.error = error_ / control_;
  exact.highest = reference_ + highest_;
  if (!failure_.empty()) return exact;
  std::vector<std::pair<const Cell*, std::vector<std::size_t>>> kept;
  Eigen::Index n = 0;
  for (const Cell& cell : cells_) {
    const double v = volume(cell);
    std::vector<std::size_t> here;
    for (std::size_t i = 0; i < points_; ++i) {
      const double share = values_[cell.first + i] * node_weight(i) * v / mass_;
      if (share > negligible_share) here.push_back(i);
    }
    n += static_cast<Eigen::Index>(here.size());
    if (!here.empty()) kept.emplace_back(&cell, std::move(here));
  }
  WeightedDraws& nodes = exact.nodes;
  nodes.values.resize(n, d_);
  nodes.weights.resize(n);
  nodes.cells.mass.resize(n);
  for (Points* each : {&nodes.cells.node, &nodes.cells.mean, &nodes.cells.square}) {
    each->resize(n, d_);
  }
  nodes.lower.assign(d_, Points(n, d_));
  nodes.upper.assign(d_, Points(n, d_));
  Eigen::Index row = 0;
  for (const auto& [cell, indices] : kept) {
    const std::span values(&values_[cell->first], points_);
    parts_.describe(values, indices, volume(*cell), row, nodes.cells);
    for (const std::size_t index : indices) write_node(*cell, index, row++, nodes);
  }
  nodes.cells.mass /= nodes.cells.mass.sum();
  nodes.weights /= nodes.weights.sum();
  describe_moments(exact);
  if (!moments_exist_) exact.covariance.setConstant(std::numeric_limits<double>::quiet_NaN());
  exact.sd = exact.covariance.diagonal().cwiseSqrt();
  bool proper = true;
  for (const Parameter& parameter : posterior_.parameters()) proper &= parameter.prior.proper;
  exact.log_mass = log_mass();
  if (proper) exact.log_evidence = exact.log_mass;
  return exact;
}

void BoxIntegrator::describe_moments(ExactPosterior& exact) const {
  double mass = 0;
  Eigen::VectorXd first = Eigen::VectorXd::Zero(d_);
  Eigen::MatrixXd second = Eigen::MatrixXd::Zero(d_, d_);
  for_each_node([&](const Cell&, double weight, const Eigen::VectorXd& t) {
    mass += weight;
    first += weight * t;
    second += weight * t * t.transpose();
  });
  first /= mass;
  exact.mean = center_x_ + scale_x_.cwiseProduct(first);
  exact.covariance =
      scale_x_.asDiagonal() * (second / mass - first * first.transpose()) * scale_x_.asDiagonal();
}

}  // namespace wearwell
