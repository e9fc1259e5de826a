#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "wearwell/latent/unit_integral.h"
#include "wearwell/models/formula_model/effect_pair.h"
#include "wearwell/models/formula_model/formula_model.h"

namespace wearwell::formula_model {

class UnitRows;
struct BoundColumn;

/// The same likelihood as that of `UnitRows`, from one pass over the rows for each effect and one
/// more: the log-likelihood of a unit is quadratic in its effects, for any number of rows.
class LinearUnits final : public latent::UnitTerms {
 public:
  explicit LinearUnits(UnitRows& rows);

  /// To the parameters of the rows' last move.
  void move();

  std::size_t units() const override;
  int effects() const override { return static_cast<int>(effects_); }
  void evaluate(std::span<const double> z, std::span<const std::uint8_t> wanted,
                std::span<double> value, std::span<double> slope) override;

  /// The sum of the units' log-likelihoods: in closed form if all effects are normal, else by
  /// quadrature of the quadratic without the rows (lognormal_unit.h, effect_pair.h). Empty if that
  /// does not converge. With `gradient` that is added as well.
  std::optional<double> sum(std::span<double> gradient = {});
  /// The value of each unit instead; false if `sum` is empty.
  bool each(std::vector<double>& log_likelihood);
  /// With the nodes; false if the rules do not converge, and for one normal effect.
  bool integrate(latent::UnitIntegrals& result);

  /// Adds the gradient of the sum of log likelihoods; `integrals` are those of the last `move`.
  void add_gradient(const latent::UnitIntegrals& integrals, std::span<double> gradient);

 private:
  // Effects count from the median, in steps; relative to the best, to avoid cancellation if the
  // standard deviation is very small.
  struct Parabola {
    double top = 0, best[2] = {}, bend[3] = {};  // 00, 01, 11
    Eigen::Vector2d at() const;
    Eigen::Matrix2d H() const;
  };
  struct Moments {
    double first[2] = {}, second[3] = {};
  };
  bool in_closed_form() const;
  Eigen::Matrix2d steps_of_z() const;
  double sum_of_normal(std::span<double> gradient);
  std::optional<double> sum_of_lognormal(std::span<double> gradient);
  std::optional<double> sum_of_pairs(std::span<double> gradient);
  EffectPair pair(const Parabola& p) const;
  std::optional<double> log_integral(const Parabola& p);
  void fill(std::size_t c);
  void steps(const double* z, double* step, double* effect) const;
  void add_gradient_of_moments(const Population& by, std::span<double> gradient);

  UnitRows& rows_;
  const FormulaModel& model_;
  std::size_t effects_;
  double base_[2] = {}, width_[2] = {};
  std::vector<Parabola> parabola_;
  std::vector<Moments> moments_;
  EffectPair::Nodes pair_nodes_;
  std::vector<std::vector<double>> mean_[3], sd_;  // by column, then row
  std::vector<double> by_mean_[3], by_sd_;
};

}  // namespace wearwell::formula_model
