#pragma once

#include <array>
#include <limits>

#include "wearwell/prob/family_form.h"

namespace wearwell {

/// A family of distributions with its parameters in the order of its slots (family_form.h), in SI.
struct Family {
  ResponseFamily id;
  std::array<double, most_response_parameters> parameter = {};
};

// Families by name, for priors that are written in code.
struct Flat {
  operator Family() const { return {ResponseFamily::flat}; }
};
struct Uniform {
  operator Family() const { return {ResponseFamily::uniform}; }
};
struct Jeffreys {
  operator Family() const { return {ResponseFamily::jeffreys}; }
};
struct Normal {
  double mean, sd;
  operator Family() const { return {ResponseFamily::normal, {mean, sd}}; }
};
struct HalfNormal {
  double scale;
  operator Family() const { return {ResponseFamily::half_normal, {scale}}; }
};
struct Lognormal {
  double median, log_sd;
  operator Family() const { return {ResponseFamily::lognormal, {median, log_sd}}; }
};
struct Gamma {
  double shape, scale;
  operator Family() const { return {ResponseFamily::gamma, {shape, scale}}; }
};
struct InverseGamma {
  double shape, scale;
  operator Family() const { return {ResponseFamily::inverse_gamma, {shape, scale}}; }
};
struct StudentT {
  double df, location, scale;
  operator Family() const { return {ResponseFamily::student_t, {df, location, scale}}; }
};
struct Beta {
  double alpha, beta;
  operator Family() const { return {ResponseFamily::beta, {alpha, beta}}; }
};

/// A distribution of one quantity in SI, as a prior: a family, truncated to [lower, upper].
struct Distribution {
  Family family = Flat{};
  double lower = -std::numeric_limits<double>::infinity();  ///< bounds of the support, after
                                                            ///< truncation
  double upper = std::numeric_limits<double>::infinity();
  bool proper = true;         ///< has a finite integral over the support
  double log_normalizer = 0;  ///< log of the kernel's integral over the support; 0 when improper
  std::array<double, most_response_parameters> prepared = {};  ///< arguments of the kernel
};

/// Truncates `family` to [lower, upper] and normalizes. Throws InputError if lower >= upper, if a
/// parameter of the family is out of range, or if the family has no probability between the bounds.
Distribution make_distribution(const Family& family, double lower, double upper);

/// Whether its density is constant between its bounds.
inline bool is_flat(const Distribution& distribution) {
  return distribution.family.id == ResponseFamily::flat ||
         distribution.family.id == ResponseFamily::uniform;
}

struct LogDensityAndSlope {
  double value;
  double slope;  ///< derivative by x
};

/// Natural log density at x, SI, inside the support (up to a constant where it is improper), with its derivative.
LogDensityAndSlope log_density(const Distribution& distribution, double x);

/// The x with P(X <= x) = p, 0 < p < 1. Throws std::logic_error for an improper distribution.
double quantile(const Distribution& distribution, double p);

}  // namespace wearwell
