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

/// Adaptive boxes over the map's coordinates (exact.h): refined (box_integrator.cpp), looked at again in
/// other ways (box_inspection.cpp), laid about several maxima (box_maxima.cpp), and written as nodes (box_result.cpp).
class BoxIntegrator {
 public:
  BoxIntegrator(const Posterior& posterior, const Whitening& whitening,
                const ExactSettings& settings, const Posterior& shape, bool along_ridge);
  ExactPosterior run();

  bool straight() const { return map_.affine(); }
  /// The walk along the ridge has come by all maxima.
  bool reaches_maxima() const;

 private:
  static constexpr int max_d = max_exact_dimension;
  using Coordinates = RidgeMap::Coordinates;
  static_assert(RidgeMap::most == max_d);

  struct Cell {
    Coordinates lower, upper;
    std::size_t first;  // of its values in the arena
    double mass = 0;    // integral of the density
    double control =
        0;  // integral of density x (1 + squared standardized parameters): mass and second
            // moments in one
    double error = 0;        // estimated, of `control`
    int axis = 0;            // along which it resolves worst
    bool inspected = false;  // between its nodes
    bool agrees = false;     // with its neighbours
    double tail =
        0;  // the error relative to `control`, as the cell's own Legendre coefficients tell it
  };

  // A maximum in the map's coordinates: how wide it is along each axis, whatever the others and with these held.
  struct Place {
    Coordinates u, width, narrow;
    double log_density;  // over the reference
    double volume;       // of its covariance: the root of the determinant
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
  // Nodes with the same place along the map's axis share a frame.
  std::array<RidgeMap::Frame, 10> frames_of(const Cell& cell) const;
  // Evaluates the density on the cell's nodes and adds it.
  Cell& add(const Coordinates& lower, const Coordinates& upper);
  // Along which axis the two highest Legendre coefficients are largest, and what all of them say of the
  // error: coefficients that fall geometrically from the mean to the highest are, at the degree where
  // the rule begins to err, as much smaller again. Halving along one axis tells nothing of the others.
  void look_along_axes(Cell& cell) const;
  // Makes the region and the reference fit all maxima, where there are several.
  void reach_maxima();
  Place place_of(const Whitening& whitening) const;
  // Halves the boxes at each maximum until they are no longer than some of its widths.
  void halve_at_maxima();
  // A maximum that the boxes do not have.
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
  // Neighbours have to agree on the density at the face they share: a ridge that leaves a box and is
  // nothing in the next ran between that one's nodes, and both of its halves may agree that there is
  // nothing. Such a box is halved until it is as small as the one that knows better. False when all
  // agree.
  bool reconcile();
  bool reconcile(std::size_t i, int axis, bool high, std::vector<double>& on_face);
  // Halves the box there until it is half of `cell` along every axis.
  void halve_towards(const Coordinates& there, const Cell& cell);
  // Is `other` not yet half of `cell` along every axis?
  bool larger(const Cell& other, const Cell& cell) const;
  double density_by(const Cell& cell, const Coordinates& u) const;
  // Evaluates the density between the nodes of every box that counts, at points that wander over all
  // boxes: what the polynomial through the nodes misses there by a share of the box's mean density, its
  // integral misses by no more than about the square of it. True when the error was too small.
  bool inspect();
  // Second moments count by their size: about the posterior's own mean and in its own standard
  // deviations, which the whitening only guessed. True when they were guessed badly.
  bool restandardize();
  // Of the density and standardized natural parameters.
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
  // Adds a slab at each face where the outermost cells still hold something. False when none does.
  bool grow();
  // Second moments diverge: from here on only mass is integrated.
  void forget_moments();
  // Was there anything on the way that no node has seen?
  void verify();
  double log_mass() const;
  // The node, its weight, and where its cell ends.
  void write_node(const Cell& cell, std::size_t index, Eigen::Index row,
                  WeightedDraws& nodes) const;
  ExactPosterior result();
  // Of all nodes: those left out of the result together hold some of a second moment.
  void describe_moments(ExactPosterior& exact) const;

  const Posterior& posterior_;
  bool own_shape_;
  const ExactSettings& settings_;
  int d_, p_;
  GaussLegendre rule_;
  std::size_t points_;
  RidgeMap map_;
  std::size_t stride_;  // of the map's axis among a cell's nodes
  double reference_, log_jacobian_;
  std::array<Coordinates, max_d> unit_;
  CellParts parts_{rule_, d_};
  NodePolynomial polynomial_{rule_, d_};
  BoxTree tree_{d_};
  double highest_ = -INFINITY;  // log density of any node, over the reference
  std::vector<double> top_, next_;
  double most_weight_;  // of a node on a face
  Eigen::VectorXd center_x_, scale_x_;
  Coordinates lower_{}, upper_{};
  std::vector<Place> places_;
  std::vector<Cell> cells_;
  std::vector<double> values_;  // density at the nodes of every cell, relative to the reference
  double mass_ = 0, control_ = 0, error_ = 0;
  long evaluations_ = 0;
  bool moments_exist_ = true;
  Coordinates wander_{};
  int standardized_ = 0;     // how often
  bool overflowed_ = false;  // a second moment is no number
  std::string failure_;
  bool contradicted_ = false;
};

}  // namespace wearwell
