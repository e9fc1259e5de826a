#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace wearwell {

/// The distribution over items of a number that is known along lines of a standard normal score: of each line at even
/// steps of the score. Between these it goes on as the polynomial through six neighbours, so that a quantile has no noise of cells.
class NormalLines {
 public:
  /// `weight` of the line; `value` at the scores `first`, `first + step`, ... Beyond both ends the number stays as it is there.
  void add(double weight, double first, double step, std::span<const double> value);

  bool empty() const { return lines_.empty(); }
  /// The share of items up to x; NaN where a number is NaN.
  double cdf(double x) const;
  /// The x with cdf(x) = p, 0 < p < 1; infinity where so many never reach a finite number.
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
