#pragma once

#include <vector>

#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/constrained_mode.h"
#include "wearwell/infer/fit.h"
#include "wearwell/study/posterior_study.h"
#include "wearwell/study/posterior_summary.h"

namespace wearwell {

/// Summarizes a fit in the user's units.
std::vector<ParameterSummary> summarize_parameters(const Posterior& posterior, const Fit& fit);
std::vector<PredictionSummary> summarize(const std::vector<PredictionRequest>& requests,
                                         const Fit& fit, const Ends& ends = {});
std::vector<QuantitySummary> summarize_quantities(const PosteriorStudy& study, const Fit& fit);
LifeSummary summarize(const LifeRequest& request, const Fit& fit);
/// The predictions, quantities and life that `asked` requests of a posterior fitted earlier by a
/// study of the same data, model and priors; the rest of the summary is empty. `ends` replaces the
/// probabilities of the quantiles named 05 and 95. Throws InputError if data or parameters are not
/// the same.
PosteriorSummary asked_later(const PosteriorStudy& asked, const PosteriorSummary& fitted,
                             const Ends& ends = {});
/// `observations`: the number in BIC.
ModeSummary summarize_mode(const PosteriorStudy& study, const Posterior& posterior, const Fit& fit,
                           const NaturalMode& mode, double observations);

}  // namespace wearwell
