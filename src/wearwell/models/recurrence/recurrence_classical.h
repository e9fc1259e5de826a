#pragma once

#include "wearwell/models/recurrence/recurrence_report.h"

namespace wearwell::recurrence {

/// The estimates of predict.classical for units that are repaired: maximum likelihood with normal (Fisher) and
/// likelihood-ratio bounds, exact bounds (exact_bounds.h) and Crow's estimates without bias. Adds `classical` of
/// summary.json, tables and text.
void add_classical(const Asked& asked, const Fit& fit, PresetAddition& added);

}  // namespace wearwell::recurrence
