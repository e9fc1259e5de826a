#pragma once

#include <string>
#include <vector>

#include "wearwell/study/posterior_summary.h"

namespace wearwell {

/// How numbers stand in a sentence: with raised powers on a page, plainly on a terminal.
enum class Wording { page, plain };

/// What was asked, answered: the limit, the numbers to design with, the last prediction, then the
/// curve or the first parameter. Clauses without capital and full stop, the most wanted first.
std::vector<std::string> answers(const PosteriorSummary& result, Wording wording);

/// " of bearing B at 1 MPa" of one that is known, " of a bearing at 1 MPa" of one to come; empty where nothing is said.
std::string of_whom(const LifeSummary& summary);

/// The quantities whose answer comes first: those that the trade marks, else the last life.
std::vector<const QuantitySummary*> headlines(const PosteriorSummary& result);

/// Names of the parameters whose prior nobody stated, "k, sigma"; empty when all are.
std::string default_priors(const std::vector<ParameterSummary>& parameters);

/// Of elpd, "standard error 1.23"; of one observation there is none.
std::string standard_error_in_words(const Loo& loo);

}  // namespace wearwell
