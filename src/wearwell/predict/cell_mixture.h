#pragma once

#include <span>
#include <vector>

#include "wearwell/bayes/weighted_draws.h"

namespace wearwell {

/// The distribution of a quantity as cells, each with a weight spread from its low to its high end,
/// evenly or along a curve. Ends can be infinite; the mass in such a cell is never reached.
class CellMixture {
 public:
  void reserve(std::size_t cells) { cells_.reserve(cells); }
  /// `a` and `b` in any order; a NaN makes all results NaN.
  void add(double weight, double a, double b);
  void add(const CellMixture& other);
  /// Adds a whole distribution; an undefined one gives NaN.
  void add(const QuantityDistribution& other);
  /// Adds a density known at the nodes of a trapezoidal rule: the `share` of each equally spaced
  /// node and the monotone quantity there, `value`. Between nodes it uses polynomial interpolation,
  /// because evenly filled cells would increase the variance by a twelfth of the squared step. Only
  /// `value` beyond `from` counts; returns that part of `weight` times the sum of the shares. One
  /// node is a point.
  double add_curve(double weight, std::span<const double> share, std::span<const double> value,
                   double from);
  void add_curve(double weight, std::span<const double> share, std::span<const double> value);

  /// The distribution beyond x, as distances from x: the remaining life of items that have reached
  /// x.
  CellMixture beyond(double x) const;

  std::size_t size() const { return cells_.size(); }
  /// Replaces all cells by at most `most` + 2: the same cdf at their ends, which lie closer in the
  /// tails (down to a share of 1e-9), and the same density there where it is smooth. Fewer cells
  /// than that, and a mixture with a NaN, stay.
  void condense(std::size_t most);
  /// Condenses to 512 cells where there are more than `most`, so that a long sum takes little memory.
  void limit_size(std::size_t most = 8192);

  double mass() const;  ///< the sum of the weights
  /// Infinite where mass is never reached; NaN without mass.
  double mean() const;
  /// The fraction of the mass up to x.
  double cdf(double x) const;
  /// The x with cdf(x) = p, 0 < p < 1; infinity if that fraction is never reached.
  double quantile(double p) const;

 private:
  struct Cell {
    double weight, low, high;
    // The density at its ends relative to its mean; the cdf between is the matching cubic.
    float at_low = 1, at_high = 1;
    double below(double x) const;  // its weight below x, low < x < high
    bool cut(double from);         // keeps the part above, low < from < high; false if it is empty
  };
  std::vector<Cell> cells_;
};

}  // namespace wearwell
