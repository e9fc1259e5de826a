#pragma once

#include <span>
#include <vector>

#include "wearwell/bayes/weighted_draws.h"

namespace wearwell {

/// The distribution of a number as cells, each with a weight spread from its low to its high end, evenly or
/// as a curve says; ends may be infinite, and what lies in such a cell is reached never.
class CellMixture {
 public:
  void reserve(std::size_t cells) { cells_.reserve(cells); }
  /// `a` and `b` in any order; NaN makes all that is asked NaN.
  void add(double weight, double a, double b);
  void add(const CellMixture& other);
  /// All of a distribution; NaN where it is none.
  void add(const QuantityDistribution& other);
  /// A density of which the nodes of a trapezoidal rule are known: `share` of each, one even step of some
  /// parameter after the other, and the number there, `value`, which rises or falls along them. Between
  /// nodes the distribution goes on as the polynomials through those about them: cells spread evenly would
  /// widen it by a twelfth of the square of the step. Of `value` only what lies beyond `from` counts; returns that
  /// weight, of `weight` times the sum of the shares. One node is a point.
  double add_curve(double weight, std::span<const double> share, std::span<const double> value,
                   double from);
  void add_curve(double weight, std::span<const double> share, std::span<const double> value);

  /// All that lies beyond x, as distances from it: what remains to those that have come so far.
  CellMixture beyond(double x) const;

  double mass() const;  ///< the sum of the weights
  /// The share of the mass up to x.
  double cdf(double x) const;
  /// The x with cdf(x) = p, 0 < p < 1; infinity where so much is never reached.
  double quantile(double p) const;

 private:
  struct Cell {
    double weight, low, high;
    // The density at its ends, in means of it; the distribution between is the cubic that has them.
    float at_low = 1, at_high = 1;
    double below(double x) const;  // its weight below x, low < x < high
    bool cut(double from);         // leaves what lies above, low < from < high; false for nothing
  };
  std::vector<Cell> cells_;
};

}  // namespace wearwell
