#include "wearwell/infer/exact.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <queue>

#include "wearwell/infer/cell_parts.h"
#include "wearwell/infer/lattice.h"
#include "wearwell/infer/ridge_map.h"
#include "wearwell/math/quadrature.h"
#include "wearwell/math/view.h"

namespace wearwell {
namespace {

constexpr int max_d = max_exact_dimension;
using Coordinates = RidgeMap::Coordinates;
static_assert(RidgeMap::most == max_d);

// Nodes per axis and the largest mass of one cell, by dimension: few enough evaluations, cells
// small enough that spreading a node's mass evenly over its cell keeps quantiles within about 0.1 %
// of a standard deviation.
constexpr std::array<int, max_d + 1> nodes_per_axis = {0, 10, 7, 5, 4};
constexpr std::array<double, max_d + 1> max_cell_mass = {0, 1. / 40, 1. / 80, 1. / 400, 1. / 1000};

// Growth ends where no proper posterior reaches: a factor of e^200 on a half-line (beyond, densities
// of heavy tails end to be numbers), 10^12 typical changes on a whole line.
constexpr double farthest_on_half_line = 200, farthest_on_whole_line = 1e12;

// Nodes with less of the mass are left out of the result.
constexpr double negligible_share = 1e-9;

// What a sound integral may differ by (log) from the highest density that the walk along the ridge
// met, and from its Laplace approximation.
constexpr double most_above = 3, most_from_laplace = 4;

struct Cell {
  Coordinates lower, upper;
  std::size_t first;  // of its values in the arena
  double mass;        // integral of the density
  double control;  // integral of density x (1 + squared standardized parameters): mass and second
                   // moments in one
  double error;    // estimated, of `control`
  int axis;        // along which it resolves worst
};

class Integrator {
 public:
  Integrator(const Posterior& posterior, const Whitening& whitening, const ExactSettings& settings,
             const Posterior& shape)
      : posterior_(posterior),
        own_shape_(&shape == &posterior),
        settings_(settings),
        d_(posterior.dimension()),
        p_(nodes_per_axis[d_]),
        rule_(gauss_legendre(p_)),
        points_(static_cast<std::size_t>(std::pow(p_, d_))),
        map_(shape, whitening),
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
    // How far each coordinate goes with each u, at the center.
    const RidgeMap::Frame frame = map_.at(0);
    Coordinates u{}, from, to;
    map_.to_real(frame, u, from);
    for (int a = 0; a < d_; ++a) {
      u.fill(0);
      u[a] = 1;
      map_.to_real(a == map_.axis() ? map_.at(1) : frame, u, to);
      for (int i = 0; i < d_; ++i) unit_[a][i] = std::abs(to[i] - from[i]);
    }
    for (int i = 0; i < p_; ++i) {
      top_.push_back(rule_.weight[i] * std::legendre(p_ - 1, rule_.node[i]));
      next_.push_back(rule_.weight[i] * std::legendre(p_ - 2, rule_.node[i]));
    }
  }

  ExactPosterior run() {
    moments_exist_ = settings_.second_moments;
    if (own_shape_ && map_.endless()) failure_ = "its mass does not end: it is improper or far too wide";
    lower_.fill(-6);
    upper_.fill(6);
    lower_[map_.axis()] = map_.lower();
    upper_[map_.axis()] = map_.upper();
    add_grid(lower_, upper_, d_ <= 2 ? 4 : 2);
    do {
      refine();
    } while (failure_.empty() && grow());
    if (failure_.empty()) verify();
    return result();
  }

 private:
  void node(const Cell& cell, std::size_t index, Coordinates& u) const {
    for (int a = 0; a < d_; ++a) {
      const double t = rule_.node[index % p_];
      index /= p_;
      u[a] = 0.5 * (cell.lower[a] + cell.upper[a]) + 0.5 * t * (cell.upper[a] - cell.lower[a]);
    }
  }

  double node_weight(std::size_t index) const {
    double weight = 1;
    for (int a = 0; a < d_; ++a, index /= p_) weight *= rule_.weight[index % p_];
    return weight;
  }

  double volume(const Cell& cell) const {
    double v = 1;
    for (int a = 0; a < d_; ++a) v *= 0.5 * (cell.upper[a] - cell.lower[a]);
    return v;
  }

  // The natural parameters of u.
  void to_natural(const Coordinates& z, Coordinates& x) const {
    const auto n = static_cast<std::size_t>(d_);
    posterior_.to_natural(std::span(z.data(), n), std::span(x.data(), n));
  }
  Eigen::VectorXd natural(const Coordinates& u) const {
    Coordinates z, x;
    map_.to_real(map_.at(u[map_.axis()]), u, z);
    to_natural(z, x);
    return Eigen::Map<const Eigen::VectorXd>(x.data(), d_);
  }

