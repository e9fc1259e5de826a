#include <fmt/format.h>

#include <cmath>

#include "wearwell/infer/box_integrator.h"

namespace wearwell {
namespace {

// Growth ends beyond the range of any proper posterior: a factor of e^200 on a half-line
// (heavy-tailed densities underflow beyond), 10^12 typical changes on a whole line.
constexpr double farthest_on_half_line = 200, farthest_on_whole_line = 1e12;

// A box with less than this fraction of its neighbor's density on a shared face has missed mass.
constexpr double least_agreement = 0.5;
// The fraction of the tolerance allowed for a single face.
constexpr double small_share = 0.03;
// A box at most this much longer than its neighbour, along every axis, is fine enough.
constexpr double as_small = 0.75;

// The number of inspection points between the nodes of a box, by dimension, and the steps of an
// additive recurrence with low discrepancy in the unit box (powers of the root of x^(d+1) = x + 1).
constexpr std::array<int, max_exact_dimension + 1> points_between = {0, 3, 6, 10, 16};
constexpr std::array<std::array<double, max_exact_dimension>, max_exact_dimension + 1>
    wander_steps = {
        {{},
         {0.6180339887498949},
         {0.7548776662466927, 0.5698402909980532},
         {0.8191725133961645, 0.6710436067037893, 0.5497004779019703},
         {0.8566748838545029, 0.7338918566271260, 0.6287067210378087, 0.5385972572236101}}};

// The number of times second moments are standardized again with better means and standard
// deviations.
constexpr int most_standardized = 4;

// The allowed difference (log) of a correct integral from the highest density on the walk along the
// ridge, and from its Laplace approximation.
constexpr double most_above = 3, most_from_laplace = 4;

}  // namespace

bool BoxIntegrator::reconcile() {
  const double significant = small_share * settings_.tolerance * control_;
  const std::size_t count = cells_.size();
  bool halved = false;
  std::vector<double> on_face;
  for (std::size_t i = 0; i < count; ++i) {
    if (cells_[i].agrees || cells_[i].control < significant) continue;
    bool agrees = true;
    for (int axis = 0; axis < d_; ++axis) {
      for (const bool high : {false, true}) agrees &= !reconcile(i, axis, high, on_face);
      if (!failure_.empty()) return true;
    }
    cells_[i].agrees = agrees;
    halved |= !agrees;
  }
  return halved;
}

bool BoxIntegrator::reconcile(std::size_t i, int axis, bool high, std::vector<double>& on_face) {
  const Cell cell = cells_[i];
  const std::span values(&values_[cell.first], points_);
  polynomial_.face(values, axis, high, on_face);
  // The mass beyond the face if the density continued for half of the box.
  const double depth = 0.5 * volume(cell) * cell.control / cell.mass;
  Coordinates u{};
  u[axis] = high ? cell.upper[axis] : std::nextafter(cell.lower[axis], -INFINITY);
  const auto outermost = high ? upper_[axis] <= cell.upper[axis] : lower_[axis] >= cell.lower[axis];
  if (outermost) return false;
  double all = 0, missing = 0, most = 0;
  Coordinates there{};
  for (const double f : on_face) all += std::max(0.0, f);
  const double significant = small_share * settings_.tolerance * control_;
  if (depth * all * most_weight_ < significant) return false;
  for (std::size_t y = 0; y < on_face.size(); ++y) {
    double weight = depth * on_face[y];
    std::size_t rest = y;
    for (int a = 0; a < d_; ++a) {
      if (a == axis) continue;
      weight *= rule_.weight[rest % p_];
      u[a] = 0.5 * (cell.lower[a] + cell.upper[a]) +
             0.5 * rule_.node[rest % p_] * (cell.upper[a] - cell.lower[a]);
      rest /= p_;
    }
    if (weight < 0.01 * significant) continue;
    const std::size_t other = tree_.find(u);
    if (other == BoxTree::none || !larger(cells_[other], cell)) continue;
    if (density_by(cells_[other], u) > least_agreement * on_face[y]) continue;
    missing += weight;
    if (weight > most) {
      most = weight;
      there = u;
    }
  }
  if (missing < significant) return false;
  halve_towards(there, cell);
  return true;
}

void BoxIntegrator::halve_towards(const Coordinates& there, const Cell& cell) {
  while (failure_.empty()) {
    const std::size_t other = tree_.find(there);
    int longest = 0;
    double most = 0;
    for (int a = 0; a < d_; ++a) {
      const double ratio =
          (cells_[other].upper[a] - cells_[other].lower[a]) / (cell.upper[a] - cell.lower[a]);
      if (ratio > most) {
        most = ratio;
        longest = a;
      }
    }
    if (most < as_small) return;
    if (evaluations_ >= settings_.max_evaluations) {
      failure_ = fmt::format("no convergence in {} evaluations", evaluations_);
      return;
    }
    halve(other, longest);
  }
}

bool BoxIntegrator::larger(const Cell& other, const Cell& cell) const {
  for (int a = 0; a < d_; ++a) {
    if (other.upper[a] - other.lower[a] > as_small * (cell.upper[a] - cell.lower[a])) return true;
  }
  return false;
}

double BoxIntegrator::density_by(const Cell& cell, const Coordinates& u) const {
  Coordinates place{};
  for (int a = 0; a < d_; ++a) {
    place[a] = (2 * u[a] - cell.lower[a] - cell.upper[a]) / (cell.upper[a] - cell.lower[a]);
  }
  return polynomial_.value(std::span(&values_[cell.first], points_), place);
}

bool BoxIntegrator::inspect() {
  Coordinates u{}, z, place{};
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    Cell& cell = cells_[i];
    if (cell.inspected || cell.control < 0.1 * settings_.tolerance * control_) continue;
    cell.inspected = true;
    double off = 0;
    for (int k = 0; k < points_between[d_]; ++k) {
      for (int a = 0; a < d_; ++a) {
        wander_[a] += wander_steps[d_][a];
        wander_[a] -= std::floor(wander_[a]);
        place[a] = 2 * wander_[a] - 1;
        u[a] = 0.5 * (cell.lower[a] + cell.upper[a]) +
               0.5 * place[a] * (cell.upper[a] - cell.lower[a]);
      }
      const RidgeMap::Frame frame = map_.at(u[map_.axis()]);
      map_.to_real(frame, u, z);
      const double log_density =
          posterior_.value(std::span(z.data(), static_cast<std::size_t>(d_))) - reference_;
      highest_ = std::max(highest_, log_density);
      const double f = std::exp(log_density + frame.log_jacobian - log_jacobian_);
      off += std::abs(f - polynomial_.value(std::span(&values_[cell.first], points_), place));
    }
    evaluations_ += points_between[d_];
    off *= volume(cell) * std::pow(2, d_) / points_between[d_];
    const double share = off / cell.mass, error = cell.control * std::min(share * share, share);
    cell.error = std::max(cell.error, std::isfinite(error) ? error : cell.control);
  }
  sum();
  return error_ > settings_.tolerance * control_;
}

