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

/// The natural logarithm of a density, up to a constant. -infinity outside the support and nowhere
/// else; any other failure throws. Evaluations are thread-safe. Every span `x` and `gradient` has
/// dimension() entries; units are those of the caller, SI for a likelihood.
class LogDensity {
 public:
  virtual ~LogDensity() = default;

  /// Number of variables, 1..max_dimension.
  virtual int dimension() const = 0;

  /// The log density at `x`.
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

  /// The log of each factor at `x` of a likelihood that is a product over independent observations,
  /// one entry a factor in an order that does not change; empty for any other density.
  virtual std::vector<double> pointwise(std::span<const double>) const { return {}; }

  /// How many observations each factor of `pointwise` stands for, where some are alike; empty when
  /// each is one.
  virtual std::vector<int> pointwise_counts() const { return {}; }

  /// The likelihood without one observation of factor `term` of `pointwise`; null where that is no simpler than to take the
  /// factor away.
  virtual std::shared_ptr<const LogDensity> without(std::size_t) const { return nullptr; }

  /// Estimated error of the value at `x`, where integrals within it did not reach their tolerance; 0
  /// elsewhere.
  virtual double unsettled(std::span<const double>) const { return 0; }

  /// Whether one evaluation is expensive, as long as tens or thousands of others (integrals within it, over a limit or a
  /// path): then there is no quadrature in more than two dimensions, surrogates are tried, and a sampler proposes from them
  /// as early as it can.
  virtual bool is_slow() const { return false; }
};

}  // namespace wearwell
