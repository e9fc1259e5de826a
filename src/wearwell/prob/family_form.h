#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace wearwell {

enum class StandardDistribution;

/// A family of distributions: its place in the list (families.h). Those that other code names stand
/// here; the list has more, and each that is positive once more with a threshold.
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
  flat,  ///< this and what follows are for priors alone
  uniform,
  half_normal,
  half_cauchy,
  inverse_gamma,
  beta,
  jeffreys,
};

/// What a parameter of a family, a slot, holds.
enum class ParameterKind {
  place,        ///< a value of what is observed
  size,         ///< a size of the same dimension, positive
  number,       ///< a pure number, positive
  real,         ///< a pure number of either sign
  probability,  ///< a pure number, 0 to 1
};

struct ParameterForm {
  std::string_view name;
  ParameterKind kind;
  bool optional = false;
  /// How a description has it, "{}" for the number: "{} degrees of freedom". Empty: the name and the number.
  std::string_view phrase = {};
};

/// Probability paper: the axes on which shares that have failed are drawn against life.
struct Paper {
  std::string_view name;
  StandardDistribution distribution;  ///< the vertical axis is its quantile
  bool straight = true;               ///< distributions of the family are straight lines on it
};

/// A family as a study names it, with its slots in order.
struct ResponseForm {
  std::string_view name;
  ResponseFamily family;
  std::vector<ParameterForm> slots;
  bool positive = false;  ///< what is observed is above 0
  bool counted = false;   ///< it is a count; nothing is censored, and it is no prior
  bool prior_only = false;
  std::string_view title = {};  ///< in sentences: "Student t"
  Paper paper = {};
  /// Statements in C that set `value` to the log density of `y` by the parameters a and b; may be none.
  const char* c_density = nullptr;
};

/// Those of likelihoods. A name with several parameter forms is there several times, the form with a
/// threshold after that without.
std::span<const ResponseForm> response_forms();
/// Those of priors, likewise; first those that are for priors alone.
std::span<const ResponseForm> prior_forms();
const ResponseForm& form_of(ResponseFamily family);

inline constexpr int most_response_parameters = 4;

/// Of some forms of one name that whose parameters are given, by `has(name)`; of several that of
/// which the most are given, then the first. None where each lacks one that it needs.
template <class Has>
const ResponseForm* given_form(std::span<const ResponseForm> forms, std::string_view name,
                               const Has& has) {
  const ResponseForm* found = nullptr;
  std::size_t most = 0;
  for (const ResponseForm& form : forms) {
    if (form.name != name) continue;
    std::size_t given = 0;
    bool lacks = false;
    for (const ParameterForm& slot : form.slots) {
      const bool is_given = has(slot.name);
      given += is_given ? 1 : 0;
      lacks = lacks || !(is_given || slot.optional);
    }
    if (lacks || (found && given <= most)) continue;
    found = &form;
    most = given;
  }
  return found;
}

}  // namespace wearwell
