#include "wearwell/infer/profile.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <limits>
#include <optional>

#include "wearwell/infer/density_profile.h"
#include "wearwell/infer/natural_density.h"
#include "wearwell/math/view.h"

namespace wearwell {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

// An end farther than this from the mode, in widths, is treated as infinite.
constexpr double far = 1e6;

constexpr int most_searches = 80;

// The profiled quantity, with a plausible change.
struct Target {
  ProfiledQuantity quantity;
  double at_mode, width, lower, upper;
};

// The density of the other parameters at a fixed value of a quantity.
class Held final : public LogDensity {
 public:
  Held(const LogDensity& whole, const Box& box, const Eigen::VectorXd& unit,
       const ProfiledQuantity& quantity, double value)
      : whole_(whole), box_(box), unit_(unit), quantity_(quantity), value_(value) {}

  int dimension() const override { return whole_.dimension() - 1; }

  double value(std::span<const double> others) const override {
    const Eigen::VectorXd x = whole(others);
    return inside(x) ? whole_.value(view(x)) : -std::numeric_limits<double>::infinity();
  }

  double value_and_gradient(std::span<const double> others,
                            std::span<double> gradient) const override {
    Eigen::VectorXd x = whole(others), slope(x.size());
    if (!inside(x)) return -std::numeric_limits<double>::infinity();
    const double value = whole_.value_and_gradient(view(x), view(slope));
    const Eigen::Index fixed = quantity_.parameter;
    for (Eigen::Index i = 0, j = 0; i < x.size(); ++i) {
      if (i == fixed) continue;
      // The derivative of the fixed parameter, by a central difference.
      const double middle = x[i], step = 1e-5 * unit_[i];
      x[i] = middle + step;
      const double up = quantity_.solve(x.data(), value_);
      x[i] = middle - step;
      const double down = quantity_.solve(x.data(), value_);
      x[i] = middle;
      gradient[static_cast<std::size_t>(j++)] = slope[i] + slope[fixed] * (up - down) / (2 * step);
    }
    return value;
  }

  Eigen::VectorXd whole(std::span<const double> others) const {
    Eigen::VectorXd x(whole_.dimension());
    for (Eigen::Index i = 0, j = 0; i < x.size(); ++i) {
      x[i] = i == quantity_.parameter ? 0 : others[static_cast<std::size_t>(j++)];
    }
    x[quantity_.parameter] = quantity_.solve(x.data(), value_);
    return x;
  }

 private:
  bool inside(const Eigen::VectorXd& x) const {
    const Eigen::Index i = quantity_.parameter;
    return box_.lower[i] <= x[i] && x[i] <= box_.upper[i];
  }

  const LogDensity& whole_;
  const Box& box_;
  const Eigen::VectorXd& unit_;
  const ProfiledQuantity& quantity_;
  double value_;
};

Eigen::VectorXd without(const Eigen::VectorXd& x, Eigen::Index left_out) {
  Eigen::VectorXd others(x.size() - 1);
  others << x.head(left_out), x.tail(x.size() - 1 - left_out);
  return others;
}

// One end, by a search outward from the mode: the signed root of the deviance is nearly linear.
class Search {
 public:
  Search(const LogDensity& density, const Box& box, const Eigen::VectorXd& unit,
         const Target& target, const NaturalMode& mode, double root)
      : density_(density),
        box_(box),
        unit_(unit),
        target_(target),
        root_(root),
        others_box_{without(box.lower, target.quantity.parameter),
                    without(box.upper, target.quantity.parameter)},
        others_unit_(without(unit, target.quantity.parameter)),
        highest_(mode.log_posterior) {
    const Eigen::VectorXd x = mode.position.cwiseMax(box.lower).cwiseMin(box.upper);
    mode_others_ = last_others_ = without(x, target.quantity.parameter);
    last_ = target.at_mode;
  }

  ProfileEnd end(int direction) {
    const double bound = direction > 0 ? target_.upper : target_.lower;
    Point inner{target_.at_mode, -root_};
    double step = target_.width * root_;
    for (int i = 0; i < most_searches; ++i) {
      const double wanted = inner.at + direction * step;
      const bool at_bound = direction * (wanted - bound) >= 0;
      const double at = at_bound ? bound : wanted;
      const Point next{at, excess(at)};
      if (!problem_.empty()) return {nothing, problem_};
      if (next.excess >= 0) return between(inner, next);
      if (at_bound) return {nothing, "the likelihood allows all values up to the bound"};
      if (std::abs(at - target_.at_mode) > far * target_.width) break;
      // Slightly beyond the linear extrapolation.
      const double reached = std::max(next.excess + root_, 1e-3 * root_);
      step = std::abs(at - target_.at_mode) * std::clamp(1.02 * root_ / reached - 1, 0.05, 3.0);
      inner = next;
    }
    return {nothing, direction > 0 ? "the likelihood allows all larger values"
                                   : "the likelihood allows all smaller values"};
  }

