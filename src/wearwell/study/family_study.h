#pragma once

#include <span>
#include <string>
#include <string_view>

#include "wearwell/input/source.h"

namespace wearwell {

/// The families of positive lives that `study_with_family` can exchange.
std::span<const std::string_view> exchangeable_families();

/// The study with another family of its one likelihood. The parameters and their priors stay: they give the mean and the
/// standard deviation of the logarithm of a life, and the other family has parameters with these two moments, as
/// expressions. For a lognormal from a Weibull life
///
///     median = scale exp(-0.5772/shape), log_sd = pi/sqrt(6)/shape
///
/// So what the priors say of size and scatter of lives is the same in all families: exactly for weibull, lognormal and
/// loglogistic; the scatter of gamma, birnbaum-saunders and inverse-gaussian lives is matched within some percent. A
/// third parameter, `family_lambda` (generalized-gamma: 0 is lognormal, 1 Weibull) or `family_exponent`
/// (exponentiated-weibull: 1 is Weibull), has the prior normal(0.5, 1), or lognormal(1, 0.7).
///
/// A study whose family is a list or "best" has parameters of weibull (scale, shape), lognormal (median, log_sd) or
/// inverse-gaussian (mean, shape).
///
/// Throws InputError: another number of likelihoods, a family that is none of these, keys that are not in a table
/// [likelihood.NAME] line by line.
Source study_with_family(const Source& study, std::string_view family);

}  // namespace wearwell
