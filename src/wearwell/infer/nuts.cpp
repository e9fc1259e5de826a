#include "wearwell/infer/nuts.h"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace wearwell {
namespace {

// A trajectory with a larger energy error is divergent.
constexpr double max_energy_error = 1000;

// Weights along a trajectory are exp(initial energy - energy). They are limited to e^600, which
// only a start far outside the posterior exceeds, so that sums stay finite.
double weight_of(double gain) {
  return std::exp(std::min(gain, 600.0));
}

// False if a trajectory with these end velocities and summed momentum makes a U-turn.
template <int N>
bool still_going(const SmallVector<N>& velocity_begin, const SmallVector<N>& velocity_end,
                 const SmallVector<N>& momentum_sum) {
  return velocity_begin.dot(momentum_sum) > 0 && velocity_end.dot(momentum_sum) > 0;
}

}  // namespace

template <int N>
Metric<N>::Metric(int dimension, bool dense) : dense_(dense) {
  if (dense) {
    set_covariance(SmallMatrix<N>::Identity(dimension, dimension));
  } else {
    set_variances(SmallVector<N>::Ones(dimension));
  }
}

template <int N>
void Metric<N>::set_variances(const SmallVector<N>& variances) {
  variances_ = variances;
  inverse_sd_ = variances.cwiseSqrt().cwiseInverse();
}

template <int N>
void Metric<N>::set_covariance(const SmallMatrix<N>& covariance) {
  covariance_ = covariance;
  // Momentum has the inverse covariance: with covariance = L L', solve L' p = z.
  const SmallMatrix<N> factor = covariance.llt().matrixL();
  inverse_factor_ = factor.transpose().inverse();
}

template <int N>
SmallVector<N> Metric<N>::velocity(const SmallVector<N>& momentum) const {
  if (!dense_) return variances_.cwiseProduct(momentum);
  return covariance_.lazyProduct(momentum);
}

template <int N>
SmallVector<N> Metric<N>::sample_momentum(Rng& rng) const {
  SmallVector<N> z(dense_ ? covariance_.rows() : variances_.size());
  for (double& each : z) each = rng.normal();
  if (!dense_) return inverse_sd_.cwiseProduct(z);
  return inverse_factor_.lazyProduct(z);
}

// Part of a trajectory: its momenta at both ends in the order of the walk, their sum, and the point
// sampled from it.
template <int N>
struct Nuts<N>::Subtree {
  SmallVector<N> momentum_begin, momentum_end, velocity_begin, velocity_end, momentum_sum;
  PhasePoint<N> sample;
  double weight = 0;
};

template <int N>
struct Nuts<N>::Totals {
  double initial_energy;
  int n_leapfrog = 0;
  double sum_acceptance = 0;
  bool divergent = false;
};

template <int N>
Nuts<N>::Nuts(const LogDensity& density, bool dense_metric, int max_treedepth)
    : metric(density.dimension(), dense_metric), density_(density), max_treedepth_(max_treedepth) {}

// Without momentum; false if the density is zero.
template <int N>
bool Nuts<N>::evaluate(const Eigen::VectorXd& position, PhasePoint<N>& z) const {
  z.position = position;
  z.momentum.setZero(position.size());
  z.gradient.resize(position.size());
  z.log_density = density_.value_and_gradient(
      std::span(position.data(), static_cast<std::size_t>(position.size())),
      std::span(z.gradient.data(), static_cast<std::size_t>(position.size())));
  return std::isfinite(z.log_density);
}

template <int N>
void Nuts<N>::set_position(const Eigen::VectorXd& position) {
  if (!evaluate(position, point_)) throw std::logic_error("NUTS: start outside the support");
}

template <int N>
void Nuts<N>::move_to(const Eigen::VectorXd& position) {
  PhasePoint<N> there;
  if (evaluate(position, there)) point_ = std::move(there);
}

template <int N>
double Nuts<N>::hamiltonian(const PhasePoint<N>& z) const {
  return 0.5 * z.momentum.dot(metric.velocity(z.momentum)) - z.log_density;
}

// False if the step leaves the support.
template <int N>
bool Nuts<N>::leapfrog(PhasePoint<N>& z, double epsilon) const {
  const auto n = static_cast<std::size_t>(z.position.size());
  z.momentum += 0.5 * epsilon * z.gradient;
  z.position += epsilon * metric.velocity(z.momentum);
  z.log_density = density_.value_and_gradient(std::span<const double>(z.position.data(), n),
                                              std::span(z.gradient.data(), n));
  if (std::isinf(z.log_density) && z.log_density < 0) return false;
  z.momentum += 0.5 * epsilon * z.gradient;
  return true;
}

