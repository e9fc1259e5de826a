#pragma once

#include <Eigen/Dense>
#include <span>
#include <vector>

#include "wearwell/base/rng.h"
#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/infer/maxima.h"
#include "wearwell/infer/whitened.h"

namespace wearwell {

/// A mixture of multivariate Student distributions on the real line, one about each local maximum
/// of a posterior, with its curvature and mass.
class MaximaMixture {
 public:
  /// `evenly`: the fraction of the weights, 0 to 1, that is divided equally.
  MaximaMixture(std::span<const LocalMaximum> maxima, double freedom, double evenly = 0);

  std::size_t size() const { return components_.size(); }

  /// Up to a constant.
  double log_density(std::span<const double> z) const;

  /// The log of component k's share of the density at z; writes its derivatives to `gradient`
  /// unless that is empty.
  double log_share(std::span<const double> z, std::size_t k, std::span<double> gradient) const;

  /// The component with the largest share.
  std::size_t nearest(std::span<const double> z) const;

  Eigen::VectorXd draw(Rng& rng) const;

 private:
  struct Component {
    Whitening round;
    Eigen::MatrixXd inverse;  // of its scale
    double weight = 0, log_height = 0;
  };
  double log_term(std::span<const double> z, const Component& component) const;
  // Adds `factor` times the derivatives of a component's log density.
  void add_slope(std::span<const double> z, const Component& component, double factor,
                 std::span<double> gradient) const;

  std::vector<Component> components_;
  double freedom_;
};

/// The mixture that assigns posterior points to the maxima.
MaximaMixture counting_mixture(const Maxima& maxima);

/// The mass about each maximum, from weighted posterior points.
void measure_shares(const Posterior& posterior, const WeightedDraws& points, Maxima& maxima);

}  // namespace wearwell
