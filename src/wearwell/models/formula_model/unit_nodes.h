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

/// Sources of a unit's nodes: few points for nearly all units, and many for those whose readings
/// determine what the population left uncertain.
struct NodePopulation {
  std::shared_ptr<const FormulaModel> model;
  PopulationPoints few, many;

  NodePopulation(std::shared_ptr<const FormulaModel> formula_model, const WeightedDraws& posterior);
  std::size_t effects() const { return model->effects.size(); }
};

/// The nodes of one unit. Each point of the population's posterior has a line of them over the
/// unit's effects,
///
///   one effect   even steps in z over the posterior range of the unit, each line shifted a little,
///                so that together they are dense: the trapezoidal rule of each
///   two          points of a lattice transformed to a normal distribution with the mean and the
///   covariance of z, weighted by
///                the ratio of the true density to it
///   none         the point itself
///
/// and their weights before readings, so that likelihoods of readings only multiply them.
struct UnitNodes {
  Nodes nodes;
  bool own = false;  ///< the points are this unit's own, not the population's
  /// Of each line: the weight of its point before readings, and the log-likelihood of the study's
  /// rows of the unit that it already contains.
  std::vector<double> log_point, log_seen;
  std::vector<double> shape;  ///< of each line: 0, 2 (first z, step) or 5 (mean, factor) numbers
  std::vector<double> log_before;  ///< of each node: its weight before readings; from these

  /// Computes effects and weights of nodes from points and shapes: with the same bits at any time.
  void fill(const FormulaModel& model) { fill(model, usual_per_line); }
  /// The same lattice of two effects with this number of nodes per line.
  void fill(const FormulaModel& model, std::size_t per_line);
  /// The standard normal scores z of the effects at a node.
  void scores(std::size_t effects, std::size_t node, double* z) const;
  static constexpr std::size_t usual_per_line = 10;
  static std::size_t shape_size(std::size_t effects) { return effects == 2 ? 5 : 2 * effects; }
};

/// Builds the nodes of a unit with rows `seen` in the study (may be empty) and rows `all` since the
/// beginning, including those. Both along the axis. `before`: its present nodes, whose points are
/// kept if they are its own and accurate enough.
UnitNodes place_nodes(const NodePopulation& population, const std::vector<UnitReading>& seen,
                      const std::vector<UnitReading>& all, const UnitNodes& before);

/// Of each point: the log-likelihood of rows of one unit, its effects integrated out.
std::vector<double> log_likelihoods(const FormulaModel& model, const PopulationPoints& points,
                                    const std::vector<UnitReading>& rows);

/// 1 / sum of squares of weights, which are given as logarithms and not normalized; 0 if all are
/// zero.
double effective_number(std::span<const double> log_weight);
/// The same weights, normalized.
void normalize(std::span<const double> log_weight, std::vector<double>& weight);

}  // namespace wearwell::formula_model
