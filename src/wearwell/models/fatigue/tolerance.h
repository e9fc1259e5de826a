#pragma once

#include <vector>

namespace wearwell::fatigue {

/// Least squares of y on x, as ASTM E739 and ISO 12107 fit log10 life on log10 stress.
struct FittedLine {
  double n = 0;
  double intercept = 0, slope = 0;
  double sd = 0;                  ///< about the line, by n - 2
  double mean_x = 0, sum_xx = 0;  ///< sum of squares about the mean

  double freedom() const { return n - 2; }
  double at(double x) const { return intercept + slope * x; }
  /// 1/n + (x - mean)^2/sum_xx: the variance of the line there, in those about it.
  double leverage(double x) const {
    const double away = x - mean_x;
    return 1 / n + away * away / sum_xx;
  }
};

/// At least three points at two x.
FittedLine fit_line(const std::vector<double>& x, const std::vector<double>& y);

/// The factor k of a one-sided tolerance limit, y - k sd: with this confidence a share
/// `reliability` of a normal distribution lies above it, if its mean was estimated with a variance
/// of `leverage` and its standard deviation with this number of degrees of freedom (Owen 1968): the
/// noncentral t quantile t(confidence; freedom, z sqrt(1/leverage)) sqrt(leverage).
double owen_factor(double reliability, double confidence, double leverage, double freedom);

/// Lower limits of y at x:
///   Owen      exact for the line
///   ISO 12107 k of a plain sample of freedom + 1, times sqrt(1 + leverage)
///   E739      the lower end of the band that contains the whole median line (its reliability is
///   1/2)
double owen_limit(const FittedLine& line, double x, double reliability, double confidence);
double iso_12107_limit(const FittedLine& line, double x, double reliability, double confidence);
double astm_e739_band(const FittedLine& line, double x, double confidence);

}  // namespace wearwell::fatigue
