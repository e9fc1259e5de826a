#include "wearwell/bayes/posterior_along.h"

#include <cmath>

#include "wearwell/math/constants.h"

namespace wearwell {

PosteriorAlong::PosteriorAlong(const Posterior& posterior, std::span<const double> z,
                               std::size_t axis)
    : posterior_(posterior), axis_(axis), dimension_(z.size()) {
  for (std::size_t i = 0; i < dimension_; ++i) {
    const Transform::Point point = posterior.transforms()[i].from_real(z[i]);
    const Distribution& prior = posterior.parameters()[i].prior;
    x_[i] = point.x;
    if (i == axis) continue;
    possible_ = possible_ && prior.lower < point.x && point.x < prior.upper;
    if (!possible_) continue;
    const double here = log_density(prior, point.x).value + point.log_jacobian;
    if (i < axis) {
      before_ += here;
    } else {
      behind_[i] = here;
    }
  }
  if (possible_) likelihood_ = posterior.likelihood()->along({x_.data(), dimension_}, axis);
}

double PosteriorAlong::value(double z) {
  const Transform::Point point = posterior_.transforms()[axis_].from_real(z);
  const Distribution& prior = posterior_.parameters()[axis_].prior;
  x_[axis_] = point.x;
  if (!(possible_ && prior.lower < point.x && point.x < prior.upper)) return -infinity;
  // In the order of the sum in Posterior.
  double sum = before_ + (log_density(prior, point.x).value + point.log_jacobian);
  for (std::size_t i = axis_ + 1; i < dimension_; ++i) sum += behind_[i];
  sum +=
      likelihood_ ? likelihood_(point.x) : posterior_.likelihood()->value({x_.data(), dimension_});
  return std::isnan(sum) ? -infinity : sum;
}

}  // namespace wearwell
