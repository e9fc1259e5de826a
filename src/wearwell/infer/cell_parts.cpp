#include "wearwell/infer/cell_parts.h"

#include <algorithm>
#include <cmath>

namespace wearwell {

CellParts::CellParts(const GaussLegendre& rule, int dimension)
    : d_(dimension), p_(static_cast<int>(rule.node.size())), rule_(rule) {
  const auto p = static_cast<std::size_t>(p_);
  mass_ = mean_ = square_ = Eigen::MatrixXd::Zero(p_, p_);
  node_.resize(p_);
  for (std::size_t i = 0; i < p; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const double half = 0.5 * rule.weight[i], middle = rule.cell_edge[i] + half;
    node_[row] = 0.5 * (rule.node[i] - middle) / half;
    for (std::size_t k = 0; k < p; ++k) {
      const double place = 0.5 * rule.node[k], t = middle + 2 * half * place;
      for (std::size_t j = 0; j < p; ++j) {
        double share = half * rule.weight[k];  // to be multiplied by the Lagrange polynomial of
                                               // node j
        for (std::size_t m = 0; m < p; ++m) {
          if (m != j) share *= (t - rule.node[m]) / (rule.node[j] - rule.node[m]);
        }
        const auto column = static_cast<Eigen::Index>(j);
        mass_(row, column) += share;
        mean_(row, column) += share * place;
        square_(row, column) += share * place * place;
      }
    }
  }
}

// Applies one matrix per axis to the values at all nodes: `matrix` along `which`, masses along the
// others.
Eigen::VectorXd CellParts::applied(std::span<const double> values, int which,
                                   const Eigen::MatrixXd& matrix) const {
  Eigen::VectorXd result =
      Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  Eigen::Index stride = 1;
  for (int a = 0; a < d_; ++a, stride *= p_) {
    const Eigen::MatrixXd& along = a == which ? matrix : mass_;
    for (Eigen::Index first = 0; first < result.size(); ++first) {
      if (first / stride % p_ != 0) continue;
      Eigen::Map<Eigen::VectorXd, 0, Eigen::InnerStride<>> line(&result[first], p_,
                                                                Eigen::InnerStride<>(stride));
      line = (along * line).eval();
    }
  }
  return result;
}

double CellParts::node_weight(std::size_t index) const {
  double weight = 1;
  for (int a = 0; a < d_; ++a, index /= static_cast<std::size_t>(p_)) {
    weight *= rule_.weight[index % static_cast<std::size_t>(p_)];
  }
  return weight;
}

void CellParts::describe(std::span<const double> values, const std::vector<std::size_t>& kept,
                         double volume, Eigen::Index row, WeightedDraws::Cells& cells) const {
  // If the polynomial's mass is farther from the node's weight, the polynomial is a bad
  // approximation, and the weight is spread evenly instead. A non-negative density has its mean and
  // mean square within these bounds.
  constexpr double least = 0.3, most = 3, farthest_mean = 0.3;
  const Eigen::VectorXd mass = applied(values, -1, mass_);
  std::size_t stride = 1;
  for (int a = 0; a < d_; ++a, stride *= static_cast<std::size_t>(p_)) {
    const Eigen::VectorXd mean = applied(values, a, mean_), square = applied(values, a, square_);
    for (std::size_t k = 0; k < kept.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(kept[k]);
      const Eigen::Index at = row + static_cast<Eigen::Index>(k);
      const double by_weight = values[kept[k]] * node_weight(kept[k]);
      const bool sound = mass[i] > least * by_weight && mass[i] < most * by_weight;
      const double m = sound ? std::clamp(mean[i] / mass[i], -farthest_mean, farthest_mean) : 0;
      cells.mass[at] = (sound ? mass[i] : by_weight) * volume;
      cells.node(at, a) =
          node_[static_cast<Eigen::Index>(kept[k] / stride % static_cast<std::size_t>(p_))];
      cells.mean(at, a) = m;
      cells.square(at, a) = sound ? std::clamp(square[i] / mass[i], m * m + 0.01, 0.25) : 1.0 / 12;
    }
  }
}

}  // namespace wearwell
