#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "wearwell/bayes/parameter.h"
#include "wearwell/input/prior.h"
#include "wearwell/input/toml_reader.h"

namespace wearwell::workbench {

/// A point of a prior's curve that a user can drag: "location" (the median), "spread" (the 95 %
/// quantile), or "lower" and "upper", the bounds of a uniform prior.
struct PriorHandle {
  std::string_view name;
  double at;  ///< in the unit of the parameter
};

/// The handles of a prior that the study writes; none of an improper or a default prior, and none in a
/// unit with an offset.
std::vector<PriorHandle> prior_handles(const TomlReader& study, const Parameter& parameter);

/// A study with another value of one handle.
struct MovedPrior {
  std::string text;
  std::vector<std::string> paths;  ///< of the keys that have other values: "prior.k.median"
  Parameter parameter;             ///< as the new text has it
};

/// `at` is in the unit of the parameter. "location" keeps the other parameters of the family, "spread"
/// keeps the median; of a beta prior "location" keeps alpha + beta. Values are rounded to three digits
/// of the spread, so that the handle stands near `at`. Reads no table. Throws InputError if the study
/// has no such prior or handle, or if no prior of the family has the handle there.
MovedPrior moved_prior(const std::string& text, const ParameterSpec& spec, std::string_view handle,
                       double at);

}  // namespace wearwell::workbench
