#pragma once

#include <wearwell/study/model.h>

namespace drift {

/// Wear that grows in proportion to time: depth = rate t + N(0, sigma^2).
wearwell::Model model();

}  // namespace drift
