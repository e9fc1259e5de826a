#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace wearwell {

/// The maximum number of variables. Workspace on the stack has this size, so that evaluations do
/// not allocate.
inline constexpr int max_dimension = 64;

/// The logarithm of a density, up to a constant. -infinity only outside the support; other failures
/// throw. Evaluations are thread-safe.
class LogDensity {
 public:
  virtual ~LogDensity() = default;

  /// Number of variables, 1..max_dimension.
  virtual int dimension() const = 0;

  virtual double value(std::span<const double> x) const = 0;

  /// The value at `x`, and its derivatives in `gradient`. The gradient is unspecified if the value
  /// is -infinity.
  virtual double value_and_gradient(std::span<const double> x,
                                    std::span<double> gradient) const = 0;

  /// The value if it exceeds `least`; else any number up to `least`, so that an expensive
  /// evaluation can stop early.
  virtual double value_above(std::span<const double> x, double /*least*/) const { return value(x); }

  /// The value as a function of one variable, with the others from `x` and constant parts
  /// precomputed. Empty if that saves nothing; valid during the lifetime of the density.
  virtual std::function<double(double)> along(std::span<const double>, std::size_t) const {
    return {};
  }

  /// The logarithm of each factor of a likelihood that is a product over independent observations;
  /// empty for any other density.
  virtual std::vector<double> pointwise(std::span<const double>) const { return {}; }

  /// The number of equal observations that each factor represents; empty if all are 1.
  virtual std::vector<int> pointwise_counts() const { return {}; }

  /// The likelihood without one observation of factor `term`; null if subtracting the factor is
  /// equally simple.
  virtual std::shared_ptr<const LogDensity> without(std::size_t) const { return nullptr; }

  /// The remaining error of the value at `x`, if integrals within it miss their tolerance; else 0.
  virtual double unsettled(std::span<const double>) const { return 0; }

  /// Whether an evaluation is expensive (it contains integrals over a limit or a path). Then
  /// quadrature in more than two dimensions is avoided, a polynomial surrogate is tried, and a
  /// sampler uses independence proposals as early as possible.
  virtual bool is_slow() const { return false; }
};

}  // namespace wearwell
