#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace wearwell::formula_model {

/// Readings of one Wiener path with errors, as a function of a factor q: the mean of each step is q
/// times its growth, its variance q times its variance (`scaled`) or the variance itself, and each
/// reading has an independent error. By Kalman's recursion, at several q together.
class NoisySteps {
 public:
  /// Between readings; the path starts at 0. All SI.
  struct Step {
    double growth, variance,
        noise;  ///< of mean and variance at q = 1; variance of the reading's error
    double reading;
    double per_all;  ///< 1/(variance + noise)
  };
  static constexpr std::size_t together = 8;

  void clear(bool scaled);
  /// Variances must be non-negative, and at least one positive.
  void add(double growth, double variance, double noise, double reading);
  std::size_t count() const { return steps_.size(); }
  const Step& operator[](std::size_t i) const { return steps_[i]; }

  /// log density of all readings at `together` factors.
  void log_densities(const double* q, double* value) const;
  /// At one, and its derivative by q.
  struct Place {
    double value, slope;
  };
  Place at(double q) const;

  /// If variances are not scaled: constant + by_one q + by_square q^2.
  struct Quadratic {
    double constant = 0, by_one = 0, by_square = 0;
  };
  Quadratic quadratic() const;

  /// Derivatives of sums over weighted factors.
  struct Slopes {
    std::vector<double> growth, variance, noise;  ///< of each step
    void restart(std::size_t steps);
  };
  /// Adds those of the log density at `together` factors to `slopes`; fills `by_q` for each.
  void add_slopes(const double* q, const double* weight, Slopes& slopes, double* by_q) const;

 private:
  bool scaled_ = false;
  double constant_ = 0;
  std::vector<Step> steps_;
};

}  // namespace wearwell::formula_model
