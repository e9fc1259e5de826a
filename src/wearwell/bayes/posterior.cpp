#include "wearwell/bayes/posterior.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/stop_scope.h"
#include "wearwell/math/view.h"

namespace wearwell {
namespace {

constexpr double minus_infinity = -std::numeric_limits<double>::infinity();

// A likelihood that overflows is far outside the plausible range of parameters.
double in_support(double value) {
  return std::isnan(value) ? minus_infinity : value;
}

// The same if the gradient is not finite, because searches need it.
double in_support(double value, std::span<double> gradient) {
  for (const double each : gradient) {
    if (std::isfinite(each)) continue;
    value = minus_infinity;
  }
  if (!std::isfinite(value)) std::fill(gradient.begin(), gradient.end(), 0.0);
  return in_support(value);
}

}  // namespace

Posterior::Posterior(std::vector<Parameter> parameters,
                     std::shared_ptr<const LogDensity> likelihood)
    : parameters_(std::move(parameters)), likelihood_(std::move(likelihood)) {
  if (dimension() != likelihood_->dimension()) {
    throw std::logic_error(
        "posterior: the numbers of parameters and of likelihood arguments are not equal");
  }
  if (parameters_.empty() || dimension() > max_dimension) {
    throw InputError(fmt::format("the model has {} parameters; 1 to {} are allowed",
                                 parameters_.size(), max_dimension));
  }
  for (const Parameter& p : parameters_) {
    const Distribution& prior = p.prior;
    if (!(prior.lower < p.start && p.start < prior.upper)) {
      throw InputError(fmt::format(
          "prior.{}: its distribution leaves no number between {:.17g} and {:.17g} {} to start "
          "from",
          p.name, prior.lower, prior.upper, p.si));
    }
    // Near a bound, one unit of z is a factor of e in the distance to the bound.
    const double scale = std::isfinite(prior.lower)   ? p.start - prior.lower
                         : std::isfinite(prior.upper) ? prior.upper - p.start
                                                      : p.scale;
    transforms_.emplace_back(prior.lower, prior.upper, scale);
  }
  const Eigen::VectorXd z = start();
  if (!std::isfinite(value(view(z)))) {
    throw InputError(
        "the posterior is zero at plausible parameter values: prior, data and model contradict "
        "each "
        "other");
  }
}

double Posterior::value(std::span<const double> z) const {
  return value_above(z, minus_infinity);
}

double Posterior::value_above(std::span<const double> z, double least) const {
  check_stop();
  std::array<double, max_dimension> x;
  double sum = 0;
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    const Transform::Point point = transforms_[i].from_real(z[i]);
    const Distribution& prior = parameters_[i].prior;
    if (!(prior.lower < point.x && point.x < prior.upper)) return minus_infinity;
    x[i] = point.x;
    sum += log_density(prior, point.x).value + point.log_jacobian;
  }
  const std::span<const double> natural(x.data(), parameters_.size());
  return in_support(sum + (least == minus_infinity
                               ? likelihood_->value(natural)
                               : likelihood_->value_above(natural, least - sum)));
}

double Posterior::value_and_gradient(std::span<const double> z, std::span<double> gradient) const {
  check_stop();
  std::array<double, max_dimension> x, slope, rest;
  double sum = 0;
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    const Transform::Point point = transforms_[i].from_real(z[i]);
    const Distribution& prior = parameters_[i].prior;
    if (!(prior.lower < point.x && point.x < prior.upper)) return minus_infinity;
    x[i] = point.x;
    slope[i] = point.slope;
    const LogDensityAndSlope p = log_density(prior, point.x);
    sum += p.value + point.log_jacobian;
    rest[i] = p.slope * point.slope + point.log_jacobian_slope;
  }
  sum += likelihood_->value_and_gradient(std::span(x.data(), parameters_.size()), gradient);
  for (std::size_t i = 0; i < parameters_.size(); ++i)
    gradient[i] = gradient[i] * slope[i] + rest[i];
  return in_support(sum, gradient.first(parameters_.size()));
}

double Posterior::log_prior(std::span<const double> x) const {
  double sum = 0;
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    sum += log_density(parameters_[i].prior, x[i]).value;
  }
  return sum;
}

double Posterior::natural_value(std::span<const double> x) const {
  check_stop();
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    const Distribution& prior = parameters_[i].prior;
    if (!(prior.lower < x[i] && x[i] < prior.upper)) return minus_infinity;
  }
  return in_support(log_prior(x) + likelihood_->value(x));
}

double Posterior::natural_value_and_gradient(std::span<const double> x,
                                             std::span<double> gradient) const {
  check_stop();
  double sum = likelihood_->value_and_gradient(x, gradient);
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    const LogDensityAndSlope prior = log_density(parameters_[i].prior, x[i]);
    sum += prior.value;
    gradient[i] += prior.slope;
  }
  return in_support(sum, gradient.first(parameters_.size()));
}

void Posterior::to_natural(std::span<const double> z, std::span<double> x) const {
  for (std::size_t i = 0; i < parameters_.size(); ++i) x[i] = transforms_[i].natural(z[i]);
}

Eigen::VectorXd Posterior::start() const {
  Eigen::VectorXd z(dimension());
  for (int i = 0; i < dimension(); ++i) z[i] = transforms_[i].to_real(parameters_[i].start);
  return z;
}

Eigen::VectorXd Posterior::to_real(std::span<const double> x) const {
  Eigen::VectorXd z(dimension());
  for (int i = 0; i < dimension(); ++i) z[i] = transforms_[i].to_real(x[i]);
  return z;
}

}  // namespace wearwell
