#pragma once

#include <optional>
#include <vector>

#include "wearwell/bayes/observation.h"
#include "wearwell/models/bearing/depth_function.h"

namespace wearwell::bearing {

/// What is known of the log-likelihood of one bearing's ln k before it is integrated. It falls from
/// the highest of its peaks on; in between it may do anything.
struct RateShape {
  double lowest = 0, highest = 0;  ///< ln k of these peaks; -infinity: no wear is likeliest
  double peak = 0;                 ///< ln k of a high one
  double curvature = 0;            ///< about minus the second derivative there
  double largest = 0;              ///< the log-likelihood is nowhere above this
  double limit = 0;                ///< largest ln k that the geometry allows
  bool one_peak = false;           ///< it rises up to the one and falls from there on
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

  /// Throws InputError for a depth that the geometry excludes.
  Inspected(ObservationFamily family, std::vector<DepthFunction> curves, std::vector<Duty> duties,
            std::vector<double> depths);

  std::size_t size() const { return depths_.size(); }
  double limit() const { return limit_; }

  /// log of the likelihood of ln k: -infinity beyond the limit. For the normal family without its
  /// factors of sigma.
  Point at(double log_k, double sigma) const;

  RateShape shape(double sigma) const;

  /// No ln k of at most `log_k`, itself below all peaks, has a larger log-likelihood than this.
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
  HermiteTable squares_;     // the sum of squares by ln k, for the normal family: the only way in
                             // which k enters, at any sigma; empty where rows are few
  double limit_;             // of ln k
  double lowest_, highest_;  // ln k of what each depth says, or all together (normal family)
  double peak_;
  double information_ = 0;    // sum of (d depth/d ln k)^2 there, m^2
  double least_squares_ = 0;  // no sum of squares is less
};

/// ln k of one inspection for itself; none when there is no wear.
std::optional<double> single_log_k(const Duty& duty, double depth);

}  // namespace wearwell::bearing
