#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "wearwell/formula/program.h"
#include "wearwell/latent/unit_integral.h"
#include "wearwell/models/formula_model/formula_model.h"
#include "wearwell/models/formula_model/mismatch_table.h"

namespace wearwell::formula_model {

class UnitRows;
struct BoundColumn;

/// A model whose units can be tabulated: one column of exact readings, normal or lognormal around a
/// curve of one effect and at most one shared parameter (Paris: C of each plate, m), with one
/// standard deviation for all.
struct TabledForm {
  std::optional<std::size_t> shared;  ///< the parameter, among the study's
  bool logarithms = false;            ///< of the readings
  formula::Program size;     ///< the index of their standard deviation, in the study's parameters
  double per_parameter = 1;  ///< their standard deviation over that
};

std::optional<TabledForm> tabled_form(const FormulaModel& model,
                                      const std::vector<BoundColumn>& columns);

/// Empty if the table is not accurate enough (mismatch_table.h).
std::shared_ptr<const MismatchTable> make_table(UnitRows& rows, const TabledForm& form);

/// The same likelihood as that of `UnitRows`, from a table of the units' sums of squares; from the
/// rows outside the table.
class TabledUnits final : public latent::UnitTerms {
 public:
  TabledUnits(UnitRows& rows, const TabledForm& form, std::shared_ptr<const MismatchTable> table);

  /// To the parameters of the rows' last move.
  void move();

  std::size_t units() const override;
  int effects() const override { return 1; }
  void evaluate(std::span<const double> z, std::span<const std::uint8_t> wanted,
                std::span<double> value, std::span<double> slope) override;

  /// The sum of the units' log-likelihoods by a rule with wider steps than latent::integrate; empty
  /// if it does not converge, or leaves the table. With `gradient` that is added as well.
  std::optional<double> sum(std::span<double> gradient = {});
  /// The value of each unit instead; false if `sum` is empty.
  bool each(std::vector<double>& log_likelihood);

 private:
  struct Moments {
    double slope = 0, slope_z = 0, square = 0, by_shared = 0;
  };
  struct LaplaceApproximation {
    double center, width;
  };
  struct Nodes {
    static constexpr std::size_t most = 400;
    std::size_t count = 0;
    std::array<double, most> x, f;
    std::array<std::uint8_t, most> odd;
  };
  double x_of(double z) const { return middle_ + scatter_ * z; }
  std::optional<LaplaceApproximation> approximation(std::size_t unit);
  std::optional<double> integral(std::size_t unit, Moments* moments);
  void add_moments(std::size_t unit, Moments& moments);
  double constant(std::size_t unit) const;

  UnitRows& rows_;
  const FormulaModel& model_;
  TabledForm form_;
  MismatchSlice slice_;
  formula::Data size_data_;
  formula::Workspace size_workspace_;
  std::vector<double> readings_, constant_;  // by unit: number of readings, sum of their logarithms
  bool inside_ = false;
  double middle_ = 0, scatter_ = 0, size_ = 1, log_size_ = 0;  // of x; of a reading
  const double* x_ = nullptr;
  std::vector<std::uint8_t> beyond_;
  Nodes nodes_;
};

}  // namespace wearwell::formula_model
