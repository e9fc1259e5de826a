#include "wearwell/infer/tail.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "wearwell/infer/funnel.h"
#include "wearwell/infer/ridge.h"
#include "wearwell/math/constants.h"
#include "wearwell/math/view.h"

namespace wearwell {
namespace {

// A fitted index of 2.03 counts as 2, because slopes are measured at a finite distance.
constexpr double slack = 0.05;

// The walk ends at the resolution of doubles: e^40 times the start, or e^20 widths away on a whole
// line.
constexpr double far_log = 40;
constexpr int steps = 20;

// If another parameter has changed by this many factors of e, the walk follows that parameter's
// tail, which is measured separately; a higher density beyond is not a mode.
constexpr double out_of_reach = 60;

// Stations without a conditional mode, after which the ridge is lost.
constexpr int most_failures = 6;

// A density that has decreased by this much (log), with such a high power, has no heavy tail.
constexpr double fallen = 200, steep = 50;

const Parameter& parameter_of(const Posterior& posterior, int i) {
  return posterior.parameters()[static_cast<std::size_t>(i)];
}

bool all_proper(const Posterior& posterior) {
  return std::all_of(posterior.parameters().begin(), posterior.parameters().end(),
                     [](const Parameter& parameter) { return parameter.prior.proper; });
}

// The tail index of the prior, at 1e-9 of the distance to the bound, or 1e9 times as far out.
double prior_index(const Parameter& parameter, bool upward, bool towards_bound) {
  const Distribution& prior = parameter.prior;
  constexpr double near = 1e-9;
  if (!towards_bound) {
    const double size = std::max(std::abs(parameter.start), parameter.scale);
    const double x = (upward ? 1 : -1) * size / near;
    if (!(prior.lower < x && x < prior.upper)) return infinity;
    return -log_density(prior, x).slope * x;
  }
  const double size = std::isfinite(prior.upper - prior.lower) ? prior.upper - prior.lower
                      : upward                                 ? prior.upper - parameter.start
                                                               : parameter.start - prior.lower;
  const double distance = near * size;
  const double x = upward ? prior.upper - distance : prior.lower + distance;
  if (!(prior.lower < x && x < prior.upper)) return 0;
  return (upward ? 1 : -1) * log_density(prior, x).slope * distance;
}

// A parameter along which the density rises beyond that of the mode, out of reach: without a proper
// prior its integral is infinite. `slope` is that of the log density on the real line.
struct Escape {
  int parameter = 0;
  bool outward = true;  // on the real line
  double slope = 0;
};

// The stations of the walk: logarithms of the distance (from 0, or to the bound), of the
// parameter's marginal density, and of the likelihood.
struct Walk {
  std::vector<double> log_distance, log_density, log_likelihood;
  std::vector<bool> converged;   // whether the conditional mode exists
  bool lost = false;             // the conditional mode or finite numbers were lost
  bool vanished = false;         // the density vanished
  bool left = false;             // another parameter left the range
  std::optional<Escape> escape;  // if it left towards a higher density than that of the mode

  // Without the stations that have no conditional mode.
  Walk sound() const {
    Walk kept{{}, {}, {}, {}, lost, vanished, left, escape};
    for (std::size_t i = 0; i < converged.size(); ++i) {
      if (!converged[i]) continue;
      kept.log_distance.push_back(log_distance[i]);
      kept.log_density.push_back(log_density[i]);
      kept.log_likelihood.push_back(log_likelihood[i]);
    }
    return kept;
  }

  std::size_t stations() const { return log_density.size(); }

  // From the far half, the median of slopes between neighbours, which is robust against a bad
  // station. `may_slow`: for a tail towards infinity under improper priors.
  double index(bool may_slow) const {
    return index_from(std::max<std::size_t>(1, stations() / 2), may_slow);
  }
  double index_from(std::size_t first, bool may_slow) const {
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
                    [](double slope) { return slope < 0 && slope >= -(1 + slack); });
    if (slower) return -slopes.back();
    const auto middle = slopes.begin() + static_cast<std::ptrdiff_t>(slopes.size() / 2);
    std::nth_element(slopes.begin(), middle, slopes.end());
    return -*middle;
  }

