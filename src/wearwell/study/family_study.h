#pragma once

#include <span>
#include <string>
#include <string_view>

#include "wearwell/input/source.h"

namespace wearwell {

/// The families of positive lives that `study_with_family` can exchange.
std::span<const std::string_view> exchangeable_families();

/// The family that the parameters of the study belong to: of a list, the first. Throws InputError.
std::string written_family(const Source& study);

/// What the parameters mean when `names` are ranked, and how the priors of their lives agree: one sentence.
std::string family_priors(std::string_view written, std::span<const std::string> names);

/// The study with another family of its one likelihood. The parameters and their priors stay: they give the mean and the
/// standard deviation of the logarithm of a life in the written family, and the other family has parameters with these
/// two moments, as expressions. For a lognormal from a Weibull life
///
///     median = scale exp(-0.5772/shape), log_sd = pi/sqrt(6)/shape
///
/// Exact for weibull, lognormal, loglogistic and frechet, also as a log-location-scale family. Standard deviations of log life up to 3.5: gamma and birnbaum-saunders
/// within 1.2 %; inverse-gaussian within 3 % up to 2, 15 % too low at 2.6, and exp(mean) up to 8 % too low. A third
/// parameter, `family_lambda` (generalized-gamma: 0 is lognormal) or `family_exponent` (exponentiated-weibull: 1 is
/// Weibull), has the prior normal(0.5, 1), or lognormal(1, 0.7). Scale and shape have the two moments at 0, or at 1:
/// elsewhere they are others, so these two families have a wider prior of lives.
///
/// Lines keep their numbers, except those after the line of a third parameter.
///
/// Throws InputError: another number of likelihoods; a family that is none of these, or "best", "all", "auto"; failure
/// modes or subpopulations with families of their own; values over several lines; keys that are not in a table
/// [likelihood.NAME] line by line.
Source study_with_family(const Source& study, std::string_view family);

}  // namespace wearwell
