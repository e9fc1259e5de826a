#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/models/formula_model/formula_lives.h"
#include "wearwell/predict/cell_mixture.h"

namespace wearwell::formula_model {

/// Positions where output 0 of a path is requested: of a new unit, or of one of the study.
struct SpreadPath {
  LimitedPath::SeenUnit path;  ///< `behind` and `now` only for a unit of the study
  std::optional<std::size_t> unit;
  std::vector<double> places;  ///< on the axis, SI; for a unit of the study not before its last row
  std::shared_ptr<const Path> trace = {};  ///< the rows of such a unit until now, if requested
  bool rising = true;                      ///< the next three as in LimitedPath
  double begin = 0, scale = 1;
};

/// The distribution of a path: over the posterior of the population and, given that, of the unit.
struct Spread {
  std::vector<CellMixture> traced;  ///< at each row of the unit
  std::vector<CellMixture> ahead;   ///< at each position
};
struct Spreads {
  std::vector<Spread> paths;
  void add(const Spreads& other);  ///< of other points of the posterior
};

/// The spreads of all paths at once, over at most this many points of the posterior.
std::vector<Spread> spreads(const FormulaRows& rows, const std::vector<SpreadPath>& paths,
                            const WeightedDraws& draws, std::size_t most_points);

}  // namespace wearwell::formula_model
