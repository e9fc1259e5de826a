#pragma once

#include <string>

#include "wearwell/base/unit.h"

namespace wearwell::plan {

/// The width of a goal's 90 % interval that a text asks for, on the scale of GoalValues: "width <=
/// factor 1.5" (the upper end over the lower) for a goal on a logarithmic scale, or "width <= 20
/// MPa" for one on a linear scale. Throws InputError.
double target_width(const std::string& text, const Unit& unit, bool logarithmic);

}  // namespace wearwell::plan
