#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace wearwell {

/// The most variables a density may have; fixes the size of scratch on the stack, so that no
/// evaluation allocates.
inline constexpr int max_dimension = 64;

/// The logarithm of a density, up to a constant. -infinity outside the support and nowhere else;
/// any other failure throws. Evaluations are thread-safe.
class LogDensity {
 public:
  virtual ~LogDensity() = default;

  /// Number of variables, 1..max_dimension.
  virtual int dimension() const = 0;

  virtual double value(std::span<const double> x) const = 0;

  /// The value at `x`, and its derivatives in `gradient`. The gradient is unspecified where the
  /// value is -infinity.
  virtual double value_and_gradient(std::span<const double> x,
                                    std::span<double> gradient) const = 0;

  /// The value where it is more than `least`; else anything that is not, so that what takes long may end as soon as that is
  /// known.
  virtual double value_above(std::span<const double> x, double /*least*/) const { return value(x); }

  /// The value along one variable, the others being those of `x`: what does not change is worked out once. Empty where that
  /// would save nothing; valid while the density lives.
  virtual std::function<double(double)> along(std::span<const double>, std::size_t) const {
    return {};
  }

  /// The logarithm of each factor of a likelihood that is a product over independent observations;
  /// empty for any other density.
  virtual std::vector<double> pointwise(std::span<const double>) const { return {}; }

  /// How many observations each of these stands for, where some were seen alike; empty when each is
  /// one.
  virtual std::vector<int> pointwise_counts() const { return {}; }

  /// The likelihood without one observation of factor `term`; null where that is no simpler than to take the factor away.
  virtual std::shared_ptr<const LogDensity> without(std::size_t) const { return nullptr; }

  /// What is left open of the value at `x`, where integrals within it did not come to the tolerance that
  /// they promise; 0 elsewhere.
  virtual double unsettled(std::span<const double>) const { return 0; }

  /// Whether one evaluation takes as long as tens or thousands of others (integrals within it, a limit's or a path's):
  /// quadrature in more than two dimensions is then not for it, polynomials in its place are worth trying, and a
  /// sampler leaps as early as it can.
  virtual bool is_slow() const { return false; }
};

}  // namespace wearwell
