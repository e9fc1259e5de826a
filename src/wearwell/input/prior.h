#pragma once

#include <string>

#include "wearwell/bayes/parameter.h"
#include "wearwell/input/toml_reader.h"

namespace wearwell {

/// What a model says of one of its parameters, before any belief.
struct ParameterSpec {
  std::string name;
  std::string si;  ///< SI unit
  double natural_lower = -std::numeric_limits<double>::infinity();
  double natural_upper = std::numeric_limits<double>::infinity();
  double guess = 1;  ///< a plausible value from the data, SI
};

/// Reads [prior] NAME = { law = ..., ... } and makes the parameter. The parameter's unit is the one
/// its prior is written in.
///
///   flat           lower, upper (both optional)
///   uniform        lower, upper
///   normal         mean, sd
///   lognormal      mean, sd of the quantity itself; or median, log_sd
///   half-normal    scale
///   half-cauchy    scale
///   exponential    mean
///   gamma          shape, scale
///   inverse-gamma  shape, scale
///   student-t      df, location, scale
///   beta           alpha, beta
///   jeffreys       (1/x)
///
/// each truncated by lower and upper; `unit` where no quantity names one.
Parameter read_prior(const TomlReader& priors, const ParameterSpec& spec);

}  // namespace wearwell
