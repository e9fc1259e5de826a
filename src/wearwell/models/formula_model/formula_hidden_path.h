#pragma once

#include <vector>

#include "wearwell/models/formula_model/formula_process.h"

/// Gamma and inverse Gaussian processes whose readings have an error of their own: y_i = X_i + N(0, noise_i^2), where X rises
/// by independent random steps from 0. The path is hidden, and not normal: it is integrated out row by row,
///
///   p(y_i | y_1 .. y_i-1) = integral of N(y_i; x, noise_i) p_i(x) dx,
///   p_i+1(x) = integral of f(x - x') N(y_i; x', noise_i) p_i(x') dx' / p(y_i | ...)
///
/// on a lattice common to the rows of a unit, a third as wide as what readings can tell of the path. Only functions that are as
/// smooth as the errors of readings are ever summed: a step of law f enters as expectations of the lattice's interpolating
/// polynomials (hidden_step.h), and p_i as what such functions have for a mean. Rows look as far about their reading, and about
/// what all readings say of the path, as either could let it lie: beyond lies less than e^-24. A unit's log density is within
/// some 1e-6 of that of a lattice twice as fine (tests/models/formula_model/formula_hidden_path_test.cpp); `hidden_unsettled` tells.
namespace wearwell::formula_model {

/// Whether a path that is not normal is seen through errors of readings.
bool is_hidden(const ProcessForm& form, const ProcessRows& rows);

/// As `process_terms`, of such a process. `per_width`: lattice widths to what readings can tell; 3 elsewhere.
void hidden_terms(const ProcessForm& form, const ProcessRows& rows, std::span<double> value,
                  std::span<double> slope, double per_width = 3);
/// The path after the last row given all readings, in cells of three widths.
Standing hidden_standing(const ProcessForm& form, const ProcessRows& rows);
void hidden_scores(const ProcessForm& form, const ProcessRows& rows,
                   std::vector<NormalScore>& scores);
/// What a lattice half as fine again makes of the unit's log density more or less.
double hidden_unsettled(const ProcessForm& form, const ProcessRows& rows);

}  // namespace wearwell::formula_model
