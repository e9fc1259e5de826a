#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wearwell/present/number.h"
#include "wearwell/study/posterior_summary.h"

namespace wearwell {

/// The answers to the study's questions, most important first: the limit, the design values, the
/// last prediction, then the curve or the first parameter. Each is a clause without capital and
/// full stop.
std::vector<std::string> answers(const PosteriorSummary& result, Script script);

/// A quantity of which a study estimates the decimal logarithm.
struct NaturalParameter {
  std::string meaning;  ///< "the median fatigue limit"
  std::string unit;
  double q05 = 0, q50 = 0, q95 = 0;
};

/// Empty for a parameter that is not a logarithm.
std::optional<NaturalParameter> of_logarithm(const ParameterSummary& parameter);

/// What a headline says of a parameter.
struct ParameterValue {
  double value = 0;
  bool is_median = false;
};

/// The posterior mean, unless it lies more than 10 % and a twentieth of the 90 % interval from the
/// median: the median of a skewed distribution.
ParameterValue headline_value(const ExactSummary& parameter);

/// "a new bearing", "the median bearing", "machine 12"; for a kind of item, "the softer spring".
std::string item_text(const std::string& of, bool is_kind = false);

/// A parameter as the title of a figure: "k, wear coefficient" or "median machine's rate"; the name
/// alone if its meaning is not stated.
std::string titled(const ParameterSummary& parameter);

/// " of bearing B at 1 MPa" for an observed item, " of a bearing at 1 MPa" for a new one; empty if
/// the quantity names neither.
std::string of_whom(const LifeSummary& summary);

/// The quantities whose answer comes first: those marked by the model, else the life of the item
/// that is expected to fail first, else the last life.
std::vector<const QuantitySummary*> headlines(const PosteriorSummary& result);

/// The title of their table: "Results by bearing"; "Results" if all belong to one item.
std::string results_title(const std::vector<QuantitySummary>& quantities);

/// Names of the parameters whose prior is the default, "k, sigma"; empty when all are stated.
std::string default_priors(const std::vector<ParameterSummary>& parameters);

/// "standard error 1.23" for elpd; one observation has none.
std::string standard_error_text(const Loo& loo);

}  // namespace wearwell
