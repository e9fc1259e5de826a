#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace wearwell {

/// The distribution over items of a quantity known along lines of a standard normal score, at equal
/// steps of the score. Interpolates by the polynomial through six neighbours, so that quantiles have
/// no cell noise.
class NormalLines {
 public:
  /// `weight` of the line; `value` at the scores `first`, `first + step`, ... It is constant beyond
  /// both ends.
  void add(double weight, double first, double step, std::span<const double> value);

  bool empty() const { return lines_.empty(); }
  /// The fraction of items up to x; NaN if a value is NaN.
  double cdf(double x) const;
  /// The x with cdf(x) = p, 0 < p < 1; infinity if that fraction never reaches a finite value.
  double quantile(double p) const;

 private:
  struct Line {
    double weight, first, step;
    std::size_t begin, end;  // among values_
    bool monotone;
  };
  double below(const Line& line, double x) const;
  double score_at(const Line& line, std::size_t i, double x) const;

  std::vector<Line> lines_;
  std::vector<double> values_;
  double weight_ = 0;
  double low_ = std::numeric_limits<double>::infinity();  // of finite values
  double high_ = -std::numeric_limits<double>::infinity();
  bool defined_ = true;
};

}  // namespace wearwell
