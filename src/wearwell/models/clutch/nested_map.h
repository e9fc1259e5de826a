#pragma once

#include <cstdint>
#include <vector>

#include "wearwell/models/clutch/wear_map.h"
#include "wearwell/regress/nested.h"

namespace wearwell::clutch {

/// A subset of the points.
WearPoints chosen(const WearPoints& points, const std::vector<Eigen::Index>& rows);

/// The prediction error of the searched map for points outside its search (regress/nested.h): the
/// points are divided into `folds` parts, and without each part exponents and terms are searched
/// again. `start`: as for best_exponents. Does not depend on the number of threads.
Nested nested_map(const WearPoints& points, Surrogate surrogate,
                  const std::vector<double>& exponents, const std::vector<int>& start, int folds,
                  std::uint64_t seed, int threads = 0, Progress* progress = nullptr);

}  // namespace wearwell::clutch
