#pragma once

#include "wearwell/models/formula_model/formula_lives.h"

namespace wearwell::formula_model {

/// When the path of a process first reaches a threshold.
struct ProcessLimit {
  std::size_t column = 0;  ///< of FormulaModel::measured
  LimitedPath
      path;  ///< of its mean (output 0) with its scale or sd (output 1); `limit` is of the process
};

/// Lives over a posterior: first passages of paths that start at 0, and of observed ones, given
/// their state after their last row (not beyond the threshold). `share_of_points` as for
/// limited_lives.
LimitedLives process_lives(const FormulaRows& rows, const ProcessLimit& limit,
                           const WeightedDraws& draws, double share_of_points = 1);

}  // namespace wearwell::formula_model
