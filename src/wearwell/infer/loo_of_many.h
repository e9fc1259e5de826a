#pragma once

#include "wearwell/bayes/log_density.h"
#include "wearwell/bayes/normal_score.h"
#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/infer/loo.h"

namespace wearwell {

/// With at least this many terms `psis_loo` uses `loo_of_many`.
inline constexpr std::size_t terms_are_many = 20'000;

/// Leave-one-out with memory proportional to the number of terms. Sums over some hundred draws
/// suffice, because each of many terms has little influence. Weights of the thousand most uneven
/// terms are smoothed and have a k-hat; the others have -infinity. Arguments as in `psis_loo`.
Loo loo_of_many(const LogDensity& likelihood, const WeightedDraws& draws, std::size_t terms,
                double efficiency, const Scores* scores);

}  // namespace wearwell
