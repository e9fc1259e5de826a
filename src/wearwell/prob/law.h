#pragma once

#include <limits>
#include <string>
#include <variant>

#include "wearwell/prob/beta.h"
#include "wearwell/prob/flat.h"
#include "wearwell/prob/gamma.h"
#include "wearwell/prob/inverse_gamma.h"
#include "wearwell/prob/jeffreys.h"
#include "wearwell/prob/lognormal.h"
#include "wearwell/prob/normal.h"
#include "wearwell/prob/student_t.h"

namespace wearwell {

using Family =
    std::variant<Flat, Uniform, Normal, Lognormal, Gamma, InverseGamma, StudentT, Beta, Jeffreys>;

/// A law of one quantity in SI: a family, truncated to [lower, upper]. Half-normal and half-Cauchy
/// are the normal and Student laws truncated at 0; the exponential is the gamma of shape 1.
struct Law {
  Family family;
  double lower = -std::numeric_limits<double>::infinity();  ///< of the support, after truncation
  double upper = std::numeric_limits<double>::infinity();
  bool proper = true;         ///< has a finite integral over the support
  double log_normalizer = 0;  ///< log of the kernel's integral over the support; 0 when improper
};

/// Truncates `family` to [lower, upper] and normalizes. Throws InputError when lower >= upper, when
/// a parameter of the family is out of range, or when the family has no probability between the
/// bounds.
Law make_law(const Family& family, double lower, double upper);

struct LogDensityAndSlope {
  double value;
  double slope;  ///< derivative by x
};

/// log density at x inside the support (up to a constant for an improper law), with its derivative.
LogDensityAndSlope log_density(const Law& law, double x);

/// The x with P(X <= x) = p, 0 < p < 1. Throws std::logic_error for an improper law.
double quantile(const Law& law, double p);

}  // namespace wearwell
