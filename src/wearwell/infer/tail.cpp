#include "wearwell/infer/tail.h"

#include <array>
#include <cmath>
#include <limits>

#include "wearwell/math/minimizer.h"
#include "wearwell/math/view.h"

namespace wearwell {
namespace {

// A fitted index of 2.03 is read as 2: slopes are measured at a finite distance.
constexpr double slack = 0.05;

// The walk ends where doubles end to resolve the density: e^40 times the start, or e^20 away on a
// whole line.
constexpr double far_log = 40;
constexpr int steps = 20;

// The density of all coordinates but one, which is held.
class Slice final : public LogDensity {
 public:
  Slice(const LogDensity& whole, int held) : whole_(whole), held_(held) {}

  double at = 0;  ///< the value of the held coordinate

  int dimension() const override { return whole_.dimension() - 1; }

  double value(std::span<const double> x) const override {
    const Buffer full = expand(x);
    return whole_.value(std::span(full.data(), x.size() + 1));
  }

  double value_and_gradient(std::span<const double> x, std::span<double> gradient) const override {
    const Buffer full = expand(x);
    Buffer slope{};
    const double value = whole_.value_and_gradient(std::span(full.data(), x.size() + 1),
                                                   std::span(slope.data(), x.size() + 1));
    for (std::size_t i = 0; i < x.size(); ++i) gradient[i] = slope[i + (i >= held_)];
    return value;
  }

 private:
  using Buffer = std::array<double, max_dimension>;

  Buffer expand(std::span<const double> x) const {
    Buffer full;
    for (std::size_t i = 0; i < x.size(); ++i) full[i + (i >= held_)] = x[i];
    full[held_] = at;
    return full;
  }

  const LogDensity& whole_;
  std::size_t held_;
};

struct Station {
  Eigen::VectorXd rest;     // conditional mode of the other coordinates
  double log_marginal = 0;  // of the held coordinate, by Laplace
};

Station visit(const Slice& slice, const Eigen::VectorXd& guess) {
  if (slice.dimension() == 0) return {guess, slice.value({})};
  const Objective objective = [&](std::span<const double> x, std::span<double> gradient) {
    if (gradient.empty()) return -slice.value(x);
    const double value = slice.value_and_gradient(x, gradient);
    for (double& slope : gradient) slope = std::isfinite(value) ? -slope : 0;
    return -value;
  };
  const Minimum best = minimize(objective, guess, 500);
  // A direction without curvature counts as one of unit width: it can only make a tail look heavier
  // by a constant.
  const Eigen::VectorXd eigenvalues =
      curvature_at(slice, best.position).selfadjointView<Eigen::Lower>().eigenvalues();
  const double log_determinant =
      eigenvalues.unaryExpr([](double c) { return std::log(c > 1e-8 ? c : 1.0); }).sum();
  return {best.position, -best.value - 0.5 * log_determinant};
}

}  // namespace

bool Tail::integrable() const {
  return towards_bound ? index < 1 - slack : index > 1 + slack;
}

bool Tail::has_moment(int order) const {
  return towards_bound || index > 1 + order + slack;
}

std::vector<Tail> tails(const Posterior& posterior, const Mode& mode) {
  std::vector<Tail> all;
  const int d = posterior.dimension();
  for (int i = 0; i < d; ++i) {
    Slice slice(posterior, i);
    const Law& prior = posterior.parameters()[static_cast<std::size_t>(i)].prior;
    const bool whole_line = !std::isfinite(prior.lower) && !std::isfinite(prior.upper);
    Eigen::VectorXd at_mode(d - 1);
    for (int j = 0; j < d - 1; ++j) at_mode[j] = mode.position[j + (j >= i)];
    for (const bool outward : {false, true}) {
      // On a half-line z is minus the log of the closeness to the bound; below an upper bound it
      // runs downwards.
      const bool upward =
          std::isfinite(prior.upper) && !std::isfinite(prior.lower) ? !outward : outward;
      Tail tail{i, upward, std::isfinite(upward ? prior.upper : prior.lower), 0};

      // Log distance (from 0, or from the bound) and log marginal density of x there, station by
      // station.
      std::array<double, steps> log_distance, log_density;
      Eigen::VectorXd rest = at_mode, before = at_mode;
      int count = 0;
      for (int step = 0; step < steps; ++step) {
        const double way = far_log * (step + 1) / steps;
        const double z =
            mode.position[i] + (outward ? 1 : -1) * (whole_line ? std::expm1(0.5 * way) : way);
        slice.at = z;
        const Station station =
            visit(slice, whole_line ? rest : Eigen::VectorXd(2 * rest - before));
        if (!std::isfinite(station.log_marginal)) break;
        before = rest;
        rest = station.rest;
        // p(x) = p(z) / |dx/dz|; on half-lines and intervals log |dx/dz| changes as log distance
        // does.
        log_distance[count] = whole_line ? 0.5 * way : tail.towards_bound ? -way : way;
        log_density[count] = station.log_marginal - (whole_line ? 0 : log_distance[count]);
        ++count;
      }
      const int half = count / 2;
      if (count < steps / 2) {
        tail.index = tail.towards_bound ? -std::numeric_limits<double>::infinity()
                                        : std::numeric_limits<double>::infinity();
      } else {
        tail.index = -(log_density[count - 1] - log_density[half]) /
                     (log_distance[count - 1] - log_distance[half]);
      }
      all.push_back(tail);
    }
  }
  return all;
}

}  // namespace wearwell
