#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace wearwell::latent {

inline constexpr int most_effects = 2;

/// The likelihood of units, each with effects z of its own (a vector of standard normal numbers): all
/// units at once, so that a formula runs over whole columns. One thread's; parameters are fixed.
class UnitTerms {
 public:
  virtual ~UnitTerms() = default;
  virtual std::size_t units() const = 0;
  virtual int effects() const = 0;  ///< of each unit, 1 or 2

  /// log p(data of unit u | z_u) for each unit with `wanted[u]`, -infinity where there is no density,
  /// never NaN; with `slope` its derivatives by z_u. `z` and `slope` have `effects()` entries a unit.
  virtual void evaluate(std::span<const double> z, std::span<const std::uint8_t> wanted,
                        std::span<double> value, std::span<double> slope) = 0;
};

/// Units at one point of each one's lattice.
struct Sweep {
  std::vector<double> z;       ///< units x effects
  std::vector<double> log_f;   ///< log p(data | z) + log N(z; 0, 1); -infinity where not looked at
  std::vector<double> weight;  ///< of the posterior of z_u, sums to 1 over the sweeps
};

/// What is left when each unit's effects are integrated out,
///
///   log L_u = log of the integral of p(data_u | z) N(z; 0, 1) dz,
///
/// and the posterior of each unit's effects on the nodes that it took. The trapezoidal rule about the
/// mode, in units of the width there: of an analytic integrand that falls off at both ends it converges
/// faster than any power of its step, and it does not mind an integrand that is no bell. It goes out
/// until the integrand is e^-36 of its highest. The rule with every second node is an estimate beside
/// it; where they differ the step is halved. `settled` is false where that did not end, and `unsettled` then
/// what the two still differ by, relative, summed over the units of which that is so.
struct UnitIntegrals {
  std::vector<double> log_likelihood;  ///< of each unit
  std::vector<Sweep> sweeps;
  bool settled = true;
  double unsettled = 0;

  double sum() const;

  /// For rules that lay the nodes of one unit after the other: nothing yet; then nodes, of which those at one `place` are
  /// one sweep (`log_f` is not filled); then no sweep without nodes.
  void restart(std::size_t units, std::size_t effects);
  void put(std::size_t unit, std::size_t place, const double* z, double weight_of_node);
  void finish() { sweeps.resize(used_); }

 private:
  std::size_t units_ = 0, effects_ = 0, used_ = 0;
};

/// Fills `result`, whose memory is used again.
void integrate(UnitTerms& terms, UnitIntegrals& result);

}  // namespace wearwell::latent