  // Evaluates the density on the cell's nodes and adds it.
  Cell& add(const Coordinates& lower, const Coordinates& upper) {
    Cell cell{lower, upper, values_.size(), 0, 0, 0, 0};
    Coordinates u, z, x;
    const double v = volume(cell);
    // Nodes with the same place along the axis share a frame.
    const int axis = map_.axis();
    std::array<RidgeMap::Frame, 10> frames;
    for (int i = 0; i < p_; ++i) {
      frames[i] = map_.at(0.5 * (lower[axis] + upper[axis]) +
                          0.5 * rule_.node[i] * (upper[axis] - lower[axis]));
    }
    const auto stride = static_cast<std::size_t>(std::pow(p_, axis));
    for (std::size_t i = 0; i < points_; ++i) {
      node(cell, i, u);
      const RidgeMap::Frame& frame = frames[i / stride % p_];
      map_.to_real(frame, u, z);
      const double log_density =
          posterior_.value(std::span(z.data(), static_cast<std::size_t>(d_))) - reference_;
      if (log_density > 300) failure_ = "the density grows without bound";
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
    cell.error = cell.control;  // until it is compared with its halves
    cell.axis = worst_axis(cell);
    cells_.push_back(cell);
    return cells_.back();
  }

  // The axis along which the two highest Legendre coefficients are largest.
  int worst_axis(const Cell& cell) const {
    int worst = 0;
    double largest = -1;
    std::size_t stride = 1;
    for (int a = 0; a < d_; ++a, stride *= p_) {
      double energy = 0;
      for (std::size_t line = 0; line < points_; ++line) {
        if (line / stride % p_ != 0) continue;
        double top = 0, next = 0;
        for (int i = 0; i < p_; ++i) {
          const double f = values_[cell.first + line + i * stride];
          top += top_[i] * f;
          next += next_[i] * f;
        }
        energy += std::abs(top) + std::abs(next);
      }
      // Between equals the longer side, so that a cell without structure stays a cube.
      energy += 1e-300 * (cell.upper[a] - cell.lower[a]);
      if (energy > largest) {
        largest = energy;
        worst = a;
      }
    }
    return worst;
  }

  void add_grid(const Coordinates& lower, const Coordinates& upper, int parts) {
    const auto count = static_cast<int>(std::pow(parts, d_));
    for (int i = 0; i < count; ++i) {
      Coordinates a{}, b{};
      for (int axis = 0, rest = i; axis < d_; ++axis, rest /= parts) {
        const double step = (upper[axis] - lower[axis]) / parts;
        a[axis] = lower[axis] + step * (rest % parts);
        b[axis] = rest % parts == parts - 1 ? upper[axis] : a[axis] + step;
      }
      add(a, b);
    }
  }

  void sum() {
    mass_ = control_ = error_ = 0;
    for (const Cell& cell : cells_) {
      mass_ += cell.mass;
      control_ += cell.control;
      error_ += cell.error;
    }
  }

  // Halves the cells with the largest errors until the sum of errors is small and no cell holds
  // much mass.
  void refine() {
    sum();
    using Entry = std::pair<double, std::size_t>;
    std::priority_queue<Entry> queue;
    const auto priority = [&](const Cell& cell) {
      const double share = cell.mass / mass_;
      return std::max(cell.error / control_, share > max_cell_mass[d_] ? share : 0.0);
    };
    for (std::size_t i = 0; i < cells_.size(); ++i) queue.emplace(priority(cells_[i]), i);
    while (failure_.empty() && !queue.empty()) {
      const auto [urgency, i] = queue.top();
      if (error_ <= settings_.tolerance * control_ && urgency <= max_cell_mass[d_]) break;
      if (evaluations_ >= settings_.max_evaluations) {
        failure_ = fmt::format("no convergence in {} evaluations", evaluations_);
        break;
      }
      queue.pop();
      halve(i);
      if (overflowed_) {
        overflowed_ = false;
        forget_moments();
        return refine();
      }
      for (const std::size_t half : {i, cells_.size() - 1})
        queue.emplace(priority(cells_[half]), half);
    }
  }

  void halve(std::size_t i) {
    const Cell parent = cells_[i];
    Coordinates middle_upper = parent.upper, middle_lower = parent.lower;
    const int a = parent.axis;
    middle_upper[a] = middle_lower[a] = 0.5 * (parent.lower[a] + parent.upper[a]);
    add(middle_lower, parent.upper);
    add(parent.lower, middle_upper);
    Cell& first = cells_[i];
    first = cells_.back();  // the parent's place; its old values stay unused in the arena
    cells_.pop_back();
    Cell& second = cells_.back();
    const double difference = std::abs(parent.control - first.control - second.control);
    for (Cell* half : {&first, &second}) half->error = std::min(half->control, 0.5 * difference);
    mass_ += first.mass + second.mass - parent.mass;
    control_ += first.control + second.control - parent.control;
    error_ += first.error + second.error - parent.error;
  }

  bool too_far(int axis, double reach) const {
    for (int i = 0; i < d_; ++i) {
      const Law& prior = posterior_.parameters()[static_cast<std::size_t>(i)].prior;
      const bool whole_line = !std::isfinite(prior.lower) && !std::isfinite(prior.upper);
      const double way = reach * unit_[axis][i];
      if (way > (whole_line ? farthest_on_whole_line : farthest_on_half_line)) return true;
    }
    return false;
  }

  // Adds a slab at each face where the outermost cells still hold something. False when none does.
  bool grow() {
    sum();
    bool grew = false;
    for (int a = 0; a < d_; ++a) {
      for (const bool high : {false, true}) {
        double mass = 0, control = 0;
        for (const Cell& cell : cells_) {
          if (high ? cell.upper[a] != upper_[a] : cell.lower[a] != lower_[a]) continue;
          mass += cell.mass;
          control += cell.control;
        }
        const bool mass_there = mass > 0.1 * settings_.tolerance * mass_;
        const bool moments_there = moments_exist_ && control > settings_.tolerance * control_;
        if (!mass_there && !moments_there) continue;
        if (too_far(a, high ? upper_[a] : -lower_[a])) {
          if (mass_there) {
            failure_ = "its mass does not end: it is improper or far too wide";
            return false;
          }
          forget_moments();
          return true;
        }
        Coordinates lower = lower_, upper = upper_;
        const double step = 0.5 * (upper_[a] - lower_[a]);
        if (high) {
          lower[a] = upper_[a];
          upper[a] = upper_[a] += step;
        } else {
          upper[a] = lower_[a];
          lower[a] = lower_[a] -= step;
        }
        add_grid(lower, upper, 2);
        grew = true;
      }
    }
    return grew;
  }

  // Second moments diverge: from here on only mass is integrated.
  void forget_moments() {
    moments_exist_ = false;
    for (Cell& cell : cells_) {
      const double share = cell.mass / std::max(cell.control, std::numeric_limits<double>::min());
      cell.error = std::isfinite(cell.error) ? cell.error * share : cell.mass;
      cell.control = cell.mass;
    }
  }

  // Was there anything on the way that no node has seen?
  void verify() {
    sum();
    if (!std::isfinite(error_) || !(mass_ > 0)) {
      failure_ = "its mass is no number";
      return;
    }
    if (!own_shape_) return;
    if (map_.highest() > reference_ + highest_ + most_above) {
      failure_ = fmt::format("a density e^{:.1f} times that of any node was met beside them",
                             map_.highest() - reference_ - highest_);
      contradicted_ = true;
      return;
    }
    const double off = log_mass() - map_.log_integral();
    if (std::abs(off) > most_from_laplace) {
      contradicted_ = true;
      failure_ = fmt::format(
          "the integral is e^{:.1f} times what curvature along the ridge says", off);
    }
  }

  double log_mass() const {
    return reference_ + std::log(mass_) + log_jacobian_ + map_.log_scale();
  }

  // The node, its weight, and where its cell ends.
  void write_node(const Cell& cell, std::size_t index, Eigen::Index row,
                  WeightedDraws& nodes) const {
    nodes.weights[row] = values_[cell.first + index] * node_weight(index) * volume(cell) / mass_;
    Coordinates u;
    node(cell, index, u);
    nodes.values.row(row) = natural(u);
    for (int a = 0; a < d_; ++a, index /= p_) {
      const double at = u[a];
      const double middle = 0.5 * (cell.lower[a] + cell.upper[a]);
      const double half = 0.5 * (cell.upper[a] - cell.lower[a]);
      u[a] = middle + half * rule_.cell_edge[index % p_];
      nodes.lower[a].row(row) = natural(u);
      u[a] = middle + half * rule_.cell_edge[index % p_ + 1];
      nodes.upper[a].row(row) = natural(u);
      u[a] = at;
    }
  }

  ExactPosterior result() {
    sum();
    ExactPosterior exact;
    exact.failure = failure_;
    exact.contradicted = contradicted_;
    exact.evaluations = evaluations_;
    exact.error = error_ / control_;
    exact.highest = reference_ + highest_;
    std::vector<std::pair<const Cell*, std::vector<std::size_t>>> kept;
    Eigen::Index n = 0;
    for (const Cell& cell : cells_) {
      const double v = volume(cell);
      std::vector<std::size_t> here;
      for (std::size_t i = 0; i < points_; ++i) {
        const double share = values_[cell.first + i] * node_weight(i) * v / mass_;
        if (share > negligible_share) here.push_back(i);
      }
      n += static_cast<Eigen::Index>(here.size());
      if (!here.empty()) kept.emplace_back(&cell, std::move(here));
    }
    WeightedDraws& nodes = exact.nodes;
    nodes.values.resize(n, d_);
    nodes.weights.resize(n);
    nodes.cells.mass.resize(n);
    for (Points* each : {&nodes.cells.node, &nodes.cells.mean, &nodes.cells.square}) {
      each->resize(n, d_);
    }
    nodes.lower.assign(d_, Points(n, d_));
    nodes.upper.assign(d_, Points(n, d_));
    Eigen::Index row = 0;
    for (const auto& [cell, indices] : kept) {
      const std::span values(&values_[cell->first], points_);
      parts_.describe(values, indices, volume(*cell), row, nodes.cells);
      for (const std::size_t index : indices) write_node(*cell, index, row++, nodes);
    }
    nodes.cells.mass /= nodes.cells.mass.sum();
    nodes.weights /= nodes.weights.sum();
    exact.mean = nodes.values.transpose() * nodes.weights;
    const Eigen::MatrixXd centered = nodes.values.rowwise() - exact.mean.transpose();
    exact.covariance = centered.transpose() * nodes.weights.asDiagonal() * centered;
    if (!moments_exist_) exact.covariance.setConstant(std::numeric_limits<double>::quiet_NaN());
    exact.sd = exact.covariance.diagonal().cwiseSqrt();
    bool proper = true;
    for (const Parameter& parameter : posterior_.parameters()) proper &= parameter.prior.proper;
    if (proper) {
      exact.log_evidence = log_mass();
    }
    return exact;
  }

  const Posterior& posterior_;
  bool own_shape_;
  const ExactSettings& settings_;
  int d_, p_;
  GaussLegendre rule_;
  std::size_t points_;
  RidgeMap map_;
  double reference_, log_jacobian_;
  std::array<Coordinates, max_d> unit_;
  CellParts parts_{rule_, d_};
  double highest_ = -INFINITY;  // log density of any node, over the reference
  std::vector<double> top_, next_;
  Eigen::VectorXd center_x_, scale_x_;
  Coordinates lower_{}, upper_{};
  std::vector<Cell> cells_;
  std::vector<double> values_;  // density at the nodes of every cell, relative to the reference
  double mass_ = 0, control_ = 0, error_ = 0;
  long evaluations_ = 0;
  bool moments_exist_ = true;
  bool overflowed_ = false;  // a second moment is no number
  std::string failure_;
  bool contradicted_ = false;
};

}  // namespace

ExactPosterior integrate(const Posterior& posterior, const Whitening& whitening,
                         const ExactSettings& settings) {
  return integrate(posterior, whitening, settings, posterior);
}

ExactPosterior integrate(const Posterior& posterior, const Whitening& whitening,
                         const ExactSettings& settings, const Posterior& shape) {
  if (posterior.dimension() > max_exact_dimension) {
    throw std::logic_error("integrate: too many parameters");
  }
  // Boxes multiply too fast on a ridge in four dimensions, a lattice where the posterior opens like a
  // funnel.
  if (posterior.dimension() == 4) {
    ExactPosterior exact = integrate_on_lattice(posterior, whitening, settings);
    if (exact.failure.empty()) return exact;
  }
  return Integrator(posterior, whitening, settings, shape).run();
}

Draws independent_draws(const Posterior& posterior, const ExactPosterior& exact, int chains,
                        int draws, std::uint64_t seed, std::uint64_t first_stream) {
  const WeightedSampler sample(exact.nodes);
  Draws all;
  for (int c = 0; c < chains; ++c) {
    Rng rng(seed, first_stream + static_cast<std::uint64_t>(c));
    Chain chain;
    chain.values.resize(draws, posterior.dimension());
    for (int i = 0; i < draws; ++i) {
      Eigen::VectorXd x;
      do {
        x = sample(rng);
      } while (!std::isfinite(posterior.natural_value(view(x))));
      chain.values.row(i) = x;
      chain.log_density.push_back(posterior.value(view(posterior.to_real(view(x)))));
    }
    all.push_back(std::move(chain));
  }
  return all;
}

}  // namespace wearwell
