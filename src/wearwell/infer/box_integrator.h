#pragma once

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "wearwell/infer/box_tree.h"
#include "wearwell/infer/cell_parts.h"
#include "wearwell/infer/exact.h"
#include "wearwell/infer/ridge_map.h"

namespace wearwell {

/// Adaptive boxes over the map's coordinates (exact.h): refinement (box_integrator.cpp), additional
/// inspection (box_inspection.cpp), several maxima (box_maxima.cpp), and conversion to nodes
/// (box_result.cpp).
class BoxIntegrator {
 public:
  BoxIntegrator(const Posterior& posterior, const Whitening& whitening,
                const ExactSettings& settings, const Posterior& shape, bool along_ridge);
  ExactPosterior run();

  bool straight() const { return map_.affine(); }
  /// The walk along the ridge visited all maxima.
  bool reaches_maxima() const;

 private:
  static constexpr int max_d = max_exact_dimension;
  using Coordinates = RidgeMap::Coordinates;
  static_assert(RidgeMap::most == max_d);

  struct Cell {
    Coordinates lower, upper;
    std::size_t first;  // index of its values in the arena
    double mass = 0;    // integral of the density
    double control =
        0;  // integral of density x (1 + squared standardized parameters): mass and second
            // moments in one
    double error = 0;        // estimated, of `control`
    int axis = 0;            // the worst-resolved axis
    bool inspected = false;  // inspected between its nodes
    bool agrees = false;     // agrees with its neighbours
    double tail =
        0;  // the error relative to `control`, estimated from the cell's Legendre coefficients
  };

  // A maximum in the map's coordinates, with its marginal and conditional widths along each axis.
  struct Place {
    Coordinates u, width, narrow;
    double log_density;  // relative to the reference
    double volume;       // root of the determinant of its covariance
  };

