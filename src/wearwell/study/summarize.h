#pragma once

#include <vector>

#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/constrained_mode.h"
#include "wearwell/infer/fit.h"
#include "wearwell/study/posterior_study.h"
#include "wearwell/study/posterior_summary.h"

namespace wearwell {

/// A fit in the units that its user asked for.
std::vector<ParameterSummary> summarize_parameters(const Posterior& posterior, const Fit& fit);
std::vector<PredictionSummary> summarize(const std::vector<PredictionRequest>& requests,
                                         const Fit& fit, const Ends& ends = {});
std::vector<QuantitySummary> summarize_quantities(const PosteriorStudy& study, const Fit& fit);
LifeSummary summarize(const LifeRequest& request, const Fit& fit);
/// The predictions, quantities and life that `asked` wants of the posterior that a study of the same
/// data, law and priors was fitted to before; nothing else of the summary is set. With other `ends`
/// what predictions call 05 and 95 is there. Throws InputError where data or parameters differ.
PosteriorSummary asked_later(const PosteriorStudy& asked, const PosteriorSummary& fitted,
                             const Ends& ends = {});
/// `observations`: of which BIC takes the logarithm.
ModeSummary summarize_mode(const PosteriorStudy& study, const Posterior& posterior, const Fit& fit,
                           const NaturalMode& mode, double observations);

}  // namespace wearwell
