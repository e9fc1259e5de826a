#pragma once

#include "wearwell/bayes/log_density.h"
#include "wearwell/bayes/normal_score.h"
#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/infer/loo.h"

namespace wearwell {

/// From so many terms on `psis_loo` is `loo_of_many`.
inline constexpr std::size_t terms_are_many = 20'000;

/// Leave-one-out in memory of the size of the terms, however many draws: sums over some hundred
/// draws, which are enough where each of many terms moves the posterior so little. Weights of the
/// thousand most uneven terms are smoothed and have a k-hat; that of all others is -infinity. Arguments as
/// of `psis_loo`.
Loo loo_of_many(const LogDensity& likelihood, const WeightedDraws& draws, std::size_t terms,
                double efficiency, const Scores* scores);

}  // namespace wearwell
