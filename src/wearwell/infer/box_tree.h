#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "wearwell/math/quadrature.h"

namespace wearwell {

/// A binary tree of halved boxes that finds the box of a point. For up to four axes.
class BoxTree {
 public:
  static constexpr int most = 4;
  using Coordinates = std::array<double, most>;

  explicit BoxTree(int dimension) : d_(dimension) {}

  void add(const Coordinates& lower, const Coordinates& upper, std::size_t box);

  /// `box` keeps the lower half of the axis, or the upper half if `keeps_upper`; `other` is the
  /// other half.
  void halve(std::size_t box, int axis, double at, bool keeps_upper, std::size_t other);

  /// The box, or `none`.
  std::size_t find(const Coordinates& u) const;
  static constexpr auto none = static_cast<std::size_t>(-1);

 private:
  struct Branch {
    int axis = -1;  // -1: a box
    double at = 0;
    std::size_t below = none, above = none;  // branches; in a leaf `below` is the box
  };
  struct Root {
    Coordinates lower, upper;
    std::size_t branch;
  };
  int d_;
  std::vector<Root> roots_;
  std::vector<Branch> branches_;
  std::vector<std::size_t> leaf_;  // of a box
};

/// The polynomial through a density at the nodes of a product of Gauss-Legendre rules on [-1, 1]^d,
/// the first axis fastest.
class NodePolynomial {
 public:
  NodePolynomial(const GaussLegendre& rule, int dimension);

  double value(std::span<const double> values, const BoxTree::Coordinates& place) const;

  /// Values on a face of the axis, at the nodes of the other axes, in the order of `values` without
  /// this axis.
  void face(std::span<const double> values, int axis, bool high,
            std::vector<double>& on_face) const;

 private:
  int d_;
  std::size_t p_;
  GaussLegendre rule_;
  std::vector<double> barycentric_;            // weights of Lagrange's form
  std::array<std::vector<double>, 2> at_end_;  // Lagrange's polynomials at -1 and 1
};

}  // namespace wearwell
