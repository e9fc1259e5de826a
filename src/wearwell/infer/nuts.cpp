#include "wearwell/infer/nuts.h"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace wearwell {
namespace {

// A trajectory whose energy error exceeds this has left the region where the integrator follows the
// posterior.
constexpr double max_energy_error = 1000;

double log_sum_exp(double a, double b) {
  const double high = std::max(a, b);
  if (std::isinf(high)) return high;
  return high + std::log1p(std::exp(std::min(a, b) - high));
}

// False once a trajectory with these end velocities and summed momentum has turned back on itself.
bool still_going(const SmallVector& velocity_begin, const SmallVector& velocity_end,
                 const SmallVector& momentum_sum) {
  return velocity_begin.dot(momentum_sum) > 0 && velocity_end.dot(momentum_sum) > 0;
}

}  // namespace

Metric::Metric(int dimension, bool dense) : dense_(dense) {
  if (dense) {
    set_covariance(Eigen::MatrixXd::Identity(dimension, dimension));
  } else {
    set_variances(Eigen::VectorXd::Ones(dimension));
  }
}

void Metric::set_variances(const Eigen::VectorXd& variances) {
  variances_ = variances;
  inverse_sd_ = variances.cwiseSqrt().cwiseInverse();
}

void Metric::set_covariance(const Eigen::MatrixXd& covariance) {
  covariance_ = covariance;
  // Momentum has the inverse covariance: with covariance = L L', solve L' p = z.
  const Eigen::MatrixXd factor = covariance.llt().matrixL();
  inverse_factor_ = factor.transpose().inverse();
}

SmallVector Metric::velocity(const SmallVector& momentum) const {
  if (!dense_) return variances_.cwiseProduct(momentum);
  return covariance_.lazyProduct(momentum);
}

SmallVector Metric::sample_momentum(Rng& rng) const {
  SmallVector z(dense_ ? covariance_.rows() : variances_.size());
  for (double& each : z) each = rng.normal();
  if (!dense_) return inverse_sd_.cwiseProduct(z);
  return inverse_factor_.lazyProduct(z);
}

// Part of a trajectory: its momenta at both ends in the order of the walk, their sum, and the point
// sampled from it.
struct Nuts::Subtree {
  SmallVector momentum_begin, momentum_end, velocity_begin, velocity_end, momentum_sum;
  PhasePoint sample;
  double log_weight = -std::numeric_limits<double>::infinity();
};

struct Nuts::Totals {
  double initial_energy;
  int n_leapfrog = 0;
  double sum_acceptance = 0;
  bool divergent = false;
};

Nuts::Nuts(const LogDensity& density, bool dense_metric, int max_treedepth)
    : metric(density.dimension(), dense_metric), density_(density), max_treedepth_(max_treedepth) {}

void Nuts::set_position(const Eigen::VectorXd& position) {
  point_.position = position;
  point_.momentum.setZero(position.size());
  point_.gradient.resize(position.size());
  point_.log_density = density_.value_and_gradient(
      std::span(position.data(), static_cast<std::size_t>(position.size())),
      std::span(point_.gradient.data(), static_cast<std::size_t>(position.size())));
  if (!std::isfinite(point_.log_density)) throw std::logic_error("NUTS: start outside the support");
}

double Nuts::hamiltonian(const PhasePoint& z) const {
  return 0.5 * z.momentum.dot(metric.velocity(z.momentum)) - z.log_density;
}

// False when the step left the support.
bool Nuts::leapfrog(PhasePoint& z, double epsilon) const {
  const auto n = static_cast<std::size_t>(z.position.size());
  z.momentum += 0.5 * epsilon * z.gradient;
  z.position += epsilon * metric.velocity(z.momentum);
  z.log_density = density_.value_and_gradient(std::span<const double>(z.position.data(), n),
                                              std::span(z.gradient.data(), n));
  if (std::isinf(z.log_density) && z.log_density < 0) return false;
  z.momentum += 0.5 * epsilon * z.gradient;
  return true;
}

