#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

namespace wearwell::formula_model {

/// A unit of Weibull (or extreme value) lives whose log scale is linear in its standard normal effect
/// z. For any number of exact and right-censored rows its log-likelihood, without a constant, is
///
///   -failures rate z - exp(log_sum - rate z),
///
/// with `log_sum` the log of the sum of (life/scale)^shape at z = 0 and `rate` the shape times the
/// slope of the log scale. It is concave, and so is the logarithm of the integrand.
struct ExtremeValueUnit {
  double failures, log_sum, rate;

  double at(double z) const;  ///< with -z^2/2

  /// Distances of nodes in widths at the mode, tried in turn until the rule and every second of its
  /// nodes agree (unit_rule.h); those of `fine` are as dense as lives need.
  static constexpr double coarse[] = {0.6, 0.3, 0.15, 0.075, 0.0375};
  static constexpr double fine[] = {0.25, 0.125, 0.0625, 0.03125};

  struct Nodes {
    static constexpr std::size_t most = 1500;
    std::size_t count = 0;
    std::array<double, most> z, f;    // f: weights of the integral
    std::array<double, most> hazard;  // exp(log_sum - rate z)
    std::array<bool, most> odd;
  };

  /// log of the integral of exp(at(z)) dz over the square root of 2 pi, by the trapezoidal rule about
  /// the mode. Empty if it does not converge.
  std::optional<double> log_integral(Nodes& nodes, std::span<const double> gaps = coarse) const;

 private:
  struct Mode {
    double z, width;
  };
  Mode mode() const;
  bool fill(Nodes& nodes, const Mode& mode, double width) const;
  std::optional<double> sharply_cut(Nodes& nodes) const;
};

}  // namespace wearwell::formula_model
