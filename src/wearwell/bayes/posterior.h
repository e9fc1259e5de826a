#pragma once

#include <Eigen/Dense>
#include <memory>
#include <vector>

#include "wearwell/bayes/log_density.h"
#include "wearwell/bayes/parameter.h"
#include "wearwell/prob/transform.h"

namespace wearwell {

/// Bayes' rule: log prior + log likelihood. As a LogDensity it is defined on the unconstrained
/// scale z, with the Jacobian of the transform; x are the natural parameters.
class Posterior final : public LogDensity {
 public:
  /// `likelihood` takes the natural parameters, SI, in the order of `parameters`, 1 to
  /// `max_dimension` of them. Throws InputError when a start value is outside its support or when
  /// the posterior is not finite there.
  Posterior(std::vector<Parameter> parameters, std::shared_ptr<const LogDensity> likelihood);

  int dimension() const override { return static_cast<int>(parameters_.size()); }
  double value(std::span<const double> z) const override;
  double value_above(std::span<const double> z, double least) const override;
  double value_and_gradient(std::span<const double> z, std::span<double> gradient) const override;

  const std::vector<Parameter>& parameters() const { return parameters_; }
  const std::shared_ptr<const LogDensity>& likelihood() const { return likelihood_; }
  /// The transform of each parameter, z to x.
  const std::vector<Transform>& transforms() const { return transforms_; }

  /// Sum of the log densities of the priors at natural parameters; up to a constant where one is
  /// improper.
  double log_prior(std::span<const double> x) const;

  /// log prior + log likelihood of natural parameters, -infinity outside the support.
  double natural_value(std::span<const double> x) const;

  /// The same with its derivatives by natural parameters; x must be inside the support.
  double natural_value_and_gradient(std::span<const double> x, std::span<double> gradient) const;

  /// Natural parameters, SI, of z; both have dimension() entries.
  void to_natural(std::span<const double> z, std::span<double> x) const;

  /// z of the parameters' start values.
  Eigen::VectorXd start() const;

  /// z of natural parameters strictly inside the support.
  Eigen::VectorXd to_real(std::span<const double> x) const;

 private:
  std::vector<Parameter> parameters_;
  std::vector<Transform> transforms_;
  std::shared_ptr<const LogDensity> likelihood_;
};

}  // namespace wearwell