bool Nuts::build(int depth, double direction, PhasePoint& edge, Subtree& tree, Totals& totals,
                 Rng& rng) {
  if (depth == 0) {
    ++totals.n_leapfrog;
    const bool inside = leapfrog(edge, direction * step_size);
    double energy = inside ? hamiltonian(edge) : std::numeric_limits<double>::infinity();
    if (std::isnan(energy)) energy = std::numeric_limits<double>::infinity();
    const double gain = totals.initial_energy - energy;
    if (-gain > max_energy_error) totals.divergent = true;
    tree.log_weight = gain;
    totals.sum_acceptance += gain > 0 ? 1 : std::exp(gain);
    tree.sample = edge;
    tree.momentum_begin = tree.momentum_end = tree.momentum_sum = edge.momentum;
    tree.velocity_begin = tree.velocity_end = metric.velocity(edge.momentum);
    return !totals.divergent;
  }

  Subtree near, far;
  if (!build(depth - 1, direction, edge, near, totals, rng)) return false;
  if (!build(depth - 1, direction, edge, far, totals, rng)) return false;

  tree.log_weight = log_sum_exp(near.log_weight, far.log_weight);
  const bool take_far = far.log_weight > tree.log_weight ||
                        rng.uniform() < std::exp(far.log_weight - tree.log_weight);
  tree.sample = take_far ? far.sample : near.sample;
  tree.momentum_sum = near.momentum_sum + far.momentum_sum;
  tree.momentum_begin = near.momentum_begin;
  tree.velocity_begin = near.velocity_begin;
  tree.momentum_end = far.momentum_end;
  tree.velocity_end = far.velocity_end;
  return still_going(tree.velocity_begin, tree.velocity_end, tree.momentum_sum) &&
         still_going(tree.velocity_begin, far.velocity_begin,
                     near.momentum_sum + far.momentum_begin) &&
         still_going(near.velocity_end, tree.velocity_end, far.momentum_sum + near.momentum_end);
}

NutsStep Nuts::step(Rng& rng) {
  point_.momentum = metric.sample_momentum(rng);
  Totals totals{hamiltonian(point_)};

  // The trajectory from its backward to its forward end.
  PhasePoint backward = point_, forward = point_;
  SmallVector backward_velocity = metric.velocity(point_.momentum),
              forward_velocity = backward_velocity;
  SmallVector backward_momentum = point_.momentum, forward_momentum = point_.momentum;
  SmallVector momentum_sum = point_.momentum;
  PhasePoint sample = point_;
  double log_weight = 0;  // of the initial point
  int depth = 0;

  Subtree tree;
  while (depth < max_treedepth_) {
    const bool ahead = rng.uniform() > 0.5;
    PhasePoint& edge = ahead ? forward : backward;
    if (!build(depth, ahead ? 1 : -1, edge, tree, totals, rng)) break;
    ++depth;

    // Biased progressive sampling: prefer the new half.
    if (tree.log_weight > log_weight || rng.uniform() < std::exp(tree.log_weight - log_weight)) {
      sample = tree.sample;
    }
    log_weight = log_sum_exp(log_weight, tree.log_weight);

    // The old trajectory and the new subtree meet between `inner` (old side) and tree.*_begin (new
    // side). A backward subtree is walked against time, which leaves the signs of all products
    // below as they are.
    const SmallVector old_sum = momentum_sum;
    const SmallVector inner_velocity = ahead ? forward_velocity : backward_velocity;
    const SmallVector inner_momentum = ahead ? forward_momentum : backward_momentum;
    const SmallVector outer_velocity = ahead ? backward_velocity : forward_velocity;
    momentum_sum += tree.momentum_sum;
    (ahead ? forward_velocity : backward_velocity) = tree.velocity_end;
    (ahead ? forward_momentum : backward_momentum) = tree.momentum_end;

    const bool going =
        still_going(outer_velocity, tree.velocity_end, momentum_sum) &&
        still_going(outer_velocity, tree.velocity_begin, old_sum + tree.momentum_begin) &&
        still_going(inner_velocity, tree.velocity_end, tree.momentum_sum + inner_momentum);
    if (!going) break;
  }

  point_ = sample;
  return {totals.sum_acceptance / totals.n_leapfrog, depth, totals.n_leapfrog, totals.divergent,
          hamiltonian(point_)};
}

void Nuts::find_reasonable_step_size(Rng& rng) {
  const PhasePoint start = point_;
  const double target = std::log(0.8);
  int direction = 0;
  while (step_size > 1e-12 && step_size < 1e7) {
    PhasePoint z = start;
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

}  // namespace wearwell
