#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>

#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/ridge_map.h"
#include "wearwell/infer/whitened.h"

namespace wearwell {

/// Coordinates in which a posterior of four parameters is nearly standard normal; lines of a
/// lattice (lattice.h) run along the last one.
class LatticeChart {
 public:
  using Z = std::array<double, 4>;
  virtual ~LatticeChart() = default;
  /// To the real line; returns the log volume ratio of z to u, minus log_scale().
  virtual double to_real(const Eigen::Vector4d& u, Z& z) const = 0;
  virtual double log_scale() const = 0;

  /// The parameter along which lines run with the others fixed, if any.
  virtual std::optional<std::size_t> line_parameter() const { return {}; }
  /// That parameter on the real line, and its part of the result of to_real.
  struct OnLine {
    double z = 0, log_slope = 0;
  };
  virtual OnLine on_line(double) const { return {}; }
};

/// By the covariance. Lines along the parameter that the others determine best, so that they follow
/// a narrow curved ridge; parameters between two bounds are Gaussianized, so that tails like
/// exp(-|z|) become normal.
std::unique_ptr<const LatticeChart> straight_chart(const Posterior& posterior,
                                                   const Whitening& whitening);

/// Along the ridge of a funnel, sheared; `map` must outlive it.
std::unique_ptr<const LatticeChart> ridge_chart(const RidgeMap& map);

}  // namespace wearwell
