#pragma once

#include <limits>
#include <optional>
#include <string>

#include "wearwell/bayes/parameter.h"
#include "wearwell/input/toml_reader.h"

namespace wearwell {

/// The prior of a parameter of which the study says nothing: weak, what the field knows or what units
/// and the size of the data say, never what a fit says. docs/reference/priors.md has them all.
struct DefaultPrior {
  std::string distribution;  ///< as in study files: "lognormal"
  Family family;             ///< SI
  std::string unit;
  double lower = -std::numeric_limits<double>::infinity();
};

/// What a model says of one of its parameters, before any belief.
struct ParameterSpec {
  std::string name;
  std::string si;  ///< SI unit
  double natural_lower = -std::numeric_limits<double>::infinity();
  double natural_upper = std::numeric_limits<double>::infinity();
  double guess = 1;  ///< a plausible value from the data, SI
  std::optional<DefaultPrior> fallback = {};
};

/// The size of positive data for a default: 1, 2 or 5 times a power of ten, not below `x`.
double rounded_up(double x);

/// Reads [prior] NAME = { distribution = ..., ... } and makes the parameter. The parameter's unit is the one
/// its prior is written in.
///
///   flat       lower, upper (both optional)
///   uniform    lower, upper
///   any family of prior_forms() (prob/family_form.h) with its parameters, a place or a size as a
///              quantity of the parameter's dimension, all else as plain numbers
///
/// each truncated by lower and upper; `unit` where no quantity names one. Where nothing stands there,
/// or distribution = "default", it is the model's default; without one that is refused.
Parameter read_prior(const TomlReader& priors, const ParameterSpec& spec);
/// The same where [prior] may be missing from `root`.
Parameter read_prior(const TomlReader& root, const std::optional<TomlReader>& priors,
                     const ParameterSpec& spec);

}  // namespace wearwell
