#include "wearwell/infer/box_tree.h"

namespace wearwell {

void BoxTree::add(const Coordinates& lower, const Coordinates& upper, std::size_t box) {
  roots_.push_back({lower, upper, branches_.size()});
  leaf_.resize(std::max(leaf_.size(), box + 1), none);
  leaf_[box] = branches_.size();
  branches_.push_back({-1, 0, box, none});
}

void BoxTree::halve(std::size_t box, int axis, double at, bool keeps_upper, std::size_t other) {
  const std::size_t first = branches_.size();
  branches_[leaf_[box]] = {axis, at, first, first + 1};
  leaf_.resize(std::max(leaf_.size(), other + 1), none);
  branches_.push_back({-1, 0, keeps_upper ? other : box, none});
  branches_.push_back({-1, 0, keeps_upper ? box : other, none});
  leaf_[box] = first + (keeps_upper ? 1 : 0);
  leaf_[other] = first + (keeps_upper ? 0 : 1);
}

std::size_t BoxTree::find(const Coordinates& u) const {
  for (const Root& root : roots_) {
    bool inside = true;
    for (int a = 0; a < d_; ++a) inside &= root.lower[a] <= u[a] && u[a] < root.upper[a];
    if (!inside) continue;
    const Branch* branch = &branches_[root.branch];
    while (branch->axis >= 0) {
      branch = &branches_[u[branch->axis] < branch->at ? branch->below : branch->above];
    }
    return branch->below;
  }
  return none;
}

NodePolynomial::NodePolynomial(const GaussLegendre& rule, int dimension)
    : d_(dimension), p_(rule.node.size()), rule_(rule), barycentric_(p_, 1) {
  for (std::size_t i = 0; i < p_; ++i) {
    for (std::size_t j = 0; j < p_; ++j) {
      if (j != i) barycentric_[i] /= rule.node[i] - rule.node[j];
    }
  }
  for (const std::size_t high : {0u, 1u}) {
    const double t = high ? 1 : -1;
    for (std::size_t i = 0; i < p_; ++i) {
      double lagrange = barycentric_[i];
      for (std::size_t j = 0; j < p_; ++j) {
        if (j != i) lagrange *= t - rule.node[j];
      }
      at_end_[high].push_back(lagrange);
    }
  }
}

double NodePolynomial::value(std::span<const double> values,
                             const BoxTree::Coordinates& place) const {
  // Contracts one axis after the other, the last first; the remaining values are at the nodes of
  // the earlier axes.
  std::array<double, 1000> left;
  std::size_t count = values.size();
  const double* from = values.data();
  for (int a = d_ - 1; a >= 0; --a) {
    std::array<double, 10> lagrange;
    double product = 1;
    for (std::size_t i = 0; i < p_; product *= place[a] - rule_.node[i++]) {
      lagrange[i] = barycentric_[i] * product;
    }
    product = 1;
    for (std::size_t i = p_; i-- > 0; product *= place[a] - rule_.node[i]) lagrange[i] *= product;
    count /= p_;
    for (std::size_t line = 0; line < count; ++line) {
      double sum = 0;
      for (std::size_t i = 0; i < p_; ++i) sum += lagrange[i] * from[line + i * count];
      left[line] = sum;
    }
    from = left.data();
  }
  return left[0];
}

void NodePolynomial::face(std::span<const double> values, int axis, bool high,
                          std::vector<double>& on_face) const {
  on_face.assign(values.size() / p_, 0);
  std::size_t stride = 1;
  for (int a = 0; a < axis; ++a) stride *= p_;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t place = i / stride % p_;
    on_face[i % stride + i / (stride * p_) * stride] += at_end_[high][place] * values[i];
  }
}

}  // namespace wearwell
