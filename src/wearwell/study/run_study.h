#pragma once

#include "wearwell/study/posterior_study.h"
#include "wearwell/study/posterior_summary.h"

namespace wearwell {

/// The settings of a fit: `choice`, else the study, else the method's defaults.
FitSettings fit_settings(const PosteriorStudy& study, const SamplerChoice& choice);

/// Explains that NUTS draws because the requested quadrature cannot handle the study. Empty if the
/// requested method is used.
std::string method_note(const PosteriorStudy& study, const SamplerChoice& choice);

/// Throws InputError if the study has no posterior: prior, data and model contradict each other, at
/// the end or at a stage.
void require_posterior(const PosteriorStudy& study);

const char* method_name(Method method);

/// Fits, checks and predicts: the final posterior, and that of every stage if the study requests
/// stages. Settings missing in `choice` come from the study, else from the method's defaults: 4
/// chains of 1000 draws after 1000 of warm-up, for Metropolis 6000 after 4000. The result does not
/// depend on the monitor's threads; the monitor receives every iteration. `with_plots` also
/// computes the plots of a report. Throws `Cancelled`.
PosteriorSummary run_study(const PosteriorStudy& study, const SamplerChoice& choice,
                           const Monitor& monitor = {}, bool with_plots = false);

}  // namespace wearwell
