#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "wearwell/latent/unit_integral.h"
#include "wearwell/models/formula_model/formula_model.h"
#include "wearwell/models/formula_model/lognormal_unit.h"
#include "wearwell/models/formula_model/noisy_steps.h"

namespace wearwell::formula_model {

class UnitRows;
struct BoundColumn;

/// Whether the single column is a process, its mean proportional to the unit's one effect, and its
/// scale or standard deviation independent of it; errors of readings only for a Wiener process.
/// Tested numerically, as in `is_linear`.
bool is_proportional(const FormulaModel& model, const std::vector<BoundColumn>& columns);

/// The same likelihood as that of `UnitRows`, from one pass over the rows: with q the unit's effect
/// over the median,
///
///   log L(q) = constant + powers of q + a logarithm of q - log Gamma(q alpha) of equal steps,
///
/// for any number of rows. If readings have errors and the variance of steps is proportional to q
/// as well (a Wiener process with `scale`), Kalman's recursion over the rows at several q together
/// (noisy_steps.h).
class StepUnits final : public latent::UnitTerms {
 public:
  explicit StepUnits(UnitRows& rows);

  /// To the parameters of the rows' last move.
  void move();

  std::size_t units() const override;
  int effects() const override { return 1; }
  void evaluate(std::span<const double> z, std::span<const std::uint8_t> wanted,
                std::span<double> value, std::span<double> slope) override;
  /// The sum of the units' log-likelihoods by a rule with wider steps than latent::integrate; empty
  /// if it does not converge. With `gradient` that is added as well.
  std::optional<double> sum(std::span<double> gradient = {});
  /// The value of each unit instead; false if `sum` is empty.
  bool each(std::vector<double>& log_likelihood);
  /// With the nodes, more closely spaced; false if `sum` is empty, and without errors of readings.
  bool integrate(latent::UnitIntegrals& result);
  /// Adds the gradient of the sum of log likelihoods; `integrals` are those of the last `move`.
  void add_gradient(const latent::UnitIntegrals& integrals, std::span<double> gradient);

 private:
  // Steps of a gamma process with nearly equal mean over scale.
  struct Alike {
    double count, shape;
    double slope = 0;  // the mean of q digamma(q shape) over the unit's posterior
  };
  struct Unit {
    double constant = 0, by_log = 0, by_inverse = 0, by_one = 0, by_square = 0;
    std::vector<Alike> alike;
    NoisySteps noisy;
  };
  struct Moments {
    double one = 0, square = 0, inverse = 0;  // of q
  };
  struct LaplaceApproximation {
    double center, width;
  };
  struct Nodes {
    static constexpr std::size_t most = 400, together = 8;
    std::size_t count = 0;
    std::array<double, most> z, f;  // f: weights of the integral
    std::array<bool, most> odd;
  };
  void add_step(std::size_t row, double w, double dy, double spread, double before, Unit& unit);
  void add_noisy_steps(std::size_t u);
  void take_noisy(std::size_t u, std::span<const double> z, std::span<const double> weight,
                  Population& by);
  void give_noisy(std::size_t u, const Moments& moments);
  void give_slopes(std::size_t u);
  void begin_gradient();
  void take_nodes(std::size_t u, std::span<const double> z, std::span<const double> weight,
                  Population& by);
  void end_gradient(const Population& by, std::span<double> gradient);
  double slope_of(const Unit& unit, double q) const;
  double slope_by_z(const Unit& unit, double z) const;
  std::optional<LaplaceApproximation> approximation(const Unit& unit) const;
  void log_densities(const Unit& unit, const double* z, double* log_f) const;
  bool rebuild(const Unit& unit, const LaplaceApproximation& about, double width);
  std::optional<double> integral(const Unit& unit, std::span<const double> gaps);
  std::optional<double> quick_integral(const Unit& unit, bool with_nodes);
  std::optional<LognormalUnit> quadratic(const Unit& unit) const;
  void take(Unit& unit, double z, double weight, Moments& moments, Population& by) const;
  void give(std::size_t u, const Moments& moments);

  UnitRows& rows_;
  const FormulaModel& model_;
  const BoundColumn& column_;
  bool noisy_, scaled_;  // readings have errors; and the variance of steps is proportional to q
  double base_ = 1;
  std::vector<double> mean_, spread_, noise_, by_mean_, by_spread_, by_noise_;
  NoisySteps::Slopes slopes_;
  std::vector<std::size_t> alike_of_;  // of each row
  std::vector<Unit> unit_;
  Nodes nodes_;
  std::vector<LognormalUnit::Node> kept_;
};

}  // namespace wearwell::formula_model
