#pragma once

#include <Eigen/Dense>
#include <array>
#include <span>
#include <vector>

#include "wearwell/bayes/log_density.h"

namespace wearwell {

/// The density of all coordinates except one, which is fixed. Refers to `whole`, which must outlive
/// it.
class Slice final : public LogDensity {
 public:
  Slice(const LogDensity& whole, int held) : whole_(whole), held_(static_cast<std::size_t>(held)) {}

  double at = 0;  ///< value of the fixed coordinate

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

/// All coordinates except that one.
Eigen::VectorXd without(const Eigen::VectorXd& whole, Eigen::Index held);

/// A point on a ridge: one coordinate is fixed, the others are at their conditional mode.
struct ConditionalMode {
  double at = 0;          ///< of the held coordinate
  Eigen::VectorXd rest;   ///< the others
  Eigen::VectorXd width;  ///< conditional width of each other coordinate
  Eigen::MatrixXd curvature;
  double log_density = 0;   ///< of all coordinates at this point
  double log_marginal = 0;  ///< of the fixed coordinate, with the others integrated out by
                            ///< Laplace's approximation
  bool converged = false;   ///< the conditional mode of the others exists and was found
};

/// Searches the conditional mode at `slice.at` from the highest of `guesses`. `width` > 0 is about
/// the possible change of the others.
ConditionalMode visit(const Slice& slice, const std::vector<Eigen::VectorXd>& guesses,
                      const Eigen::VectorXd& width);

/// Guesses for the others at the next station, `step` beyond the last of the two: unchanged, linear
/// extrapolation through both, and exponential extrapolation.
std::vector<Eigen::VectorXd> guesses(const ConditionalMode& before, const ConditionalMode& last,
                                     double step);

}  // namespace wearwell
