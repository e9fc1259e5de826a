#pragma once

#include <Eigen/Dense>

#include "wearwell/base/rng.h"
#include "wearwell/bayes/draws.h"
#include "wearwell/bayes/log_density.h"

namespace wearwell {

/// Non-allocating vectors and matrices of N variables. N is Eigen::Dynamic (up to max_dimension),
/// or a small compile-time constant, which is faster for 1 to 4 parameters.
template <int N>
inline constexpr int max_size = N == Eigen::Dynamic ? max_dimension : N;
template <int N>
using SmallVector = Eigen::Matrix<double, N, 1, 0, max_size<N>, 1>;
template <int N>
using SmallMatrix = Eigen::Matrix<double, N, N, 0, max_size<N>, max_size<N>>;

/// The kinetic energy's inverse mass matrix: an estimate of the posterior covariance, diagonal or
/// dense.
template <int N>
class Metric {
 public:
  explicit Metric(int dimension, bool dense);

  void set_variances(const SmallVector<N>& variances);
  void set_covariance(const SmallMatrix<N>& covariance);

  bool dense() const { return dense_; }
  const SmallVector<N>& variances() const { return variances_; }
  const SmallMatrix<N>& covariance() const { return covariance_; }

  SmallVector<N> velocity(const SmallVector<N>& momentum) const;
  SmallVector<N> sample_momentum(Rng& rng) const;

 private:
  bool dense_;
  SmallVector<N> variances_, inverse_sd_;
  SmallMatrix<N> covariance_, inverse_factor_;
};

/// A position with cached density and gradient.
template <int N>
struct PhasePoint {
  SmallVector<N> position, momentum, gradient;
  double log_density = 0;
};

/// The no-U-turn sampler with multinomial sampling along the trajectory (Hoffman and Gelman 2014;
/// Betancourt 2017, appendix A), with the additional U-turn checks between subtrees of Stan 2.21
/// and later.
template <int N>
class Nuts {
 public:
  Nuts(const LogDensity& density, bool dense_metric, int max_treedepth);

  /// Throws std::logic_error if the density is zero there.
  void set_position(const Eigen::VectorXd& position);
  /// The same for a proposal accepted by its value; keeps the position if the density has no finite
  /// gradient there.
  void move_to(const Eigen::VectorXd& position);

  /// One transition: moves the position and returns its diagnostics.
  NutsStep step(Rng& rng);

  /// A step size with acceptance near 0.8 for a single leapfrog, found by doubling or halving
  /// (Stan's heuristic).
  void find_reasonable_step_size(Rng& rng);

  const PhasePoint<N>& point() const { return point_; }

  double step_size = 1;
  Metric<N> metric;

 private:
  struct Subtree;
  struct Totals;
  bool evaluate(const Eigen::VectorXd& position, PhasePoint<N>& z) const;
  bool leapfrog(PhasePoint<N>& z, double epsilon) const;
  double hamiltonian(const PhasePoint<N>& z) const;
  bool build(int depth, double direction, PhasePoint<N>& edge, Subtree& tree, Totals& totals,
             Rng& rng);

  const LogDensity& density_;
  int max_treedepth_;
  PhasePoint<N> point_;
};

}  // namespace wearwell
