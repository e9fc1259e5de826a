#include "wearwell/infer/posterior_shape.h"

#include <algorithm>

#include "wearwell/infer/funnel.h"

namespace wearwell {
namespace {

// The mode and the tails about it. If a walk along a tail meets a higher density than the mode's,
// the search restarts from there: sigma may be 20 factors of e below its guess.
PosteriorShape mode_and_tails(const Posterior& posterior) {
  constexpr int most_searches = 4;
  constexpr double higher = 0.01;
  PosteriorShape shape{find_mode(posterior, posterior.start()), {}, 0};
  for (int search = 1;; ++search) {
    shape.tails = tails(posterior, shape.mode);
    shape.highest = shape.mode.log_density;
    const Tail* best = nullptr;
    for (const Tail& tail : shape.tails) {
      if (tail.highest_at.size() == 0 || !(tail.highest > shape.highest)) continue;
      shape.highest = tail.highest;
      best = &tail;
    }
    if (!best || shape.highest < shape.mode.log_density + higher || search == most_searches) {
      return shape;
    }
    Mode next = find_mode(posterior, best->highest_at);
    if (!next.found || !(next.log_density > shape.mode.log_density)) return shape;
    shape.mode = std::move(next);
  }
}

// Maxima other than the mode; one with far more mass replaces it. A search that began in a valley
// between two may have found none.
void search_further(const Posterior& posterior, PosteriorShape& shape) {
  shape.maxima = find_maxima(posterior, shape.mode);
  if (shape.maxima.found.empty()) return;
  const Mode& first = shape.maxima.found.front().mode;
  if (shape.mode.found && first.position == shape.mode.position) return;
  shape.mode = first;
  shape.tails = tails(posterior, shape.mode);
  shape.highest = shape.mode.log_density;
  for (const Tail& tail : shape.tails) {
    if (tail.highest_at.size() > 0) shape.highest = std::max(shape.highest, tail.highest);
  }
}

}  // namespace

PosteriorShape posterior_shape(const Posterior& posterior) {
  PosteriorShape shape = mode_and_tails(posterior);
  if (shape.mode.found) {
    if (all_integrable(shape.tails)) search_further(posterior, shape);
    return shape;
  }
  if (auto funnel = funnel_middle(posterior, posterior.start())) {
    shape.tails = tails(posterior, *funnel);
    shape.neck = funnel->scale;
    shape.mode = std::move(funnel->middle);
    return shape;
  }
  if (all_integrable(shape.tails)) search_further(posterior, shape);
  return shape;
}

}  // namespace wearwell
