#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace wearwell {

enum class StandardDistribution;

/// A family of distributions, by its index in the list (families.h). Only families named in other
/// code are listed here; the list has more, and each positive family also with a threshold.
enum class ResponseFamily {
  normal,
  lognormal,             ///< by median and the standard deviation of its natural logarithm
  lognormal_by_moments,  ///< by its own mean and standard deviation
  log10_normal,
  student_t,
  weibull,
  smallest_extreme_value,
  largest_extreme_value,
  exponential,
  gamma,
  loglogistic,
  inverse_gaussian,
  poisson,
  binomial,
  flat,  ///< this and the following are only for priors
  uniform,
  half_normal,
  half_cauchy,
  inverse_gamma,
  beta,
  jeffreys,
};

/// The kind of a family's parameter.
enum class ParameterKind {
  location,     ///< a value of the observed quantity
  scale,        ///< a positive scale of the same dimension
  number,       ///< a pure number, positive
  real,         ///< a pure number of either sign
  probability,  ///< a pure number, 0 to 1
};

struct ParameterForm {
  std::string_view name;
  ParameterKind kind;
  bool optional = false;
  /// Its text in a description, "{}" for the number: "{} degrees of freedom". Empty: name and
  /// number.
  std::string_view phrase = {};
};

/// Probability paper: the axes for the fraction failed against life.
struct Paper {
  std::string_view name;
  StandardDistribution distribution;  ///< the vertical axis is its quantile
  bool straight = true;               ///< distributions of the family are straight lines on it
};

/// A family as named in studies, with its slots in order.
struct ResponseForm {
  std::string_view name;
  ResponseFamily family;
  std::vector<ParameterForm> family_parameters;
  bool positive = false;  ///< observations are positive
  bool counted = false;   ///< a count; no censoring, not a prior
  bool prior_only = false;
  std::string_view title = {};  ///< name in sentences: "Student t"
  Paper paper = {};
  /// Statements in C that set `value` to the log density of `y` by the parameters a and b; may be
  /// empty.
  const char* c_density = nullptr;
};

/// The forms for likelihoods. A name with several parameter forms occurs several times; the form
/// with a threshold follows the one without.
std::span<const ResponseForm> response_forms();
/// The forms for priors; first those that are only for priors.
std::span<const ResponseForm> prior_forms();
const ResponseForm& form_of(ResponseFamily family);

inline constexpr int most_response_parameters = 4;

/// The form of this name whose parameters are all given, by `has(name)`; among several, the one
/// with the most given parameters, then the first. None if each form lacks a required parameter.
template <class Has>
const ResponseForm* given_form(std::span<const ResponseForm> forms, std::string_view name,
                               const Has& has) {
  const ResponseForm* found = nullptr;
  std::size_t most = 0;
  for (const ResponseForm& form : forms) {
    if (form.name != name) continue;
    std::size_t given = 0;
    bool lacks = false;
    for (const ParameterForm& family_parameter : form.family_parameters) {
      const bool is_given = has(family_parameter.name);
      given += is_given ? 1 : 0;
      lacks = lacks || !(is_given || family_parameter.optional);
    }
    if (lacks || (found && given <= most)) continue;
    found = &form;
    most = given;
  }
  return found;
}

}  // namespace wearwell
