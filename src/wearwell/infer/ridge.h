#pragma once

#include <Eigen/Dense>
#include <array>
#include <span>
#include <vector>

#include "wearwell/bayes/log_density.h"

namespace wearwell {

/// The density of all coordinates but one, which is held. Refers to `whole`, which must outlive it.
class Slice final : public LogDensity {
 public:
  Slice(const LogDensity& whole, int held) : whole_(whole), held_(static_cast<std::size_t>(held)) {}

  double at = 0;  ///< the value of the held coordinate

  int dimension() const override { return whole_.dimension() - 1; }
  double value(std::span<const double> rest) const override;
  double value_and_gradient(std::span<const double> rest,
                            std::span<double> gradient) const override;

  /// All coordinates.
  Eigen::VectorXd whole(const Eigen::VectorXd& rest) const;

 private:
  using Buffer = std::array<double, max_dimension>;
  Buffer expand(std::span<const double> rest) const;

  const LogDensity& whole_;
  std::size_t held_;
};

/// All coordinates but that one.
Eigen::VectorXd without(const Eigen::VectorXd& whole, Eigen::Index held);

/// One place on a ridge: a coordinate is held, the others are at their conditional mode.
struct ConditionalMode {
  double at = 0;          ///< of the held coordinate
  Eigen::VectorXd rest;   ///< the others
  Eigen::VectorXd width;  ///< of the others there, one by one
  Eigen::MatrixXd curvature;
  double log_density = 0;   ///< of all coordinates, there
  double log_marginal = 0;  ///< of the held coordinate, the others integrated out by Laplace
  bool converged = false;   ///< the others have a mode there, and it was found
};

/// Climbs from the highest of `guesses` to the conditional mode at `slice.at`. `width` > 0 is about
/// how far the others may move.
ConditionalMode visit(const Slice& slice, const std::vector<Eigen::VectorXd>& guesses,
                      const Eigen::VectorXd& width);

/// Where the others may be at the next station, `step` farther than the last of the two: where they were,
/// on the straight line through both, and on the curves of what grows or shrinks like e^held.
std::vector<Eigen::VectorXd> guesses(const ConditionalMode& before, const ConditionalMode& last,
                                     double step);

}  // namespace wearwell