 private:
  struct Point {
    double at, excess;
  };

  // The root of the deviance minus its target; sets `problem_` if no search converged.
  double excess(double at) {
    const Held held(density_, box_, unit_, target_.quantity, at);
    Maximum summit;
    if (held.dimension() == 0) {
      summit.x.resize(0);
      summit.value = held.value({});
      summit.converged = true;
    } else {
      // Linear extrapolation through the mode and the last solution.
      const double moved = last_ - target_.at_mode;
      const double share = moved != 0 ? (at - target_.at_mode) / moved : 1;
      const Eigen::VectorXd ahead = mode_others_ + share * (last_others_ - mode_others_);
      summit = highest_from({ahead, last_others_, mode_others_}, held);
    }
    if (summit.value == -std::numeric_limits<double>::infinity()) return INFINITY;
    const double fall = highest_ - summit.value;
    if (!summit.converged || std::isnan(fall)) {
      problem_ = "a search with a fixed value did not converge";
      return nothing;
    }
    if (fall < -1e-6 * (1 + std::abs(highest_))) {
      problem_ = "the likelihood is higher elsewhere than at the mode";
      return nothing;
    }
    last_ = at;
    last_others_ = summit.x;
    return std::sqrt(2 * std::max(fall, 0.0)) - root_;
  }

  // The first search that converges; if none does, searches in smaller steps, and finally the
  // highest point.
  Maximum highest_from(const std::vector<Eigen::VectorXd>& starts, const Held& held) const {
    std::optional<Maximum> best;
    for (const double size : {1.0, 0.05}) {
      for (const Eigen::VectorXd& start : starts) {
        Maximum summit = maximize(held, start, size * others_unit_, others_box_);
        if (summit.converged && std::isfinite(summit.value)) return summit;
        if (!best || summit.value > best->value) best = std::move(summit);
      }
    }
    return *best;
  }

  // False position with the Illinois correction.
  ProfileEnd between(Point low, Point high) {
    for (int i = 0; i < most_searches; ++i) {
      if (high.excess < 1e-9 * root_) return {high.at, ""};
      const bool finite = std::isfinite(high.excess);
      const double at =
          finite ? high.at - high.excess * (high.at - low.at) / (high.excess - low.excess)
                 : 0.5 * (low.at + high.at);
      if (!(std::abs(high.at - low.at) > 1e-9 * target_.width)) break;
      const Point next{at, excess(at)};
      if (!problem_.empty()) return {nothing, problem_};
      if (std::abs(next.excess) < 1e-7 * root_) return {at, ""};
      if (next.excess < 0) {
        if (last_side_ < 0 && finite) high.excess *= 0.5;
        low = next;
        last_side_ = -1;
      } else {
        if (last_side_ > 0) low.excess *= 0.5;
        high = next;
        last_side_ = 1;
      }
    }
    return {0.5 * (low.at + high.at), ""};
  }

  const LogDensity& density_;
  const Box& box_;
  const Eigen::VectorXd& unit_;
  const Target& target_;
  double root_;
  Box others_box_;
  Eigen::VectorXd others_unit_;
  double highest_;
  Eigen::VectorXd mode_others_, last_others_;
  double last_;
  int last_side_ = 0;
  std::string problem_;
};

// Widths of the likelihood, because those of the posterior may come from an unbounded tail.
Eigen::VectorXd widths_about(const NaturalMode& mode, Eigen::VectorXd widths) {
  constexpr double most = 30;  // standard errors
  for (Eigen::Index i = 0; i < widths.size(); ++i) {
    const double error = mode.standard_error[i];
    if (error > 0 && !(widths[i] <= most * error && widths[i] * most >= error)) widths[i] = error;
  }
  return widths;
}

NaturalMode mode_at(const ProfiledMaximum& maximum) {
  NaturalMode mode;
  mode.position = maximum.position;
  mode.log_posterior = maximum.value;
  mode.place.assign(static_cast<std::size_t>(maximum.position.size()), Place::inside);
  mode.standard_error = maximum.unit;
  return mode;
}

class Profiler {
 public:
  Profiler(const LogDensity& density, NaturalMode mode, Eigen::VectorXd unit, Box box, double level)
      : density_(density),
        mode_(std::move(mode)),
        unit_(std::move(unit)),
        box_(std::move(box)),
        // The root of chi-square's quantile with one degree of freedom.
        root_(boost::math::quantile(boost::math::normal(), 0.5 * (1 + level))) {}

