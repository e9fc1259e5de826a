#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "wearwell/base/progress.h"
#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/lattice_chart.h"

namespace wearwell::lattice {

constexpr int d = 4, outer = 3;
using Index = std::array<std::int16_t, outer>;
using Steps = std::array<double, d>;  // steps between lines along each axis, and along the lines

/// Coordinates of an outer axis: v, in which steps are even, and u of the chart. With a finite `far`
/// steps in u are nearly even about the center and grow exponentially beyond, so that long tails end
/// after few lines.
struct Axis {
  double center = 0, far = INFINITY;
  struct Place {
    double u, slope;
  };
  Place at(double v) const {
    if (std::isinf(far)) return {center + v, 1};
    const double e = std::exp(v / far);
    return {center + 0.5 * far * (e - 1 / e), 0.5 * (e + 1 / e)};
  }
};
using Axes = std::array<Axis, outer>;

/// A node's natural parameters, and the log Jacobian of its position on the real line.
struct Located {
  Eigen::Matrix<double, d, 1, Eigen::DontAlign> natural;
  double log_jacobian = 0;
};

/// One line: the fourth coordinate is middle + width t at t = 0, +-step, +-2 step, ...
struct Line {
  Index index{};
  double middle = 0, width = 1;
  int first = 0;               // t of the first value divided by the step
  std::vector<double> values;  // log density minus the reference
  double highest = -INFINITY;
  std::vector<Located> kept;  // of each value; empty if too many to store
};

/// The mass of a node relative to that of the reference; t is in steps.
double node_mass(const Line& line, int t);
/// The sum over its nodes.
double mass_of(const Line& line);

/// A point of a line, or near it.
struct Place {
  LatticeChart::Z z;        // on the real line
  double log_jacobian = 0;  // of z with respect to u
};

/// The lines of a lattice (lattice.h) and the density at its nodes. `posterior` and `chart` must
/// outlive them.
class Lines {
 public:
  Lines(const Posterior& posterior, const LatticeChart& chart, const Axes& axes,
        const Steps& steps);
  Lines(const Lines&) = delete;
  Lines& operator=(const Lines&) = delete;
  ~Lines();

  /// Fills the lattice outward from its middle, down to `log_negligible` relative to the highest
  /// density; what is there stays. Empty, or the reason for stopping.
  std::string fill(double log_negligible, long most, Progress* progress);

  const std::vector<Line>& all() const { return lines_; }
  long nodes() const { return nodes_; }
  const Posterior& posterior() const { return posterior_; }
  /// Values of lines are relative to it.
  double reference() const { return reference_; }
  /// The log density of a node above that at which the lattice ends.
  double above_end(double value) const { return value - highest_ - log_negligible_; }
  /// The log of the integral of which `mass` is the sum over nodes.
  double log_of(double mass) const;
  /// Axes about the medians, stretched beyond the central mass.
  Axes stretched_axes() const;

  Located located(const Line& line, std::size_t j) const;
  Place at(const Line& line, double t) const;
  /// Half way to a neighbour, at the same position across the ridge, whose curve is the parabola
  /// through both neighbours.
  Place between(const Line& line, const Line& other, const Line& opposite, int axis, double shift,
                int t) const;
  Eigen::Vector4d natural(const Place& there) const;
  /// The line itself where there is none.
  const Line& neighbour(const Line& line, int axis, int way) const;

 private:
  class Walk;
  // Workspace of a walk: nodes in the negative and the positive direction.
  struct Sides {
    std::array<std::vector<double>, 2> values;
    std::array<std::vector<Located>, 2> kept;
  };

  void add(std::vector<Line> ring, Progress* progress);
  void lengthen(Progress* progress);
  void count(std::size_t first, Progress* progress);
  std::string surround(std::size_t first, std::vector<Line>& ring);
  bool set_reference();
  Place place(const Index& index, int axis, double shift, double on_line) const;
  double density(const Place& there) const;
  void integrate(Line& line, Sides& sides) const;
  void lengthen(Line& line, Sides& sides) const;
  void walk_outward(Walk& walk, Line& line, Sides& sides) const;

  const Posterior& posterior_;
  const LatticeChart& chart_;
  Axes axes_;
  Steps steps_;
  double log_negligible_ = 0;
  double reference_;
  double highest_ = -INFINITY;
  long nodes_ = 0, reported_ = 0;
  int moves_ = 0;      // of the reference
  bool keeps_ = true;  // whether positions of nodes are stored
  std::vector<Line> lines_;
  std::unordered_map<std::uint64_t, std::size_t> known_;
};

}  // namespace wearwell::lattice
