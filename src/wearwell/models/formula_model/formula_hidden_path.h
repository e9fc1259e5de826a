#pragma once

#include <vector>

#include "wearwell/models/formula_model/formula_process.h"

/// Gamma and inverse Gaussian processes whose readings have independent errors: y_i = X_i + N(0,
/// noise_i^2), where X rises by independent random steps from 0. The path is hidden and not normal;
/// it is integrated out row by row,
///
///   p(y_i | y_1 .. y_i-1) = integral of N(y_i; x, noise_i) p_i(x) dx,
///   p_i+1(x) = integral of f(x - x') N(y_i; x', noise_i) p_i(x') dx' / p(y_i | ...)
///
/// on a lattice common to the rows of a unit, a third as wide as the resolution of the readings.
/// Only functions as smooth as the measurement errors are summed: a step with density f enters as
/// expectations of the lattice's interpolating polynomials (hidden_step.h), and p_i as the means of
/// such functions. The range of a row covers its reading, and the path given all readings; the rest
/// is below e^-24. A unit's log density is within about 1e-6 of that of a lattice twice as fine
/// (tests/models/formula_model/formula_hidden_path_test.cpp); `hidden_unsettled` reports the difference.
namespace wearwell::formula_model {

/// Whether a path that is not normal is observed with errors.
bool is_hidden(const ProcessForm& form, const ProcessRows& rows);

/// As `process_terms`, for such a process. `per_width`: lattice widths per resolution of the
/// readings; the default is 3.
void hidden_terms(const ProcessForm& form, const ProcessRows& rows, std::span<double> value,
                  std::span<double> slope, double per_width = 3);
/// The path after the last row given all readings, in cells of three widths.
Standing hidden_standing(const ProcessForm& form, const ProcessRows& rows);
void hidden_scores(const ProcessForm& form, const ProcessRows& rows,
                   std::vector<NormalScore>& scores);
/// Change of the unit's log density on a lattice that is finer by half.
double hidden_unsettled(const ProcessForm& form, const ProcessRows& rows);

}  // namespace wearwell::formula_model
