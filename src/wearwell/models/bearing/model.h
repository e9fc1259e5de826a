#pragma once

#include "wearwell/study/model.h"

namespace wearwell::bearing {

/// Wear of journal bearings: model = "bearing-wear".
Model model();

}  // namespace wearwell::bearing
