#include "wearwell/infer/box_integrator.h"

#include <fmt/format.h>

#include <cmath>
#include <queue>

#include "wearwell/base/monitor.h"
#include "wearwell/math/view.h"

namespace wearwell {
namespace {

// Nodes per axis and the largest mass of one cell, by dimension: few evaluations, but cells small
// enough that evenly spread mass keeps quantiles within about 0.1 % of a standard deviation.
constexpr std::array<int, max_exact_dimension + 1> nodes_per_axis = {0, 10, 7, 5, 4};
constexpr std::array<double, max_exact_dimension + 1> max_cell_mass = {0, 1. / 40, 1. / 80,
                                                                       1. / 400, 1. / 1000};

// A larger tolerance than that of studies allows larger cells.
double most_mass(int dimension, double tolerance) {
  constexpr double of_studies = 1e-4;
  return max_cell_mass[dimension] * std::max(1.0, tolerance / of_studies);
}

}  // namespace

BoxIntegrator::BoxIntegrator(const Posterior& posterior, const Whitening& whitening,
                             const ExactSettings& settings, const Posterior& shape,
                             bool along_ridge)
    : posterior_(posterior),
      own_shape_(&shape == &posterior),
      settings_(settings),
      d_(posterior.dimension()),
      p_(nodes_per_axis[d_]),
      rule_(gauss_legendre(p_)),
      points_(static_cast<std::size_t>(std::pow(p_, d_))),
      map_(shape, whitening, !along_ridge),
      stride_(static_cast<std::size_t>(std::pow(p_, map_.axis()))),
      reference_(own_shape_ ? map_.highest() : posterior.value(view(whitening.center))),
      log_jacobian_(map_.at(0).log_jacobian) {
  // Parameters are standardized about the center by their first-order spread.
  center_x_.resize(d_);
  scale_x_.setZero(d_);
  posterior_.to_natural(view(whitening.center), view(center_x_));
  for (int a = 0; a < d_; ++a) {
    Eigen::VectorXd moved = whitening.center + whitening.scale.col(a), x(d_);
    posterior_.to_natural(view(moved), view(x));
    scale_x_ += (x - center_x_).cwiseAbs2();
  }
  scale_x_ = scale_x_.cwiseSqrt();
  scale_x_ = scale_x_.cwiseMax(std::numeric_limits<double>::min());
  // The derivative of each coordinate by each u, at the center.
  const RidgeMap::Frame frame = map_.at(0);
  Coordinates u{}, from, to;
  map_.to_real(frame, u, from);
  for (int a = 0; a < d_; ++a) {
    u.fill(0);
    u[a] = 1;
    map_.to_real(a == map_.axis() ? map_.at(1) : frame, u, to);
    for (int i = 0; i < d_; ++i) unit_[a][i] = std::abs(to[i] - from[i]);
  }
  most_weight_ = std::pow(*std::max_element(rule_.weight.begin(), rule_.weight.end()), d_ - 1);
  for (int i = 0; i < p_; ++i) {
    top_.push_back(rule_.weight[i] * std::legendre(p_ - 1, rule_.node[i]));
    next_.push_back(rule_.weight[i] * std::legendre(p_ - 2, rule_.node[i]));
  }
}

ExactPosterior BoxIntegrator::run() {
  moments_exist_ = settings_.second_moments;
  if (own_shape_ && map_.endless())
    failure_ = "its mass is unbounded: the posterior is improper or far too wide";
  lower_.fill(-6);
  upper_.fill(6);
  lower_[map_.axis()] = map_.lower();
  upper_[map_.axis()] = map_.upper();
  reach_maxima();
  add_grid(lower_, upper_, d_ <= 2 ? 4 : 2);
  halve_at_maxima();
  do {
    refine();
  } while (failure_.empty() && (grow() || restandardize() || reconcile() || inspect()));
  if (failure_.empty()) verify();
  return result();
}

Eigen::VectorXd BoxIntegrator::natural(const Coordinates& u) const {
  Coordinates z, x;
  map_.to_real(map_.at(u[map_.axis()]), u, z);
  to_natural(z, x);
  return Eigen::Map<const Eigen::VectorXd>(x.data(), d_);
}

std::array<RidgeMap::Frame, 10> BoxIntegrator::frames_of(const Cell& cell) const {
  const int axis = map_.axis();
  std::array<RidgeMap::Frame, 10> frames;
  for (int i = 0; i < p_; ++i) {
    frames[i] = map_.at(0.5 * (cell.lower[axis] + cell.upper[axis]) +
                        0.5 * rule_.node[i] * (cell.upper[axis] - cell.lower[axis]));
  }
  return frames;
}

BoxIntegrator::Cell& BoxIntegrator::add(const Coordinates& lower, const Coordinates& upper) {
  Cell cell{lower, upper, values_.size()};
  Coordinates u, z, x;
  const double v = volume(cell);
  const std::array<RidgeMap::Frame, 10> frames = frames_of(cell);
  for (std::size_t i = 0; i < points_; ++i) {
    node(cell, i, u);
    const RidgeMap::Frame& frame = frames[i / stride_ % p_];
    map_.to_real(frame, u, z);
    const double log_density =
        posterior_.value(std::span(z.data(), static_cast<std::size_t>(d_))) - reference_;
    if (log_density > 300) failure_ = "the density is unbounded";
    highest_ = std::max(highest_, log_density);
    const double f = std::exp(log_density + frame.log_jacobian - log_jacobian_);
    values_.push_back(f);
    if (f == 0) continue;
    to_natural(z, x);
    double moments = 1;
    for (int a = 0; a < d_; ++a) {
      const double t = (x[a] - center_x_[a]) / scale_x_[a];
      moments += t * t;
    }
    const double weight = node_weight(i) * v * f;
    cell.mass += weight;
    if (!std::isfinite(moments)) overflowed_ = true;
    cell.control += weight * (moments_exist_ && !overflowed_ ? moments : 1);
  }
  evaluations_ += static_cast<long>(points_);
  cell.error = cell.control;  // until compared with its halves
  look_along_axes(cell);
  cells_.push_back(cell);
  return cells_.back();
}

void BoxIntegrator::look_along_axes(Cell& cell) const {
  double largest = -1, mean = 0;
  for (std::size_t i = 0; i < points_; ++i) mean += node_weight(i) * values_[cell.first + i];
  const double decay = 2.0 * p_ / (p_ - 1);
  cell.tail = 0;
  std::size_t stride = 1;
  for (int a = 0; a < d_; ++a, stride *= p_) {
    double energy = 0, of_mean = 0;
    for (std::size_t line = 0; line < points_; ++line) {
      if (line / stride % p_ != 0) continue;
      double top = 0, next = 0;
      for (int i = 0; i < p_; ++i) {
        const double f = values_[cell.first + line + i * stride];
        top += top_[i] * f;
        next += next_[i] * f;
      }
      const double high = std::abs(top) + std::abs(next);
      energy += high;
      of_mean += high * node_weight(line) / rule_.weight[0];
    }
    if (mean > 0) cell.tail += std::pow(std::min(1.0, of_mean / mean), decay);
    // Ties go to the longer side, so that a cell without structure stays a cube.
    energy += 1e-300 * (cell.upper[a] - cell.lower[a]);
    if (energy > largest) {
      largest = energy;
      cell.axis = a;
    }
  }
}

void BoxIntegrator::add_grid(const Coordinates& lower, const Coordinates& upper, int parts) {
  const auto count = static_cast<int>(std::pow(parts, d_));
  for (int i = 0; i < count; ++i) {
    Coordinates a{}, b{};
    for (int axis = 0, rest = i; axis < d_; ++axis, rest /= parts) {
      const double step = (upper[axis] - lower[axis]) / parts;
      a[axis] = lower[axis] + step * (rest % parts);
      b[axis] = rest % parts == parts - 1 ? upper[axis] : a[axis] + step;
    }
    add(a, b);
    tree_.add(a, b, cells_.size() - 1);
  }
}

void BoxIntegrator::refine() {
  sum();
  const double most = most_mass(d_, settings_.tolerance);
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry> queue;
  const auto priority = [&](const Cell& cell) {
    const double share = cell.mass / mass_;
    return std::max(cell.error / control_, share > most ? share : 0.0);
  };
  for (std::size_t i = 0; i < cells_.size(); ++i) queue.emplace(priority(cells_[i]), i);
  while (failure_.empty() && !queue.empty()) {
    if (settings_.stop.stop_requested()) throw Cancelled();
    const long before = evaluations_;
    const auto [urgency, i] = queue.top();
    if (error_ <= settings_.tolerance * control_ && urgency <= most) break;
    if (evaluations_ >= settings_.max_evaluations) {
      failure_ = fmt::format("no convergence in {} evaluations", evaluations_);
      break;
    }
    queue.pop();
    halve(i);
    if (settings_.progress) settings_.progress->advance(evaluations_ - before);
    if (overflowed_) {
      overflowed_ = false;
      forget_moments();
      return refine();
    }
    for (const std::size_t half : {i, cells_.size() - 1})
      queue.emplace(priority(cells_[half]), half);
  }
}

void BoxIntegrator::halve(std::size_t i, int a) {
  const Cell parent = cells_[i];
  Coordinates middle_upper = parent.upper, middle_lower = parent.lower;
  middle_upper[a] = middle_lower[a] = 0.5 * (parent.lower[a] + parent.upper[a]);
  add(middle_lower, parent.upper);
  add(parent.lower, middle_upper);
  Cell& first = cells_[i];
  first = cells_.back();  // reuses the parent's index; its old values stay unused in the arena
  cells_.pop_back();
  Cell& second = cells_.back();
  tree_.halve(i, a, middle_upper[a], false, cells_.size() - 1);
  // Either half may contain what the other missed, even if its nodes are zero.
  const double difference = std::abs(parent.control - first.control - second.control);
  for (Cell* half : {&first, &second})
    half->error = std::max(0.5 * difference, half->tail * half->control);
  mass_ += first.mass + second.mass - parent.mass;
  control_ += first.control + second.control - parent.control;
  error_ += first.error + second.error - parent.error;
}

}  // namespace wearwell
