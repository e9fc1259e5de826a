#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace wearwell::formula_model {

/// A unit whose log-likelihood is quadratic in a lognormal effect: with z standard normal, e^(s z)
/// - 1 is the step from the median, and -h/2 (step - best)^2 the log-likelihood of the unit's rows.
struct LognormalUnit {
  double best, h, s;

  /// A node around the mode: 0, the first to the right (1, 3, ...) and to the left (2, 4, ...).
  struct Node {
    std::size_t place;
    double z, step;
    double weight;  ///< its weight in the integral
  };

  /// -h/2 (e^sz - 1 - best)^2 - z^2/2.
  double at(double z) const;
  double at(double z, double step) const {
    return -0.5 * h * (step - best) * (step - best) - 0.5 * z * z;
  }

  /// Distance of nodes, in widths at the mode: fine enough for the integral and for lives.
  static constexpr double coarse = 0.6, fine = 0.25;

  /// log of the integral of exp(at(z)) dz, without the constant of the normal density; empty if a
  /// rule and every second of its nodes disagree. `kept` takes the nodes.
  std::optional<double> log_integral(std::vector<Node>* kept, double gap = coarse) const;

 private:
  struct LaplaceApproximation {
    double center, width;
  };
  LaplaceApproximation approximation() const;
  std::optional<double> by_even_steps(const LaplaceApproximation& approximation, double gap,
                                      std::vector<Node>* kept) const;
  std::optional<double> by_rule(const LaplaceApproximation& approximation, int stride,
                                std::vector<Node>* kept) const;
};

}  // namespace wearwell::formula_model
