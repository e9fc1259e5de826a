#pragma once

#include <span>

#include "wearwell/infer/check.h"
#include "wearwell/infer/fit.h"
#include "wearwell/models/formula_model/formula_model.h"

namespace wearwell::formula_model {

/// The order of the median lives of exchangeable subpopulations, as a factor of their prior. Without it the posterior would be
/// the same after any exchange of names (label switching: Stephens 2000, J. R. Stat. Soc. B 62, 795-809).
///
/// The factor is the softmax over orders of `sharpness` times the sum of rank times log median: near 1 where the medians are
/// in the order of the names, near 0 where they are not, and smooth between, so that gradients lead the sampler. Over all
/// exchanges of names it adds up to 1: whatever does not depend on names (the life of a part, predictions) has the same
/// posterior as without it. Where two medians differ by a few percent only, either can have either name. Medians are those
/// under the conditions of the first row.
class SubpopulationOrder {
 public:
  static constexpr double sharpness =
      20;  ///< medians of ratio r are in the wrong order with odds r^-20

  explicit SubpopulationOrder(const FormulaModel& model);  ///< which must outlive this

  /// The log factor; adds its derivatives to `gradient`, if it is not empty. One thread at a time.
  double value(std::span<const double> x, std::span<double> gradient = {});

  /// Whether the medians at these parameters are in the order of the names.
  bool holds(std::span<const double> x);

 private:
  void find_medians(std::span<const double> x);
  void add_gradient(std::span<const double> x, std::span<const double> by_log_median,
                    std::span<double> gradient);

  const Measured& measured_;
  formula::Data data_;
  formula::Workspace workspace_;
  std::vector<double> family_parameters_, log_median_;
};

/// Whether the posterior distinguishes subpopulations: how often their medians are in the order of their names. One that
/// mixes both orders has no parameters of "early" and "late".
Check distinguished(const FormulaModel& model, const Fit& fit);

/// By how much the prior of subpopulations is denser than the product of the parameters' priors: ln K! where they are ordered,
/// and less ln P of two or more shares that are parameters, with P the probability by their priors that they leave a rest.
double log_orders(const FormulaModel& model);

}  // namespace wearwell::formula_model