  ProfileInterval of_parameter(Eigen::Index i) const {
    const double error = mode_.standard_error[i];
    Target target{{i, [i](const double* x) { return x[i]; },
                   [](const double*, double value) { return value; }},
                  std::clamp(mode_.position[i], box_.lower[i], box_.upper[i]),
                  error > 0 ? error : unit_[i],
                  box_.lower[i],
                  box_.upper[i]};
    ProfileInterval interval;
    for (const bool up : {false, true}) {
      const Place held = up ? Place::upper_bound : Place::lower_bound;
      (up ? interval.upper : interval.lower) =
          mode_.place[static_cast<std::size_t>(i)] == held
              ? ProfileEnd{nothing, "the mode is at the bound"}
              : Search(density_, box_, unit_, target, mode_, root_).end(up ? 1 : -1);
    }
    return interval;
  }

  ProfileInterval of(const ProfiledQuantity& quantity) const {
    const Eigen::VectorXd x = mode_.position.cwiseMax(box_.lower).cwiseMin(box_.upper);
    // Its spread to first order, with independent widths; sufficient for a first step.
    double squares = 0;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      Eigen::VectorXd up = x, down = x;
      up[i] = std::min(x[i] + 1e-3 * unit_[i], box_.upper[i]);
      down[i] = std::max(x[i] - 1e-3 * unit_[i], box_.lower[i]);
      const double slope =
          (quantity.value(up.data()) - quantity.value(down.data())) / (up[i] - down[i]) * unit_[i];
      squares += slope * slope;
    }
    const Target target{quantity, quantity.value(x.data()), 0.1 * std::sqrt(squares), -INFINITY,
                        INFINITY};
    ProfileInterval interval;
    if (!std::isfinite(target.at_mode) || !(target.width > 0) || !std::isfinite(target.width)) {
      interval.lower = interval.upper = {nothing, "it has no finite value at the mode"};
      return interval;
    }
    interval.lower = Search(density_, box_, unit_, target, mode_, root_).end(-1);
    interval.upper = Search(density_, box_, unit_, target, mode_, root_).end(1);
    return interval;
  }

 private:
  const LogDensity& density_;
  NaturalMode mode_;
  Eigen::VectorXd unit_;
  Box box_;
  double root_;
};

Profiler profiler_of(const NaturalDensity& density, const Posterior& posterior, const Fit& fit,
                     const NaturalMode& mode, double level) {
  const Eigen::VectorXd unit = widths_about(mode, natural_widths(posterior, fit.whitening));
  return {density, mode, unit, natural_box(posterior, unit), level};
}

}  // namespace

std::vector<ProfileInterval> profile_intervals(const Posterior& posterior, const Fit& fit,
                                               const NaturalMode& mode, double level) {
  const NaturalDensity density(posterior);
  const Profiler profiler = profiler_of(density, posterior, fit, mode, level);
  std::vector<ProfileInterval> intervals(static_cast<std::size_t>(posterior.dimension()));
  tbb::parallel_for(std::size_t{0}, intervals.size(), [&](std::size_t i) {
    intervals[i] = profiler.of_parameter(static_cast<Eigen::Index>(i));
  });
  return intervals;
}

ProfileInterval profile_interval(const Posterior& posterior, const Fit& fit,
                                 const NaturalMode& mode, const ProfiledQuantity& quantity,
                                 double level) {
  const NaturalDensity density(posterior);
  return profiler_of(density, posterior, fit, mode, level).of(quantity);
}

ProfileInterval profile_interval(const LogDensity& density, const ProfiledMaximum& maximum,
                                 Eigen::Index variable, double level) {
  return Profiler(density, mode_at(maximum), maximum.unit, maximum.box, level)
      .of_parameter(variable);
}

ProfileInterval profile_interval(const LogDensity& density, const ProfiledMaximum& maximum,
                                 const ProfiledQuantity& quantity, double level) {
  return Profiler(density, mode_at(maximum), maximum.unit, maximum.box, level).of(quantity);
}

}  // namespace wearwell
