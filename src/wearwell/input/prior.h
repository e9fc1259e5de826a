#pragma once

#include <limits>
#include <optional>
#include <string>

#include "wearwell/bayes/parameter.h"
#include "wearwell/input/toml_reader.h"

namespace wearwell {

/// The default prior of a parameter: weak, from knowledge of the field or from the units and
/// magnitude of the data, never from a fit. docs/reference/priors.md lists all.
struct DefaultPrior {
  std::string distribution;  ///< name in study files: "lognormal"
  Family family;             ///< SI
  std::string unit;
  double lower = -std::numeric_limits<double>::infinity();
};

/// A model's specification of one of its parameters.
struct ParameterSpec {
  std::string name;
  std::string si;  ///< SI unit
  double natural_lower = -std::numeric_limits<double>::infinity();
  double natural_upper = std::numeric_limits<double>::infinity();
  double guess = 1;  ///< a plausible value from the data, SI
  std::optional<DefaultPrior> fallback = {};
  /// A condition that differs between units, with their distribution in place of a prior: a location may be in degC,
  /// and the unit of a scale is then that of a difference (5 degC is 5 K).
  bool varies_between_units = false;
};

/// The magnitude of positive data for a default prior: 1, 2 or 5 times a power of ten, at least
/// `x`.
double rounded_up(double x);

/// Reads [prior] NAME = { distribution = ..., ... } and makes the parameter. The parameter has the unit of
/// its prior.
///
///   flat       lower, upper (both optional)
///   uniform    lower, upper
///   any family of prior_forms() (prob/family_form.h) with its parameters, a location or a scale
///              as a quantity of the parameter's dimension, all else as plain numbers
///
/// each truncated by lower and upper; `unit` if no quantity names one. Without an entry, or with
/// distribution = "default", it is the model's default; an error if there is none.
Parameter read_prior(const TomlReader& priors, const ParameterSpec& spec);
/// The same if [prior] may be missing from `root`.
Parameter read_prior(const TomlReader& root, const std::optional<TomlReader>& priors,
                     const ParameterSpec& spec);

}  // namespace wearwell