bool BoxIntegrator::restandardize() {
  if (!moments_exist_ || standardized_ == most_standardized) return false;
  double mass = 0;
  Eigen::VectorXd first = Eigen::VectorXd::Zero(d_), second = first;
  for_each_node([&](const Cell&, double weight, const Eigen::VectorXd& t) {
    mass += weight;
    first += weight * t;
    second += weight * t.cwiseAbs2();
  });
  const Eigen::VectorXd mean = first / mass;
  const Eigen::VectorXd sd = (second / mass - mean.cwiseAbs2()).cwiseMax(0).cwiseSqrt();
  const bool well = mean.cwiseQuotient(sd).cwiseAbs().maxCoeff() < 0.5 && sd.maxCoeff() < 1.5 &&
                    sd.minCoeff() > 0.67;
  if (well || !mean.allFinite() || !(sd.minCoeff() > 0)) {
    standardized_ = most_standardized;
    return false;
  }
  ++standardized_;
  center_x_ += scale_x_.cwiseProduct(mean);
  scale_x_ = scale_x_.cwiseProduct(sd);
  std::vector<double> before;
  for (Cell& cell : cells_) {
    before.push_back(cell.control);
    cell.control = 0;
  }
  for_each_node([&](const Cell& cell, double weight, const Eigen::VectorXd& t) {
    cells_[static_cast<std::size_t>(&cell - cells_.data())].control +=
        weight * (1 + t.squaredNorm());
  });
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    if (before[i] > 0) cells_[i].error *= cells_[i].control / before[i];
  }
  return true;
}

bool BoxIntegrator::too_far(int axis, double reach) const {
  for (int i = 0; i < d_; ++i) {
    const Distribution& prior = posterior_.parameters()[static_cast<std::size_t>(i)].prior;
    const bool whole_line = !std::isfinite(prior.lower) && !std::isfinite(prior.upper);
    const double way = reach * unit_[axis][i];
    if (way > (whole_line ? farthest_on_whole_line : farthest_on_half_line)) return true;
  }
  return false;
}

bool BoxIntegrator::grow() {
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
      const bool moments_there = moments_exist_ && control > 0.1 * settings_.tolerance * control_;
      if (!mass_there && !moments_there) continue;
      if (too_far(a, high ? upper_[a] : -lower_[a])) {
        if (mass_there) {
          failure_ = "its mass is unbounded: the posterior is improper or far too wide";
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

void BoxIntegrator::forget_moments() {
  moments_exist_ = false;
  for (Cell& cell : cells_) {
    const double share = cell.mass / std::max(cell.control, std::numeric_limits<double>::min());
    cell.error = std::isfinite(cell.error) ? cell.error * share : cell.mass;
    cell.control = cell.mass;
  }
}

void BoxIntegrator::verify() {
  sum();
  if (!std::isfinite(error_) || !(mass_ > 0)) {
    failure_ = "its mass is not a number";
    return;
  }
  if (missed_maximum()) {
    failure_ = "the boxes miss one of the known maxima";
    contradicted_ = true;
    return;
  }
  if (!own_shape_) return;
  if (map_.highest_of_weight() > reference_ + highest_ + most_above) {
    failure_ = fmt::format("a density e^{:.1f} times that of any node exists between the nodes",
                           map_.highest_of_weight() - reference_ - highest_);
    contradicted_ = true;
    return;
  }
  const double off = log_mass() - map_.log_integral();
  // The Laplace approximation along the ridge covers only one maximum.
  if (places_.empty() ? std::abs(off) > most_from_laplace : off < -most_from_laplace) {
    contradicted_ = true;
    failure_ = fmt::format(
        "the integral is e^{:.1f} times its Laplace approximation along the ridge", off);
  }
}

double BoxIntegrator::log_mass() const {
  return reference_ + std::log(mass_) + log_jacobian_ + map_.log_scale();
}

}  // namespace wearwell
