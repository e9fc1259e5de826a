#pragma once

#include <optional>
#include <vector>

#include "wearwell/bayes/observation.h"
#include "wearwell/models/bearing/depth_function.h"

namespace wearwell::bearing {

/// Bounds on the log-likelihood of one bearing's ln k before it is integrated. It decreases on both
/// sides of its outermost peaks; between them it may have any form.
struct RateShape {
  /// ln k of these peaks; -infinity: no wear has the maximum likelihood
  double lowest = 0, highest = 0;
  double peak = 0;        ///< ln k of a high one
  double curvature = 0;   ///< approximately minus the second derivative there
  double largest = 0;     ///< upper bound of the log-likelihood
  double limit = 0;       ///< largest ln k that the geometry allows
  bool one_peak = false;  ///< it has a single peak
};

/// The inspections of one bearing.
class Inspected {
 public:
  /// A log-likelihood with its derivatives.
  struct Point {
    double value;
    double by_log_k;
    double by_sigma;
  };

  /// Throws InputError for a depth outside the geometry.
  Inspected(ObservationFamily family, std::vector<DepthFunction> curves, std::vector<Duty> duties,
            std::vector<double> depths);

  std::size_t size() const { return depths_.size(); }
  double limit() const { return limit_; }

  /// log of the likelihood of ln k: -infinity beyond the limit. For the normal family without its
  /// factors of sigma.
  Point at(double log_k, double sigma) const;

  RateShape shape(double sigma) const;

  /// Upper bound of the log-likelihood for all ln k up to `log_k`, which is below all peaks.
  double largest_below(double log_k, double sigma) const;

  /// log of the density of each depth at ln k.
  std::vector<double> pointwise(double log_k, double sigma) const;

 private:
  HermiteTable::Point sum_of_squares(double log_k) const;
  void find_wells();

  ObservationFamily family_;
  std::vector<DepthFunction> curves_;
  std::vector<Duty> duties_;
  std::vector<double> depths_;
  std::optional<Observations> observations_;  // for the lognormal family
  // the sum of squares by ln k, for the normal family: the only term with
  HermiteTable squares_;
  // k, for any sigma; empty if there are few rows
  double limit_;             // of ln k
  double lowest_, highest_;  // ln k from each depth, or from all together (normal family)
  double peak_;
  double information_ = 0;    // sum of (d depth/d ln k)^2 there, m^2
  double least_squares_ = 0;  // minimum of the sum of squares
};

/// ln k from a single inspection; empty if there is no wear.
std::optional<double> single_log_k(const Duty& duty, double depth);

}  // namespace wearwell::bearing
