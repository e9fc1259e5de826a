#pragma once

#include <cmath>

namespace wearwell {

/// A sum with what rounding took from it (Neumaier, ZAMM 54, 1974, p. 39): right to the last digits however many terms it
/// has, unless they cancel. Not finite where a term is not.
class CompensatedSum {
 public:
  void add(double term) {
    const double both = sum_ + term;
    lost_ += std::abs(sum_) >= std::abs(term) ? (sum_ - both) + term : (term - both) + sum_;
    sum_ = both;
  }
  double total() const { return std::isfinite(sum_) ? sum_ + lost_ : sum_; }

 private:
  double sum_ = 0, lost_ = 0;
};

}  // namespace wearwell
