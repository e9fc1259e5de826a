#include "wearwell/infer/funnel.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "wearwell/infer/ridge.h"
#include "wearwell/math/view.h"

namespace wearwell {
namespace {

// Stations half a factor of e apart, until the log marginal density has decreased by this much.
constexpr double step = 0.5, fallen = 3;
constexpr int most_stations = 60;

// In the log marginal density; a lower maximum is a plateau.
constexpr double least_curvature = 1e-2;

bool is_scale(const Parameter& parameter) {
  return std::isfinite(parameter.prior.lower) && parameter.prior.lower == parameter.natural_lower;
}

// Stations along a scale in one direction.
class Walk {
 public:
  Walk(const Posterior& posterior, int scale, ConditionalMode first)
      : slice_(posterior, scale), before_(first), last_(std::move(first)) {}

  // Empty if the other parameters have no mode.
  std::optional<ConditionalMode> next(double by) {
    slice_.at = last_.at + by;
    ConditionalMode station = visit(slice_, guesses(before_, last_, by), last_.width);
    if (!station.converged) return {};
    before_ = std::move(last_);
    last_ = std::move(station);
    return last_;
  }

  Eigen::VectorXd whole() const { return slice_.whole(last_.rest); }

 private:
  Slice slice_;
  ConditionalMode before_, last_;
};

std::optional<ConditionalMode> conditional_mode_at(const Posterior& posterior,
                                                   const Eigen::VectorXd& z, int i, double out) {
  Slice slice(posterior, i);
  slice.at = z[i] + out;
  ConditionalMode station = visit(slice, {without(z, i)}, Eigen::VectorXd::Ones(z.size() - 1));
  if (!station.converged) return {};
  return station;
}

// At z or farther out, because the search for a start may have ended deep in the neck of the
// funnel.
std::optional<ConditionalMode> highest_conditional_mode(const Posterior& posterior,
                                                        const Eigen::VectorXd& z, int i) {
  constexpr double farther = 4, farthest = 60;  // factors of e
  std::optional<ConditionalMode> highest;
  for (double out = 0; out <= farthest; out += farther) {
    auto station = conditional_mode_at(posterior, z, i, out);
    if (!station || (highest && !(station->log_marginal > highest->log_marginal))) continue;
    highest = std::move(station);
  }
  return highest;
}

// The stations around the maximum of the marginal density; empty without a maximum.
std::vector<ConditionalMode> across_the_maximum(const Posterior& posterior,
                                                const Eigen::VectorXd& near, int i) {
  const auto first = highest_conditional_mode(posterior, near, i);
  if (!first) return {};
  std::vector<ConditionalMode> stations = {*first};
  double top = first->log_marginal;
  for (const int way : {-1, 1}) {
    Walk walk(posterior, i, *first);
    do {
      const auto next = walk.next(way * step);
      if (!next || static_cast<int>(stations.size()) >= most_stations) return {};
      top = std::max(top, next->log_marginal);
      stations.push_back(*next);
    } while (stations.back().log_marginal > top - fallen);
    if (way < 0) std::reverse(stations.begin(), stations.end());
  }
  return stations;
}

std::optional<Funnel> middle_along(const Posterior& posterior, const Eigen::VectorXd& near, int i) {
  const std::vector<ConditionalMode> stations = across_the_maximum(posterior, near, i);
  if (stations.size() < 3) return {};
  const auto highest = std::max_element(
      stations.begin() + 1, stations.end() - 1,
      [](const auto& a, const auto& b) { return a.log_marginal < b.log_marginal; });
  const ConditionalMode &below = highest[-1], &above = highest[1];
  // The parabola through three stations.
  const double slope = (above.log_marginal - below.log_marginal) / (2 * step);
  const double bend =
      (2 * highest->log_marginal - above.log_marginal - below.log_marginal) / (step * step);
  if (!(bend > least_curvature)) return {};
  Slice slice(posterior, i);
  slice.at = highest->at + std::clamp(slope / bend, -step, step);
  const ConditionalMode middle = visit(slice, {highest->rest}, highest->width);
  if (!middle.converged || !middle.curvature.allFinite()) return {};

  const Eigen::VectorXd along = (above.rest - below.rest) / (2 * step);
  const Eigen::VectorXd mixed = -middle.curvature * along;
  const Eigen::Index d = near.size();
  Mode mode{slice.whole(middle.rest), middle.log_density, Eigen::MatrixXd(d, d), true};
  for (Eigen::Index a = 0; a < d - 1; ++a) {
    const Eigen::Index row = a + (a >= i);
    mode.curvature(row, i) = mode.curvature(i, row) = mixed[a];
    for (Eigen::Index b = 0; b < d - 1; ++b) {
      mode.curvature(row, b + (b >= i)) = middle.curvature(a, b);
    }
  }
  mode.curvature(i, i) = bend - mixed.dot(along);
  return Funnel{i, std::move(mode)};
}

}  // namespace

std::optional<Funnel> funnel_middle(const Posterior& posterior, const Eigen::VectorXd& near) {
  if (posterior.dimension() < 2) return {};
  for (int i = 0; i < posterior.dimension(); ++i) {
    if (!is_scale(posterior.parameters()[static_cast<std::size_t>(i)])) continue;
    auto funnel = middle_along(posterior, near, i);
    if (funnel && rises_without_end(posterior, funnel->middle.position, i)) return funnel;
  }
  return {};
}

bool rises_without_end(const Posterior& posterior, const Eigen::VectorXd& middle, int i) {
  constexpr int stations = 12;
  constexpr double least_rise = 0.01;  // of the log density, a factor of e
  if (middle.size() < 2 || !is_scale(posterior.parameters()[static_cast<std::size_t>(i)])) {
    return false;
  }
  const auto first = conditional_mode_at(posterior, middle, i, 0);
  if (!first) return false;
  Walk walk(posterior, i, *first);
  double last = -INFINITY;
  for (int station = 0; station < stations; ++station) {
    if (!walk.next(-1)) return false;
    Eigen::VectorXd x(middle.size());
    posterior.to_natural(view(walk.whole()), view(x));
    const double here = posterior.natural_value(view(x));
    if (2 * station >= stations && !(here > last + least_rise)) return false;
    last = here;
  }
  return true;
}

}  // namespace wearwell
