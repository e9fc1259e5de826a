#pragma once

#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "wearwell/bayes/log_density.h"

namespace wearwell {

/// A density from a formula that returns its log and fills in its gradient.
class Formula final : public LogDensity {
 public:
  using F = std::function<double(std::span<const double> x, std::span<double> gradient)>;
  Formula(int dimension, F f) : dimension_(dimension), f_(std::move(f)) {}

  int dimension() const override { return dimension_; }
  double value(std::span<const double> x) const override {
    std::vector<double> ignored(x.size());
    return f_(x, ignored);
  }
  double value_and_gradient(std::span<const double> x, std::span<double> gradient) const override {
    return f_(x, gradient);
  }

 private:
  int dimension_;
  F f_;
};

}  // namespace wearwell
