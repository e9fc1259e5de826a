#pragma once

#include "wearwell/study/posterior_study.h"
#include "wearwell/study/posterior_summary.h"

namespace wearwell {

/// What the study and `choice` (which comes first) say of how to fit, with the method's defaults.
FitSettings fit_settings(const PosteriorStudy& study, const SamplerChoice& choice);

/// What is to be known before a run: that quadrature, which was asked for, does not reach the study
/// and NUTS draws instead. Empty where the method is the one asked for.
std::string method_note(const PosteriorStudy& study, const SamplerChoice& choice);

/// Throws InputError where no posterior can be made of the study: prior, data and law contradict
/// each other, at the end or at a stage.
void require_posterior(const PosteriorStudy& study);

const char* method_name(Method method);

/// Fits, checks and predicts: the final posterior, and that of every stage when the study asks for
/// them. What `choice` leaves open is as the study says, and then the method's default: 4 chains of
/// 1000 draws after 1000 of warm-up, for Metropolis 6000 after 4000. The result does not depend on
/// the monitor's threads; it is told of every iteration. `with_plots`: computes what a report draws
/// as well. Throws `Cancelled`.
PosteriorSummary run_study(const PosteriorStudy& study, const SamplerChoice& choice,
                           const Monitor& monitor = {}, bool with_plots = false);

}  // namespace wearwell