  void node(const Cell& cell, std::size_t index, Coordinates& u) const {
    for (int a = 0; a < d_; ++a) {
      const double t = rule_.node[index % p_];
      index /= p_;
      u[a] = 0.5 * (cell.lower[a] + cell.upper[a]) + 0.5 * t * (cell.upper[a] - cell.lower[a]);
    }
  }
  double node_weight(std::size_t index) const {
    double weight = 1;
    for (int a = 0; a < d_; ++a, index /= p_) weight *= rule_.weight[index % p_];
    return weight;
  }
  double volume(const Cell& cell) const {
    double v = 1;
    for (int a = 0; a < d_; ++a) v *= 0.5 * (cell.upper[a] - cell.lower[a]);
    return v;
  }
  // The natural parameters of u.
  void to_natural(const Coordinates& z, Coordinates& x) const {
    const auto n = static_cast<std::size_t>(d_);
    posterior_.to_natural(std::span(z.data(), n), std::span(x.data(), n));
  }
  Eigen::VectorXd natural(const Coordinates& u) const;
  // Nodes with the same position along the map's axis share a frame.
  std::array<RidgeMap::Frame, 10> frames_of(const Cell& cell) const;
  // Evaluates the density on the cell's nodes and adds it.
  Cell& add(const Coordinates& lower, const Coordinates& upper);
  // The axis with the largest two highest Legendre coefficients, and an error estimate from all
  // axes: the geometric decay of the coefficients is extrapolated to the degree at which the rule
  // begins to err. Halving along one axis gives no information about the others.
  void look_along_axes(Cell& cell) const;
  // Extends the region and the reference to all maxima, if there are several.
  void reach_maxima();
  Place place_of(const Whitening& whitening) const;
  // Halves the boxes at each maximum until they are at most a few of its widths long.
  void halve_at_maxima();
  // A maximum that the boxes miss.
  bool missed_maximum() const;
  void add_grid(const Coordinates& lower, const Coordinates& upper, int parts);
  void sum() {
    mass_ = control_ = error_ = 0;
    for (const Cell& cell : cells_) {
      mass_ += cell.mass;
      control_ += cell.control;
      error_ += cell.error;
    }
  }
  // Halves the cells with the largest errors until the sum of errors is small and no cell holds
  // much mass.
  void refine();
  void halve(std::size_t i) { halve(i, cells_[i].axis); }
  void halve(std::size_t i, int a);
  // Neighbours must agree on the density at their shared face: a ridge that disappears in the next
  // box passes between its nodes, and halving alone may not detect it. Such a box is halved to the
  // size of its neighbour. False if all agree.
  bool reconcile();
  bool reconcile(std::size_t i, int axis, bool high, std::vector<double>& on_face);
  // Halves the box there until it has at most half the size of `cell` along every axis.
  void halve_towards(const Coordinates& there, const Cell& cell);
  // Whether `other` is larger than half of `cell` along some axis.
  bool larger(const Cell& other, const Cell& cell) const;
  double density_by(const Cell& cell, const Coordinates& u) const;
  // Evaluates the density between the nodes of every relevant box, at low-discrepancy points: if
  // the polynomial through the nodes has a relative error there, the integral has at most about its
  // square. True if the error estimate was too small.
  bool inspect();
  // Standardizes second moments by the posterior's mean and standard deviations, of which the
  // whitening is only an estimate. True if the estimate was bad.
  bool restandardize();
  // Integrals of the density and standardized natural parameters.
  template <class Visit>
  void for_each_node(const Visit& visit) const {
    Coordinates u, z, x;
    Eigen::VectorXd t(d_);
    for (const Cell& cell : cells_) {
      if (!(cell.mass > 0)) continue;
      const double v = volume(cell);
      const std::array<RidgeMap::Frame, 10> frames = frames_of(cell);
      for (std::size_t i = 0; i < points_; ++i) {
        const double f = values_[cell.first + i];
        if (f == 0) continue;
        node(cell, i, u);
        map_.to_real(frames[i / stride_ % p_], u, z);
        to_natural(z, x);
        for (int a = 0; a < d_; ++a) t[a] = (x[a] - center_x_[a]) / scale_x_[a];
        visit(cell, node_weight(i) * v * f, t);
      }
    }
  }
  bool too_far(int axis, double reach) const;
  // Adds a slab at each face whose outermost cells still have mass. False if there is none.
  bool grow();
  // Second moments diverge: from here on only mass is integrated.
  void forget_moments();
  // Whether the walk met a density that no node has.
  void verify();
  double log_mass() const;
  // The node, its weight, and the bounds of its cell.
  void write_node(const Cell& cell, std::size_t index, Eigen::Index row,
                  WeightedDraws& nodes) const;
  ExactPosterior result();
  // Over all nodes, because the omitted nodes together have part of a second moment.
  void describe_moments(ExactPosterior& exact) const;

  const Posterior& posterior_;
  bool own_shape_;
  const ExactSettings& settings_;
  int d_, p_;
  GaussLegendre rule_;
  std::size_t points_;
  RidgeMap map_;
  std::size_t stride_;  // stride of the map's axis among a cell's nodes
  double reference_, log_jacobian_;
  std::array<Coordinates, max_d> unit_;
  CellParts parts_{rule_, d_};
  NodePolynomial polynomial_{rule_, d_};
  BoxTree tree_{d_};
  double highest_ = -INFINITY;  // highest log density of any node, relative to the reference
  std::vector<double> top_, next_;
  double most_weight_;  // largest weight of a node on a face
  Eigen::VectorXd center_x_, scale_x_;
  Coordinates lower_{}, upper_{};
  std::vector<Place> places_;
  std::vector<Cell> cells_;
  std::vector<double> values_;  // density at the nodes of every cell, relative to the reference
  double mass_ = 0, control_ = 0, error_ = 0;
  long evaluations_ = 0;
  bool moments_exist_ = true;
  Coordinates wander_{};
  int standardized_ = 0;     // count
  bool overflowed_ = false;  // a second moment is not a number
  std::string failure_;
  bool contradicted_ = false;
};

}  // namespace wearwell
