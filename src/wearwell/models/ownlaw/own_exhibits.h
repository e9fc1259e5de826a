#pragma once

#include "wearwell/models/ownlaw/own_asked.h"

namespace wearwell::ownlaw {

/// Adds figures of the paths that [predict] asks for to the study: of a new unit and of each one seen, with
/// bands, readings and the limit.
void add_path_figures(const Asked& asked, PosteriorStudy& study);

}  // namespace wearwell::ownlaw