  bool likelihood_grows() const {
    if (log_likelihood.size() < 2) return true;
    const std::size_t half = log_likelihood.size() / 2, last = log_likelihood.size() - 1;
    const double way = std::abs(log_distance[last] - log_distance[half]);
    return half != last && log_likelihood[last] > log_likelihood[half] + slack * way;
  }
};

}  // namespace

bool Tail::integrable() const {
  if (by_prior) return true;
  return towards_bound ? index < 1 - slack : index > 1 + slack;
}

bool all_integrable(const std::vector<Tail>& tails) {
  return std::all_of(tails.begin(), tails.end(),
                     [](const Tail& tail) { return tail.integrable(); });
}

bool Tail::has_moment(int order) const {
  return towards_bound || index > 1 + order + slack;
}

namespace {

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

// The marginal width of coordinate i at the mode: the first step on a whole line.
double width_at(const Mode& mode, int i) {
  if (!mode.found) return 1;
  const Eigen::VectorXd size = mode.curvature.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = size.asDiagonal() * mode.curvature * size.asDiagonal();
  const double width = size[i] * std::sqrt(scaled.inverse()(i, i));
  return std::isfinite(width) && width > 0 ? width : 1;
}

// Whether a vanished density stops decreasing at the end of the walk; then only the end is kept.
bool levels_out(Walk& walk) {
  constexpr std::size_t end = 5;
  const Walk sound = walk.sound();
  if (sound.stations() < end + 1 || !(sound.index_from(sound.stations() - end, false) > 1 - slack))
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
    const Distribution& prior = parameter_of(posterior, static_cast<int>(from)).prior;
    const bool bounded = std::isfinite(prior.lower) || std::isfinite(prior.upper);
    const double way = rest[j] - mode.position[from];
    if (!bounded || std::abs(way) < most) continue;
    farthest = Escape{static_cast<int>(from), way > 0};
    most = std::abs(way);
  }
  return farthest;
}

