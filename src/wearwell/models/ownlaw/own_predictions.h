#pragma once

#include "wearwell/models/ownlaw/own_likelihood.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell::ownlaw {

/// Reads [predict] and adds what it asks for to the study: lives, remaining useful lives, B-lives, survival,
/// acceleration, measurements to come, quantities of the parameters. Throws InputError.
void read_own_predictions(const TomlReader& root, std::shared_ptr<const OwnLaw> law,
                          std::shared_ptr<const OwnRows> rows, PosteriorStudy& study);

}  // namespace wearwell::ownlaw
