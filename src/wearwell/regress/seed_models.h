#pragma once

#include "wearwell/regress/model_pool.h"

namespace wearwell {

/// Offers good models to the pool before the search, so that it cuts early: forward selection
/// through every size, then exchanges of one term from the best of those, as long as they improve.
/// Cheap (some milliseconds) and deterministic.
void seed_models(const SearchProblem& problem, ModelPool& pool, TermSet forced);

}  // namespace wearwell