// `to_the_end`: continues after the density has vanished.
Walk walk(const Posterior& posterior, const Mode& mode, Tail& tail, bool outward, bool to_the_end) {
  const int i = tail.parameter;
  const Distribution& prior = parameter_of(posterior, i).prior;
  const bool whole_line = !std::isfinite(prior.lower) && !std::isfinite(prior.upper);
  Slice slice(posterior, i);
  slice.at = mode.position[i];
  ConditionalMode last = at_mode(slice, mode, i), before = last;
  const double top = last.log_marginal;
  const double unit = whole_line ? width_at(mode, i) : 1;
  Walk walk;
  int failures = 0;
  for (int step = 0; step < steps; ++step) {
    const double way = far_log * (step + 1) / steps;
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

Tail measure(const Posterior& posterior, const Mode& mode, int i, bool outward, bool proper,
             std::optional<Escape>& escape) {
  const Parameter& parameter = parameter_of(posterior, i);
  const Distribution& prior = parameter.prior;
  // On a half-line z is minus the log of the closeness to the bound; below an upper bound it runs
  // downwards.
  const bool upward =
      std::isfinite(prior.upper) && !std::isfinite(prior.lower) ? !outward : outward;
  const double bound = upward ? prior.upper : prior.lower;
  const double natural = upward ? parameter.natural_upper : parameter.natural_lower;
  Tail tail{i, upward, std::isfinite(bound)};
  const double of_prior = prior_index(parameter, upward, tail.towards_bound);
  if (tail.towards_bound && bound != natural) {
    tail.index = of_prior;
    tail.by_prior = prior.proper;
    return tail;
  }
  constexpr std::size_t enough = 5;  // stations
  const bool to_the_end = tail.towards_bound && !prior.proper && of_prior > 1 - slack;
  const bool may_slow = !tail.towards_bound && !proper;
  const Walk all = walk(posterior, mode, tail, outward, to_the_end), way = all.sound();
  escape = all.escape;
  tail.index = tail.towards_bound ? -infinity : infinity;
  if (!way.vanished && way.stations() >= enough) {
    tail.index = way.index(may_slow);
  } else if (way.left) {
    // From there on the tail along the other parameter is relevant.
  } else if (!way.vanished) {
    // If the others have no mode either, the posterior may be improper along all of them; any
    // stations show this.
    tail.known = false;
    const double index = all.stations() >= enough ? all.index(may_slow) : tail.index;
    if (!Tail{i, upward, tail.towards_bound, index}.integrable()) {
      tail.index = index;
      tail.known = true;
    }
  }
  // Without a conditional mode, the likelihood is still examined.
  if (proper && !(way.stations() < 2 ? all : way).likelihood_grows()) {
    tail.index = !tail.known          ? of_prior
                 : tail.towards_bound ? std::min(tail.index, of_prior)
                                      : std::max(tail.index, of_prior);
    tail.known = true;
    tail.by_prior = true;
  }
  // The likelihood has a limit there, so the tail is that of the prior, whose integral is finite.
  if (tail.towards_bound && prior.proper && tail.known && tail.index < of_prior + slack)
    tail.by_prior = true;
  return tail;
}

// Whether the likelihood increases along a tail at a fixed scale of a funnel.
bool grows_beside(const Posterior& posterior, const Funnel& funnel, const Tail& tail) {
  const int i = tail.parameter, scale = funnel.scale;
  const Eigen::VectorXd& z = funnel.middle.position;
  const Distribution& prior = parameter_of(posterior, i).prior;
  const bool whole_line = !std::isfinite(prior.lower) && !std::isfinite(prior.upper);
  const bool below = std::isfinite(prior.upper) && !std::isfinite(prior.lower);
  const double unit =
      (tail.upward != below ? 1 : -1) * (whole_line ? width_at(funnel.middle, i) : 1);
  Slice held(posterior, scale);
  held.at = z[scale];
  const int among = i - (i > scale);  // its index without the scale
  Slice slice(held, among);
  slice.at = z[i];
  ConditionalMode last = visit(slice, {without(without(z, scale), among)},
                               Eigen::VectorXd::Ones(z.size() - 2)),
                  before = last;
  Walk walk;
  for (int step = 0; step < steps; ++step) {
    const double way = far_log * (step + 1) / steps;
    slice.at = z[i] + unit * (whole_line ? std::expm1(0.5 * way) : way);
    ConditionalMode station = visit(slice, guesses(before, last, slice.at - last.at), last.width);
    if (!std::isfinite(station.log_density)) break;
    Eigen::VectorXd x(z.size());
    posterior.to_natural(view(held.whole(slice.whole(station.rest))), view(x));
    walk.log_distance.push_back(whole_line ? 0.5 * way : tail.towards_bound ? -way : way);
    walk.log_likelihood.push_back(posterior.likelihood()->value(view(x)));
    before = std::move(last);
    last = std::move(station);
  }
  return walk.log_likelihood.size() >= 2 && walk.likelihood_grows();
}

}  // namespace

std::vector<Tail> tails(const Posterior& posterior, const Mode& mode) {
  const bool proper = all_proper(posterior);
  // Walks are independent; they dominate the time for an expensive likelihood.
  std::vector<Tail> all(2 * static_cast<std::size_t>(posterior.dimension()));
  std::vector<std::optional<Escape>> escapes(all.size());
  tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t k) {
    all[k] = measure(posterior, mode, static_cast<int>(k / 2), k % 2 == 1, proper, escapes[k]);
  });
  for (const std::optional<Escape>& escape : escapes) {
    if (!escape || parameter_of(posterior, escape->parameter).prior.proper) continue;
    Tail& tail = all[2 * static_cast<std::size_t>(escape->parameter) + (escape->outward ? 1 : 0)];
    if (!tail.known || !tail.integrable()) continue;
    // Per factor of e the density of the parameter itself changes by one more, or one less.
    tail.index = tail.towards_bound ? 1 + escape->slope : 1 - escape->slope;
    tail.known = true;
  }
  return all;
}

std::vector<Tail> tails(const Posterior& posterior, const Funnel& funnel) {
  std::vector<Tail> all = tails(posterior, funnel.middle);
  if (!all_proper(posterior)) return all;
  for (Tail& tail : all) {
    if (tail.parameter == funnel.scale || (tail.known && tail.has_moment(2) && tail.integrable())) {
      continue;
    }
    if (grows_beside(posterior, funnel, tail)) continue;
    tail.index =
        prior_index(parameter_of(posterior, tail.parameter), tail.upward, tail.towards_bound);
    tail.known = true;
  }
  return all;
}

}  // namespace wearwell
