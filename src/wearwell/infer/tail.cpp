#include "wearwell/infer/tail.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "wearwell/infer/funnel.h"
#include "wearwell/infer/ridge.h"
#include "wearwell/infer/tail_walk.h"
#include "wearwell/math/constants.h"
#include "wearwell/math/view.h"

namespace wearwell {
namespace {

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

}  // namespace

bool Tail::integrable() const {
  if (by_prior) return true;
  return towards_bound ? index < 1 - tail_slack : index > 1 + tail_slack;
}

bool all_integrable(const std::vector<Tail>& tails) {
  return std::all_of(tails.begin(), tails.end(),
                     [](const Tail& tail) { return tail.integrable(); });
}

bool Tail::has_moment(int order) const {
  return towards_bound || index > 1 + order + tail_slack;
}

namespace {

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
  const bool to_the_end = tail.towards_bound && !prior.proper && of_prior > 1 - tail_slack;
  const bool may_slow = !tail.towards_bound && !proper;
  const Walk all = walk_along(posterior, mode, tail, outward, to_the_end), way = all.sound();
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
  if (tail.towards_bound && prior.proper && tail.known && tail.index < of_prior + tail_slack)
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
  for (int step = 0; step < walk_steps; ++step) {
    const double way = far_log * (step + 1) / walk_steps;
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
