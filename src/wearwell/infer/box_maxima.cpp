#include <algorithm>
#include <cmath>

#include "wearwell/infer/box_integrator.h"
#include "wearwell/math/view.h"

namespace wearwell {
namespace {

// The region extends this many widths beyond a maximum; boxes about it are at first at most this
// many conditional widths long.
constexpr double widths_beyond = 6, widths_in_a_box = 3;

// Ignores a maximum with less mass by its curvature; requires this relative accuracy of its density
// in the boxes.
constexpr double least_share = 1e-3, well_known = 0.5;

}  // namespace

bool BoxIntegrator::reaches_maxima() const {
  return std::all_of(settings_.maxima.begin(), settings_.maxima.end(),
                     [&](const Mode& mode) { return map_.reaches(mode.position); });
}

BoxIntegrator::Place BoxIntegrator::place_of(const Whitening& whitening) const {
  Place place{map_.from_real(whitening.center), {}, {}, 0, 1};
  place.log_density = posterior_.value(view(whitening.center));
  Eigen::MatrixXd steps(d_, d_);
  for (int i = 0; i < d_; ++i) {
    const Coordinates there = map_.from_real(whitening.center + whitening.scale.col(i));
    for (int a = 0; a < d_; ++a) steps(a, i) = there[a] - place.u[a];
  }
  const Eigen::MatrixXd covariance = steps * steps.transpose(), precision = covariance.inverse();
  for (int a = 0; a < d_; ++a) {
    place.width[a] = std::sqrt(covariance(a, a));
    place.narrow[a] = 1 / std::sqrt(precision(a, a));
  }
  place.volume = std::abs(steps.determinant());
  return place;
}

void BoxIntegrator::reach_maxima() {
  if (settings_.maxima.empty()) return;
  std::vector<Whitening> all;
  for (const Mode& mode : settings_.maxima) all.push_back(whitening_at(mode));
  for (const Whitening& each : all) places_.push_back(place_of(each));
  for (const Place& place : places_) {
    reference_ = std::max(reference_, place.log_density);
    for (int a = 0; a < d_; ++a) {
      lower_[a] = std::min(lower_[a], place.u[a] - widths_beyond * place.width[a]);
      upper_[a] = std::max(upper_[a], place.u[a] + widths_beyond * place.width[a]);
    }
  }
  Place first{{}, {}, {}, -INFINITY, 0};
  first.narrow.fill(1);
  places_.push_back(first);
  for (Place& place : places_) place.log_density -= reference_;
}

void BoxIntegrator::halve_at_maxima() {
  for (const Place& place : places_) {
    while (failure_.empty()) {
      const std::size_t box = tree_.find(place.u);
      if (box == BoxTree::none) break;
      int longest = 0;
      double most = 0;
      for (int a = 0; a < d_; ++a) {
        const double ratio = (cells_[box].upper[a] - cells_[box].lower[a]) / place.narrow[a];
        if (ratio > most) longest = a;
        most = std::max(most, ratio);
      }
      if (!(most > widths_in_a_box)) break;
      halve(box, longest);
    }
  }
}

bool BoxIntegrator::missed_maximum() const {
  for (const Place& place : places_) {
    const RidgeMap::Frame frame = map_.at(place.u[map_.axis()]);
    const double density = std::exp(place.log_density + frame.log_jacobian - log_jacobian_);
    const double mass = density * place.volume * std::pow(2 * M_PI, 0.5 * d_);
    if (!(mass > least_share * mass_)) continue;
    const std::size_t box = tree_.find(place.u);
    if (box == BoxTree::none) return true;
    if (std::abs(density_by(cells_[box], place.u) / density - 1) > well_known) return true;
  }
  return false;
}

}  // namespace wearwell
