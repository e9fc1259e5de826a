#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/models/formula_model/formula_crossing.h"
#include "wearwell/models/formula_model/formula_likelihood.h"
#include "wearwell/predict/cell_mixture.h"
#include "wearwell/predict/normal_lines.h"
#include "wearwell/predict/thinned_posterior.h"

namespace wearwell::formula_model {

/// When a path reaches its limit.
struct LimitedPath {
  std::shared_ptr<const Path> next;  ///< of a unit not yet seen; null where it was not asked for
  /// Of each unit: under the conditions to come, and under its own until now where these differ (else
  /// null).
  struct SeenUnit {
    std::shared_ptr<const Path> ahead, behind;
    double now = 0;        ///< where its last row lies along the axis, SI
    std::size_t unit = 0;  ///< among FormulaModel::units
  };
  std::vector<SeenUnit> seen;  ///< of those that were asked for
  double limit = 0;            ///< SI
  bool rising = true;
  double begin = 0;  ///< where the axis begins, SI
  double scale = 1;  ///< of the axis, SI
  /// Of which shares of all units the lives are wanted, of those that have come to `survived`.
  std::vector<double> shares = {};
  double survived = 0;  ///< along the axis, SI; `begin` where nothing is said
};

/// Lives over a posterior: each mixed over the posterior of the population and, given that and all of
/// its rows, that of the unit's own effects.
struct LimitedLives {
  CellMixture next;
  std::vector<CellMixture>
      remaining;               ///< of each unit, from its last row on, given that it is not there
  std::vector<double> passed;  ///< the probability that it is there already

  /// Of each of LimitedPath::shares: the life by which such a share of units has reached the limit,
  /// over the posterior given that a unit has come to `survived`, from there on.
  std::vector<CellMixture> by_share = {};
  /// Their relative error where they are interpolated (predict/interpolated.h).
  std::vector<std::optional<double>> share_misfit = {};
  /// The same lives, point after point.
  std::vector<double> at_points = {};

  bool over_all = false;  ///< summed over all cells of the posterior, not over few points

  /// From the lives of all units at one point of the posterior, of this weight.
  void add_shares(const LimitedPath& path, const NormalLines& units, double weight);
  /// The same where units have no lines to lie on.
  void add_shares(const LimitedPath& path, const CellMixture& units);

  /// After all of `few` points: where lives count from the beginning, `by_share` over the whole posterior.
  void spread_shares(const LimitedPath& path, const WeightedDraws& draws,
                     const ThinnedPosterior& few);

  void add(const LimitedLives& other);  ///< of other points
};
/// `share_of_points`: below 1 over so many of the points that lives are summed over, and without interpolation, to see how
/// far they depend on these.
LimitedLives limited_lives(const FormulaRows& rows, const LimitedPath& path,
                           const WeightedDraws& draws, double share_of_points = 1);

}  // namespace wearwell::formula_model
