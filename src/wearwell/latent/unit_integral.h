#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace wearwell::latent {

inline constexpr int most_effects = 2;

/// The likelihood of units with random effects z (a vector of standard normal numbers each).
/// Evaluates all units at once, so that a formula runs over whole columns. For one thread;
/// parameters are fixed.
class UnitTerms {
 public:
  virtual ~UnitTerms() = default;
  virtual std::size_t units() const = 0;
  virtual int effects() const = 0;  ///< per unit, 1 or 2

  /// log p(data of unit u | z_u) for each unit with `wanted[u]`, -infinity for zero density, never
  /// NaN; with `slope` its derivatives by z_u. `z` and `slope` have `effects()` entries per unit.
  virtual void evaluate(std::span<const double> z, std::span<const std::uint8_t> wanted,
                        std::span<double> value, std::span<double> slope) = 0;
};

/// Units at one node of each unit's lattice.
struct Sweep {
  std::vector<double> z;       ///< units x effects
  std::vector<double> log_f;   ///< log p(data | z) + log N(z; 0, 1); -infinity if not evaluated
  std::vector<double> weight;  ///< of the posterior of z_u, sums to 1 over the sweeps
};

/// The likelihood with each unit's effects integrated out,
///
///   log L_u = log of the integral of p(data_u | z) N(z; 0, 1) dz,
///
/// and the posterior of each unit's effects on the nodes used. Uses the trapezoidal rule about the
/// mode, in units of the width there. For an analytic integrand that decreases at both ends it
/// converges faster than any power of the step, and the integrand need not be normal. It extends
/// until the integrand is e^-36 of its maximum. The rule with every second node gives an error
/// estimate; if they do not agree, the step is halved. `settled` is false if that does not
/// converge; `unsettled` is then the remaining relative difference, summed over these units.
struct UnitIntegrals {
  std::vector<double> log_likelihood;  ///< of each unit
  std::vector<Sweep> sweeps;
  bool settled = true;
  double unsettled = 0;

  double sum() const;

  /// For rules that process unit after unit: clears the nodes; adds nodes (those at one `place`
  /// form a sweep; `log_f` is not filled); removes empty sweeps.
  void restart(std::size_t units, std::size_t effects);
  void put(std::size_t unit, std::size_t place, const double* z, double weight_of_node);
  void finish() { sweeps.resize(used_); }

 private:
  std::size_t units_ = 0, effects_ = 0, used_ = 0;
};

/// Fills `result` and reuses its memory.
void integrate(UnitTerms& terms, UnitIntegrals& result);

}  // namespace wearwell::latent
