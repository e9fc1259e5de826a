#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wearwell/present/number.h"
#include "wearwell/study/posterior_summary.h"

namespace wearwell {

/// What was asked, answered: the limit, the numbers to design with, the last prediction, then the
/// curve or the first parameter. Clauses without capital and full stop, the most wanted first.
std::vector<std::string> answers(const PosteriorSummary& result, Script script);

/// A quantity of which a study estimates the decimal logarithm.
struct NaturalParameter {
  std::string meaning;  ///< "the median fatigue limit"
  std::string unit;
  double q05 = 0, q50 = 0, q95 = 0;
};

/// Empty of a parameter that is no logarithm.
std::optional<NaturalParameter> of_logarithm(const ParameterSummary& parameter);

/// "a new bearing", "the median bearing", "machine 12"; of a kind of items, "the softer spring".
std::string item_text(const std::string& of, bool is_kind = false);

/// A parameter as the title of a figure: "k, wear coefficient", "median machine's rate", and its name alone where its meaning is not
/// stated.
std::string titled(const ParameterSummary& parameter);

/// " of bearing B at 1 MPa" of one that is known, " of a bearing at 1 MPa" of one to come; empty where nothing is said.
std::string of_whom(const LifeSummary& summary);

/// The quantities whose answer comes first: those that the trade marks, else the life of the item
/// that is expected to fail first, else the last life.
std::vector<const QuantitySummary*> headlines(const PosteriorSummary& result);

/// The title of their table: "Results by bearing"; "Results" where all are of one item.
std::string results_title(const std::vector<QuantitySummary>& quantities);

/// Names of the parameters whose prior is the default, "k, sigma"; empty when all are stated.
std::string default_priors(const std::vector<ParameterSummary>& parameters);

/// Of elpd, "standard error 1.23"; of one observation there is none.
std::string standard_error_text(const Loo& loo);

}  // namespace wearwell
