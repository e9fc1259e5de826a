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

/// When a path reaches its threshold.
struct LimitedPath {
  std::shared_ptr<const Path> next;  ///< of a new unit; null if not requested
  /// Of each unit: under future conditions, and under its own conditions until now if these differ
  /// (else null).
  struct SeenUnit {
    std::shared_ptr<const Path> ahead, behind;
    double now = 0;        ///< position of its last row on the axis, SI
    std::size_t unit = 0;  ///< among FormulaModel::units
  };
  std::vector<SeenUnit> seen;  ///< of the requested ones
  double limit = 0;            ///< SI
  bool rising = true;
  double begin = 0;  ///< start of the axis, SI
  double scale = 1;  ///< of the axis, SI
  /// The shares whose lives are requested, among units that have survived to `survived`.
  std::vector<double> shares = {};
  double survived = 0;  ///< on the axis, SI; `begin` by default
  bool mean = false;    ///< whether the mean life is requested, too
};

/// Lives over a posterior: each mixed over the posterior of the population and, given that and all
/// of its rows, that of the unit's effects.
struct LimitedLives {
  CellMixture next;
  std::vector<CellMixture>
      remaining;               ///< of each unit, from its last row on, given that it has not passed
  std::vector<double> passed;  ///< the probability that it has passed already

  /// For each of LimitedPath::shares: the life by which this share of units has reached the
  /// threshold, over the posterior given survival to `survived`, from there on.
  std::vector<CellMixture> by_share = {};
  /// Their relative error if they are interpolated (predict/interpolated.h).
  std::vector<std::optional<double>> share_misfit = {};
  /// The same lives, point after point.
  std::vector<double> at_points = {};

  /// The same of the mean life of units, where it is requested.
  CellMixture mean = {};
  std::optional<double> mean_misfit = {};
  std::vector<double> mean_at_points = {};

  bool over_all = false;  ///< summed over all cells of the posterior, not over few points

  /// From the lives of all units at one point of the posterior, of this weight.
  void add_shares(const LimitedPath& path, const NormalLines& units, double weight);
  /// The same for units without lines.
  void add_shares(const LimitedPath& path, const CellMixture& units);

  void add_mean(const LimitedPath& path, const CellMixture& units);

  /// After all of `few` points: if lives count from the beginning, `by_share` and `mean` over the
  /// whole posterior.
  void spread_shares(const LimitedPath& path, const WeightedDraws& draws,
                     const ThinnedPosterior& few);

  void add(const LimitedLives& other);  ///< of other points
};
/// `share_of_points`: below 1 a share of the points, without interpolation, to estimate the
/// dependence on the points.
LimitedLives limited_lives(const FormulaRows& rows, const LimitedPath& path,
                           const WeightedDraws& draws, double share_of_points = 1);

}  // namespace wearwell::formula_model
