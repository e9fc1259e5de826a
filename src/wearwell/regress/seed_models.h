#pragma once

#include "wearwell/regress/model_pool.h"

namespace wearwell {

/// Offers good models to the pool before the search, so that it cuts early: forward selection
/// through every size, then from the best of those exchanges of one term while they help. Cheap
/// (some milliseconds) and the same every time.
void seed_models(const SearchProblem& problem, ModelPool& pool, TermSet forced);

}  // namespace wearwell
