#pragma once

#include <vector>

namespace wearwell {

/// The distribution of a number as cells, each with a weight spread evenly from its low to its high
/// end; ends may be infinite, and what lies in such a cell is reached never.
class CellMixture {
 public:
  void reserve(std::size_t cells) { cells_.reserve(cells); }
  /// `a` and `b` in any order; NaN makes all that is asked NaN.
  void add(double weight, double a, double b);
  void add(const CellMixture& other);
  /// Only what of such a cell lies beyond x, as a distance from x; returns its weight.
  double add_beyond(double weight, double a, double b, double x);

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
  };
  std::vector<Cell> cells_;
};

}  // namespace wearwell
