#pragma once

#include <string>
#include <vector>

#include "wearwell/prognosis/named_life.h"

namespace wearwell::prognosis {

/// The named lives of a study that has some; else throws InputError that begins with `title` and says what can be done instead.
std::vector<NamedLife> required_lives(const PosteriorStudy& study, const std::string& title);

/// Refuses what needs lives of new units, for a study of units that are repaired: it names the commands that answer.
void refuse_repairable(const PosteriorStudy& study, const std::string& title);

}  // namespace wearwell::prognosis
