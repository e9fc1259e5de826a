#pragma once

#include <vector>

#include "wearwell/models/ownlaw/own_law.h"

namespace wearwell::ownlaw {

struct BoundColumn;

/// Whether an expression of the rows has cases (where, min, max, abs, <), or they depend on rows before.
bool has_cases(const OwnLaw& law);

/// Parameters at which the form of a law is tried.
std::vector<std::vector<double>> trial_points(const OwnLaw& law);

/// Whether every column is normal and exact, its mean a straight line in what differs from unit to
/// unit, and its standard deviation without it: depth = k work, y = a + b t, V = k max(F - F0, 0) s. By the form of the
/// expressions (law/by_row_degree.h); where that does not say, and none has cases, tried with numbers at several
/// parameters and effects.
bool is_linear(const OwnLaw& law, const std::vector<BoundColumn>& columns);

}  // namespace wearwell::ownlaw
