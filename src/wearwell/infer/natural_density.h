#pragma once

#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/maximize.h"
#include "wearwell/infer/whitened.h"

namespace wearwell {

/// Prior times likelihood as a density of the parameters in their own units, without the Jacobian
/// of any transform. Refers to `posterior`, which must outlive it.
class NaturalDensity final : public LogDensity {
 public:
  explicit NaturalDensity(const Posterior& posterior) : posterior_(posterior) {}
  int dimension() const override { return posterior_.dimension(); }
  double value(std::span<const double> x) const override { return posterior_.natural_value(x); }
  double value_and_gradient(std::span<const double> x, std::span<double> gradient) const override {
    return posterior_.natural_value_and_gradient(x, gradient);
  }

 private:
  const Posterior& posterior_;
};

/// The width of the posterior along each parameter, to first order.
Eigen::VectorXd natural_widths(const Posterior& posterior, const Whitening& whitening);

/// Just inside the support, because the density may be NaN at the bound.
Box natural_box(const Posterior& posterior, const Eigen::VectorXd& width);

}  // namespace wearwell
