#pragma once

#include "wearwell/study/model.h"

namespace wearwell::ownlaw {

/// Laws in the user's own words, and what `wearwell new law` writes.
Model model();

}  // namespace wearwell::ownlaw