template <int N>
bool Nuts<N>::build(int depth, double direction, PhasePoint<N>& edge, Subtree& tree, Totals& totals,
                    Rng& rng) {
  if (depth == 0) {
    ++totals.n_leapfrog;
    const bool inside = leapfrog(edge, direction * step_size);
    double energy = inside ? hamiltonian(edge) : std::numeric_limits<double>::infinity();
    if (std::isnan(energy)) energy = std::numeric_limits<double>::infinity();
    const double gain = totals.initial_energy - energy;
    if (-gain > max_energy_error) totals.divergent = true;
    tree.weight = weight_of(gain);
    totals.sum_acceptance += std::min(1.0, tree.weight);
    tree.sample = edge;
    tree.momentum_begin = tree.momentum_end = tree.momentum_sum = edge.momentum;
    tree.velocity_begin = tree.velocity_end = metric.velocity(edge.momentum);
    return !totals.divergent;
  }

  Subtree near, far;
  if (!build(depth - 1, direction, edge, near, totals, rng)) return false;
  if (!build(depth - 1, direction, edge, far, totals, rng)) return false;

  tree.weight = near.weight + far.weight;
  tree.sample = rng.uniform() * tree.weight < far.weight ? far.sample : near.sample;
  tree.momentum_sum = near.momentum_sum + far.momentum_sum;
  tree.momentum_begin = near.momentum_begin;
  tree.velocity_begin = near.velocity_begin;
  tree.momentum_end = far.momentum_end;
  tree.velocity_end = far.velocity_end;
  return still_going<N>(tree.velocity_begin, tree.velocity_end, tree.momentum_sum) &&
         still_going<N>(tree.velocity_begin, far.velocity_begin,
                        near.momentum_sum + far.momentum_begin) &&
         still_going<N>(near.velocity_end, tree.velocity_end, far.momentum_sum + near.momentum_end);
}

template <int N>
NutsStep Nuts<N>::step(Rng& rng) {
  point_.momentum = metric.sample_momentum(rng);
  Totals totals{hamiltonian(point_)};

  // The trajectory from its backward to its forward end.
  PhasePoint<N> backward = point_, forward = point_;
  SmallVector<N> backward_velocity = metric.velocity(point_.momentum),
                 forward_velocity = backward_velocity;
  SmallVector<N> backward_momentum = point_.momentum, forward_momentum = point_.momentum;
  SmallVector<N> momentum_sum = point_.momentum;
  PhasePoint<N> sample = point_;
  double weight = 1;  // of the initial point
  int depth = 0;

  Subtree tree;
  while (depth < max_treedepth_) {
    const bool ahead = rng.uniform() > 0.5;
    PhasePoint<N>& edge = ahead ? forward : backward;
    if (!build(depth, ahead ? 1 : -1, edge, tree, totals, rng)) break;
    ++depth;

    // Biased progressive sampling: prefer the new half.
    if (rng.uniform() * weight < tree.weight) sample = tree.sample;
    weight += tree.weight;

    // The old trajectory and the new subtree meet between `inner` (old side) and tree.*_begin (new
    // side). A backward subtree is reversed in time, which does not change the signs of the
    // products below.
    const SmallVector<N> old_sum = momentum_sum;
    const SmallVector<N> inner_velocity = ahead ? forward_velocity : backward_velocity;
    const SmallVector<N> inner_momentum = ahead ? forward_momentum : backward_momentum;
    const SmallVector<N> outer_velocity = ahead ? backward_velocity : forward_velocity;
    momentum_sum += tree.momentum_sum;
    (ahead ? forward_velocity : backward_velocity) = tree.velocity_end;
    (ahead ? forward_momentum : backward_momentum) = tree.momentum_end;

    const bool going =
        still_going<N>(outer_velocity, tree.velocity_end, momentum_sum) &&
        still_going<N>(outer_velocity, tree.velocity_begin, old_sum + tree.momentum_begin) &&
        still_going<N>(inner_velocity, tree.velocity_end, tree.momentum_sum + inner_momentum);
    if (!going) break;
  }

  point_ = sample;
  return {totals.sum_acceptance / totals.n_leapfrog, depth, totals.n_leapfrog, totals.divergent,
          hamiltonian(point_)};
}

template <int N>
void Nuts<N>::find_reasonable_step_size(Rng& rng) {
  const PhasePoint<N> start = point_;
  const double target = std::log(0.8);
  int direction = 0;
  while (step_size > 1e-12 && step_size < 1e7) {
    PhasePoint<N> z = start;
    z.momentum = metric.sample_momentum(rng);
    const double before = hamiltonian(z);
    const double gain =
        leapfrog(z, step_size) ? before - hamiltonian(z) : -std::numeric_limits<double>::infinity();
    const int now = gain > target ? 1 : -1;
    if (direction != 0 && now != direction) return;
    direction = now;
    step_size *= direction == 1 ? 2 : 0.5;
  }
}

template class Metric<1>;
template class Metric<2>;
template class Metric<3>;
template class Metric<4>;
template class Metric<Eigen::Dynamic>;
template class Nuts<1>;
template class Nuts<2>;
template class Nuts<3>;
template class Nuts<4>;
template class Nuts<Eigen::Dynamic>;

}  // namespace wearwell
