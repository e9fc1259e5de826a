#pragma once

#include "wearwell/models/formula_model/subpopulation_answers.h"

namespace wearwell::formula_model {

/// Adds what [predict] asks of units with their own rates of use: their life in calendar time, with the lives and survival of
/// predict.calendar, and the share that fails within predict.warranty, an age and a use, whichever comes first.
void add_use_rate_answers(const AskedOfMixture& asked, PosteriorStudy& study);

}  // namespace wearwell::formula_model
