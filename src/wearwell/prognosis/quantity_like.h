#pragma once

#include <string>

#include "wearwell/base/unit.h"
#include "wearwell/input/option_value.h"

namespace wearwell::prognosis {

/// A quantity given as an option beside a known unit, of its dimension, in SI. Throws InputError
/// that begins with the option's name, also for a number without a unit that could mean two things.
double quantity_like(const std::string& option, const std::string& text, const Unit& like,
                     Allowed allowed = Allowed::any);

}  // namespace wearwell::prognosis
