#pragma once

#include <Eigen/Dense>

#include "wearwell/base/rng.h"
#include "wearwell/bayes/draws.h"
#include "wearwell/bayes/log_density.h"

namespace wearwell {

/// A vector of at most max_dimension entries that never allocates.
using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, max_dimension, 1>;

/// The kinetic energy's inverse mass matrix: an estimate of the posterior covariance, diagonal or
/// dense.
class Metric {
 public:
  explicit Metric(int dimension, bool dense);

  void set_variances(const Eigen::VectorXd& variances);
  void set_covariance(const Eigen::MatrixXd& covariance);

  bool dense() const { return dense_; }
  const Eigen::VectorXd& variances() const { return variances_; }
  const Eigen::MatrixXd& covariance() const { return covariance_; }

  SmallVector velocity(const SmallVector& momentum) const;
  SmallVector sample_momentum(Rng& rng) const;

 private:
  bool dense_;
  Eigen::VectorXd variances_, inverse_sd_;
  Eigen::MatrixXd covariance_, inverse_factor_;
};

/// A position with all that the next step needs of it.
struct PhasePoint {
  SmallVector position, momentum, gradient;
  double log_density = 0;
};

/// The no-U-turn sampler with multinomial sampling along the trajectory (Hoffman and Gelman 2014;
/// Betancourt 2017, appendix A), with the extra U-turn checks between subtrees that Stan has had
/// since 2.21.
class Nuts {
 public:
  Nuts(const LogDensity& density, bool dense_metric, int max_treedepth);

  /// Throws std::logic_error when the density is zero there.
  void set_position(const Eigen::VectorXd& position);

  /// One transition: moves the position and says how.
  NutsStep step(Rng& rng);

  /// A step size with acceptance near 0.8 for a single leapfrog, found by doubling or halving
  /// (Stan's heuristic).
  void find_reasonable_step_size(Rng& rng);

  const PhasePoint& point() const { return point_; }

  double step_size = 1;
  Metric metric;

 private:
  struct Subtree;
  struct Totals;
  bool leapfrog(PhasePoint& z, double epsilon) const;
  double hamiltonian(const PhasePoint& z) const;
  bool build(int depth, double direction, PhasePoint& edge, Subtree& tree, Totals& totals,
             Rng& rng);

  const LogDensity& density_;
  int max_treedepth_;
  PhasePoint point_;
};

}  // namespace wearwell
