#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>

#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/ridge_map.h"
#include "wearwell/infer/whitened.h"

namespace wearwell {

/// Coordinates in which a posterior of four parameters is to be round and of unit size: lines of a lattice (lattice.h) run
/// along the last one.
class LatticeChart {
 public:
  using Z = std::array<double, 4>;
  virtual ~LatticeChart() = default;
  /// On the real line; returns the log of the volume of z by that of u, less log_scale().
  virtual double to_real(const Eigen::Vector4d& u, Z& z) const = 0;
  virtual double log_scale() const = 0;

  /// Where lines run along one parameter, the others staying where they are: which.
  virtual std::optional<std::size_t> line_parameter() const { return {}; }
  /// That parameter on the real line, and its part of what to_real returns.
  struct OnLine {
    double z = 0, log_slope = 0;
  };
  virtual OnLine on_line(double) const { return {}; }
};

/// By the covariance. Lines along the parameter that the others hold closest, so that they follow a narrow ridge in it
/// that bends; parameters between two bounds are bent, so that tails as exp(-|z|) become normal ones.
std::unique_ptr<const LatticeChart> straight_chart(const Posterior& posterior,
                                                   const Whitening& whitening);

/// Along the ridge of a funnel, askew; `map` must live on.
std::unique_ptr<const LatticeChart> ridge_chart(const RidgeMap& map);

}  // namespace wearwell
