#pragma once

#include "wearwell/study/model.h"

namespace wearwell::ownlaw {

/// Laws in the user's own words, and what `wearwell new law` writes.
Model model();

/// The same model, with what `wearwell new life` and `new accelerated` write.
Model life();
Model accelerated();

}  // namespace wearwell::ownlaw
