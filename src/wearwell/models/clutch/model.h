#pragma once

#include "wearwell/study/model.h"

namespace wearwell::clutch {

/// Wear of dry clutches: model = "clutch-wear".
Model model();

}  // namespace wearwell::clutch
