#pragma once

#include <optional>
#include <span>
#include <vector>

#include "wearwell/latent/unit_integral.h"
#include "wearwell/models/formula_model/extreme_value_unit.h"
#include "wearwell/models/formula_model/formula_model.h"

namespace wearwell::formula_model {

class UnitRows;
struct BoundColumn;

/// Whether the single column has Weibull, exponential, Frechet or extreme value lives, the log scale
/// (or the location) is linear in z of the one effect, and the shape does not depend on it. Rows are
/// exact, or censored so that their log-likelihood is -(life/scale)^shape: on the right, for Frechet and
/// largest extreme values on the left. Tested numerically, as in `is_linear`.
bool has_extreme_values(const FormulaModel& model, const std::vector<BoundColumn>& columns);

/// The same likelihood as that of `UnitRows`, from two passes over the rows: each unit's log-likelihood
/// has the form of `ExtremeValueUnit`.
class ExtremeValueUnits {
 public:
  explicit ExtremeValueUnits(UnitRows& rows);

  /// To the parameters of the rows' last move.
  void move();
  /// The sum of the units' log-likelihoods; empty if an integral does not converge, or the rows of a
  /// unit differ in their shape. With `gradient` that is added as well.
  std::optional<double> sum(std::span<double> gradient = {});
  /// The value of each unit instead; false if `sum` is empty.
  bool each(std::vector<double>& log_likelihood);
  /// With the nodes, more closely spaced; false likewise.
  bool integrate(latent::UnitIntegrals& result);

 private:
  struct Unit {
    double constant = 0;
    ExtremeValueUnit form{0, 0, 0};
    double highest = 0;  // log hazard of its rows at z = 0
    double shape = 0, slope = 0;
  };
  struct Row {
    double log_life, log_entry;  // the life and the entry themselves on the whole line
    bool failed, entered;
  };
  struct Means {
    double z = 0, hazard = 0, hazard_z = 0;  // over the posterior of a unit
  };
  void read_rows();
  void gather_rows();
  void add_means(std::size_t u, const Means& means, Population& by);
  double offset(double log_life, std::size_t i) const;

  UnitRows& rows_;
  const FormulaModel& model_;
  const BoundColumn& column_;
  bool positive_, by_shape_, one_shape_;  // the second parameter is a shape; there is none
  double side_;                           // -1 for Frechet and largest extreme values
  bool collapsed_ = false;
  double base_ = 1, probe_ = 1, width_ = 1;
  std::vector<Row> row_;
  std::vector<double> place_, probed_, second_;                 // outputs of the rows
  std::vector<double> log_scale_, slope_, log_hazard_, share_;  // at z = 0
  std::vector<double> by_place_, by_probed_, by_second_;
  std::vector<Unit> unit_;
  ExtremeValueUnit::Nodes nodes_;
};

}  // namespace wearwell::formula_model
