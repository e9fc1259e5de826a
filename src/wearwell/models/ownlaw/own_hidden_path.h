#pragma once

#include <vector>

#include "wearwell/models/ownlaw/own_process.h"

/// Gamma and inverse Gaussian processes whose readings have an error of their own: y_i = X_i + N(0, noise_i^2), where X rises
/// by independent random steps from 0. The path is hidden, and not normal: it is integrated out row by row,
///
///   p(y_i | y_1 .. y_i-1) = integral of N(y_i; x, noise_i) p_i(x) dx,
///   p_i+1(x) = integral of f(x - x') N(y_i; x', noise_i) p_i(x') dx' / p(y_i | ...)
///
/// on a lattice common to the rows of a unit, a fourth as wide as what readings can tell of the path. Only functions that are as
/// smooth as the errors of readings are ever summed: a step of law f (which may have a pole at 0) enters as the
/// expectations of the lattice's interpolating polynomials (six nodes), from the trapezoidal rule over the logarithm of
/// the step, which is exact for it but for its far ends; what is left of its mass there is one of no step at all. Rows look as far
/// about their reading, and about what all readings say of the path, as either could let it lie: beyond lies less than e^-18.
namespace wearwell::ownlaw {

/// As `process_terms`, of such a process.
void hidden_terms(const ProcessForm& form, const ProcessRows& rows, std::span<double> value,
                  std::span<double> slope);
/// The path after the last row: `at` and `variance` are its mean and variance given all readings.
Standing hidden_standing(const ProcessForm& form, const ProcessRows& rows);
void hidden_scores(const ProcessForm& form, const ProcessRows& rows,
                   std::vector<NormalScore>& scores);

}  // namespace wearwell::ownlaw
