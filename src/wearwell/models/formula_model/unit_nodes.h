#pragma once

#include <memory>
#include <vector>

#include "wearwell/models/formula_model/node_rows.h"
#include "wearwell/predict/thinned_posterior.h"

namespace wearwell::formula_model {

/// Points of the population's posterior with their weights, as logarithms.
struct PopulationPoints {
  std::shared_ptr<const Points> values;
  std::vector<double> log_weight;

  PopulationPoints() = default;
  explicit PopulationPoints(const ThinnedPosterior& few);
};

/// What units are laid from: few points for nearly all of them, and many for those that say themselves what the
/// population left open.
struct NodePopulation {
  std::shared_ptr<const FormulaModel> model;
  PopulationPoints few, many;

  NodePopulation(std::shared_ptr<const FormulaModel> formula_model, const WeightedDraws& posterior);
  std::size_t effects() const { return model->effects.size(); }
};

/// The nodes of one unit. Each point of the population's posterior has a line of them over the unit's own effects,
///
///   one effect   even steps in z over all that the unit's readings leave, each line begun a little farther on,
///                so that together they lie dense: the trapezoidal rule of each
///   two          points of a lattice that follow a normal law of the mean and the covariance of z, weighted by
///                what the law itself is over it
///   none         the point itself
///
/// and their weights before readings, so that likelihoods of readings need only multiply them.
struct UnitNodes {
  Nodes nodes;
  bool own = false;  ///< the points are this unit's, not the population's few
  /// Of each line: the weight of its point before readings, and what the study's rows of the unit have in it
  /// already, which count with the readings.
  std::vector<double> log_point, log_seen;
  std::vector<double> shape;  ///< of each line: 0, 2 (first z, step) or 5 (mean, factor) numbers
  std::vector<double> log_before;  ///< of each node: its weight before readings; from these

  /// Computes effects and weights of nodes from points and shapes: the same bits whenever that is done.
  void fill(const FormulaModel& model) { fill(model, usual_per_line); }
  /// The same lattice of two effects with so many nodes a line.
  void fill(const FormulaModel& model, std::size_t per_line);
  static constexpr std::size_t usual_per_line = 10;
  static std::size_t shape_size(std::size_t effects) { return effects == 2 ? 5 : 2 * effects; }
};

/// Lays the nodes of a unit that the study has seen with rows `seen` (maybe none) and that has shown `all` since the
/// beginning, those among them. Both along the axis. `before`: its nodes until now, whose points are kept where they
/// are its own and will do.
UnitNodes lay_nodes(const NodePopulation& population, const std::vector<UnitReading>& seen,
                    const std::vector<UnitReading>& all, const UnitNodes& before);

/// 1 / sum of squares of weights, which are given as logarithms and not normalized; 0 where all are none.
double effective_number(std::span<const double> log_weight);
/// The same weights, to sum to 1.
void normalize(std::span<const double> log_weight, std::vector<double>& weight);

}  // namespace wearwell::formula_model
