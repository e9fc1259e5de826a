#include "wearwell/infer/tail_walk.h"

#include <algorithm>
#include <cmath>

#include "wearwell/infer/ridge.h"
#include "wearwell/math/view.h"

namespace wearwell {
namespace {

// If another parameter has changed by this many factors of e, the walk follows that parameter's
// tail, which is measured separately; a higher density beyond is not a mode.
constexpr double out_of_reach = 60;

// Stations without a conditional mode, after which the ridge is lost.
constexpr int most_failures = 6;

// A density that has decreased by this much (log), with such a high power, has no heavy tail.
constexpr double fallen = 200, steep = 50;

const Parameter& parameter_at(const Posterior& posterior, int i) {
  return posterior.parameters()[static_cast<std::size_t>(i)];
}

// The mode as a point on the ridge along parameter i.
ConditionalMode at_mode(const Slice& slice, const Mode& mode, int i) {
  const Eigen::Index d = mode.position.size();
  const Eigen::VectorXd rest = without(mode.position, i);
  Eigen::VectorXd width = Eigen::VectorXd::Ones(d - 1);
  for (Eigen::Index j = 0; j < d - 1; ++j) {
    const Eigen::Index from = j + (j >= i);
    const double bend = mode.curvature(from, from);
    if (mode.found && bend > 0) width[j] = 1 / std::sqrt(bend);
  }
  ConditionalMode station = visit(slice, {rest}, width);
  if (!station.converged) station.rest = rest;
  return station;
}

// Whether a vanished density stops decreasing at the end of the walk; then only the end is kept.
bool levels_out(Walk& walk) {
  constexpr std::size_t end = 5;
  const Walk sound = walk.sound();
  if (sound.stations() < end + 1 ||
      !(sound.index_from(sound.stations() - end, false) > 1 - tail_slack))
    return false;
  const auto keep = [&](auto& values) { values.erase(values.begin(), values.end() - end); };
  keep(walk.log_distance);
  keep(walk.log_density);
  keep(walk.log_likelihood);
  keep(walk.converged);
  return true;
}

// The other parameter that is farthest from the mode, if that is out of reach. Only those with a
// bound count: their real line has factors of e.
std::optional<Escape> out_of_reach_at(const Posterior& posterior, const Mode& mode, int i,
                                      const Eigen::VectorXd& rest) {
  std::optional<Escape> farthest;
  double most = out_of_reach;
  for (Eigen::Index j = 0; j < rest.size(); ++j) {
    const Eigen::Index from = j + (j >= i);
    const Distribution& prior = parameter_at(posterior, static_cast<int>(from)).prior;
    const bool bounded = std::isfinite(prior.lower) || std::isfinite(prior.upper);
    const double way = rest[j] - mode.position[from];
    if (!bounded || std::abs(way) < most) continue;
    farthest = Escape{static_cast<int>(from), way > 0};
    most = std::abs(way);
  }
  return farthest;
}

}  // namespace

Walk Walk::sound() const {
  Walk kept{{}, {}, {}, {}, lost, vanished, left, escape};
  for (std::size_t i = 0; i < converged.size(); ++i) {
    if (!converged[i]) continue;
    kept.log_distance.push_back(log_distance[i]);
    kept.log_density.push_back(log_density[i]);
    kept.log_likelihood.push_back(log_likelihood[i]);
  }
  return kept;
}

double Walk::index(bool may_slow) const {
  return index_from(std::max<std::size_t>(1, stations() / 2), may_slow);
}

double Walk::index_from(std::size_t first, bool may_slow) const {
  std::vector<double> slopes;
  for (std::size_t i = first; i < stations(); ++i) {
    slopes.push_back((log_density[i] - log_density[i - 1]) /
                     (log_distance[i] - log_distance[i - 1]));
  }
  // A tail like a power of a logarithm (Weibull scale, flat prior) decreases ever more slowly.
  constexpr std::size_t last = 1;
  const bool slower =
      may_slow && slopes.size() > last && std::is_sorted(slopes.begin(), slopes.end()) &&
      std::all_of(slopes.end() - last, slopes.end(),
                  [](double slope) { return slope < 0 && slope >= -(1 + tail_slack); });
  if (slower) return -slopes.back();
  const auto middle = slopes.begin() + static_cast<std::ptrdiff_t>(slopes.size() / 2);
  std::nth_element(slopes.begin(), middle, slopes.end());
  return -*middle;
}

bool Walk::likelihood_grows() const {
  if (log_likelihood.size() < 2) return true;
  const std::size_t half = log_likelihood.size() / 2, last = log_likelihood.size() - 1;
  const double way = std::abs(log_distance[last] - log_distance[half]);
  return half != last && log_likelihood[last] > log_likelihood[half] + tail_slack * way;
}

double width_at(const Mode& mode, int i) {
  if (!mode.found) return 1;
  const Eigen::VectorXd size = mode.curvature.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = size.asDiagonal() * mode.curvature * size.asDiagonal();
  const double width = size[i] * std::sqrt(scaled.inverse()(i, i));
  return std::isfinite(width) && width > 0 ? width : 1;
}

Walk walk_along(const Posterior& posterior, const Mode& mode, Tail& tail, bool outward,
                bool to_the_end) {
  const int i = tail.parameter;
  const Distribution& prior = parameter_at(posterior, i).prior;
  const bool whole_line = !std::isfinite(prior.lower) && !std::isfinite(prior.upper);
  Slice slice(posterior, i);
  slice.at = mode.position[i];
  ConditionalMode last = at_mode(slice, mode, i), before = last;
  const double top = last.log_marginal;
  const double unit = whole_line ? width_at(mode, i) : 1;
  Walk walk;
  int failures = 0;
  for (int step = 0; step < walk_steps; ++step) {
    const double way = far_log * (step + 1) / walk_steps;
    slice.at =
        mode.position[i] + (outward ? 1 : -1) * (whole_line ? unit * std::expm1(0.5 * way) : way);
    ConditionalMode station = visit(slice, guesses(before, last, slice.at - last.at), last.width);
    if (!std::isfinite(station.log_density)) {
      // The end of the likelihood's domain, or of the range of doubles upward.
      if (!walk.vanished) (last.log_marginal > top + 1 ? walk.lost : walk.vanished) = true;
      break;
    }
    if (std::optional<Escape> away = out_of_reach_at(posterior, mode, i, station.rest)) {
      walk.left = true;
      const double rise = station.log_density - posterior.value(view(mode.position));
      if (rise > 0 && station.log_marginal > top) {
        const int j = away->parameter;
        away->slope = rise / std::abs(slice.whole(station.rest)[j] - mode.position[j]);
        walk.escape = away;
      }
      break;
    }
    if (tail.highest_at.size() == 0 || station.log_density > tail.highest) {
      tail.highest = station.log_density;
      tail.highest_at = slice.whole(station.rest);
    }
    failures += !station.converged;
    if (failures > most_failures) {
      walk.lost = !walk.vanished;
      break;
    }
    // p(x) = p(z) / |dx/dz|; on half-lines and intervals log |dx/dz| changes as log distance does.
    const double distance = whole_line ? 0.5 * way : tail.towards_bound ? -way : way;
    Eigen::VectorXd x(posterior.dimension());
    posterior.to_natural(view(slice.whole(station.rest)), view(x));
    walk.log_distance.push_back(distance);
    walk.log_density.push_back(station.log_marginal - (whole_line ? 0 : distance));
    walk.log_likelihood.push_back(posterior.likelihood()->value(view(x)));
    walk.converged.push_back(station.converged);
    const double rise = station.log_marginal - last.log_marginal;
    before = std::move(last);
    last = std::move(station);
    if (last.converged && last.log_marginal < top - fallen && rise < -steep) {
      walk.vanished = true;
      if (!to_the_end) break;
    }
  }
  if (to_the_end && walk.vanished) walk.vanished = !levels_out(walk);
  return walk;
}

}  // namespace wearwell
