#pragma once

#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "wearwell/models/formula_model/tracked_unit.h"

namespace wearwell::formula_model {

/// predict.rate_change: at most one change of a unit's rate on line. Its place is exponential along
/// the axis; behind it the use of the unit counts `factor` times, lognormal.
struct RateChangePrior {
  double hazard = 0;              ///< 1/SI: one change in `every`
  double median = 1, log_sd = 0;  ///< of the factor

  double factor(double z) const;
  /// The log density of a change at `place` and a factor at score z, given none before `start`, up to a constant.
  double log_density(double place, double start, double z) const;
};

/// Empty if the study has none. Throws InputError for a study without a limit, a formula that sums
/// over rows or has a state, or a value that is not possible.
std::optional<RateChangePrior> read_rate_change(const TomlReader& predict,
                                                const FormulaModel& model);

/// Throws InputError if the study has predict.rate_change: exported code has units of one rate.
void refuse_rate_change(const TomlReader& root);

/// Place and factor of the i-th change, evenly distributed in the unit square, and independent of the
/// scores of a node with two effects (its lattice has other multiples).
std::pair<double, double> change_fractions(std::size_t i);

/// What units of one population share: made once, never changed.
struct RateChanges {
  std::shared_ptr<const Tracked> tracked;
  RateChangePrior prior;
  NodeRows rows;  ///< each node has its own place on the axis

  /// Throws InputError where what is limited sums over rows, or has a state.
  RateChanges(std::shared_ptr<const Tracked> of, const RateChangePrior& change,
              const TomlReader& root);
};

/// Units whose rate has changed, as weighted particles; each has all that its path depends on.
struct ChangedUnits {
  Nodes nodes;                     ///< one node a line
  NodeAxis axis;                   ///< where and by which factor
  std::vector<double> z[2];        ///< scores of the effects
  std::vector<double> score;       ///< of the factor
  std::vector<double> log_weight;  ///< not normalized
  std::vector<NodePath> paths;     ///< after the last reading

  std::size_t count() const { return log_weight.size(); }
  /// These of them, with weights of 0.
  ChangedUnits taken(std::span<const std::size_t> which) const;
  void append(const ChangedUnits& other);
  /// Those of the same places in `by`, an equally long list, in place of these.
  void replace(std::span<const std::size_t> which, const ChangedUnits& by);
  /// Places on the axis of the formula.
  std::vector<double> places(double place) const;
};

/// These of the values; none if there are none.
std::vector<double> picked(const std::vector<double>& from, std::span<const std::size_t> which);
/// `count` indices in proportion to the weights, by systematic resampling from `offset` in (0, 1).
std::vector<std::size_t> resampled(std::span<const double> log_weight, std::size_t count,
                                   double offset);

}  // namespace wearwell::formula_model
