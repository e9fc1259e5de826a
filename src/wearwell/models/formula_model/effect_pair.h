#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace wearwell::formula_model {

/// A unit whose log-likelihood is quadratic in the steps s of two effects from their medians,
///
///   log p(data | s) = top - (s - best)' H (s - best)/2.
///
/// With z standard normal, v = (z0, r z0 + sqrt(1 - r^2) z1) are the effects' own standard normal numbers, and
/// s_e = exp(scatter_e v_e) - 1 of a lognormal effect, scatter_e v_e of a normal one.
struct EffectPair {
  double best[2], H[3];  ///< H: 00, 01, 11
  bool lognormal[2];
  double scatter[2];
  double correlation = 0;

  /// log p - top - z'z/2.
  double log_f(double z0, double z1) const;

  /// The nodes of an integral, line by line: each line has one z0. One thread uses it at a time.
  struct Nodes {
    struct Line {
      std::size_t begin;
      double z0, step0, width;
      bool odd;
    };
    static constexpr std::size_t most = 30000;
    std::vector<Line> lines;
    std::size_t count = 0;
    std::vector<double> z1, step1;
    std::vector<double> share;  ///< of the integral; sum to 1
    std::vector<unsigned char> odd;

    Nodes() : z1(most), step1(most), share(most), odd(most) {}
    std::size_t end(std::size_t line) const {
      return line + 1 < lines.size() ? lines[line + 1].begin : count;
    }
  };
  /// Means over the unit's posterior.
  struct Moments {
    double first[2] = {}, second[3] = {};  ///< of steps; 00, 01, 11
    /// Means of the derivative of log p by v_e, over scatter_e; of that times v_e; and of log p by
    /// the correlation.
    double slope[2] = {}, slope_v[2] = {}, by_correlation = 0;
  };

  /// Distance of nodes, in widths at the mode: fine enough for the integral and for lives.
  static constexpr double coarse = 0.5, fine = 0.4;

  /// log of the integral of exp(log p - top) N(z; 0, I) dz, to about 1e-9. The trapezoidal rule
  /// over z0, and at each of its nodes over z1 around the mode there, so that it follows a curved
  /// ridge. If it disagrees with every second of its nodes, integrates one effect after the other,
  /// as needed for scatters far beyond 1: then `open` is the relative difference between the last
  /// rule and every second node of it, and else 0. Empty if there is no mode.
  std::optional<double> log_integral(Nodes& nodes, double gap = coarse,
                                     double* open = nullptr) const;
  Moments moments(const Nodes& nodes) const;

  /// An upper bound of log_integral, from each effect alone: outside |v| < V by the mass there, inside by the nearest step.
  double log_bound() const;
};

}  // namespace wearwell::formula_model
