#pragma once

#include "wearwell/study/model.h"

namespace wearwell::joint {

/// Wear of joints by Archard's law: model = "archard-joint".
Model model();

}  // namespace wearwell::joint
