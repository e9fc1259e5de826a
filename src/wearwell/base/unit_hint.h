#pragma once

#include <optional>
#include <string>

#include "wearwell/base/unit_system.h"

namespace wearwell {

/// "; did you mean 'mm'?" for a `written` text that is not a unit of `wanted`: other case, the
/// factor of "x1000 mm", or, if it is not a unit at all, the nearest common name. Empty if nothing
/// is near.
std::string unit_hint(const std::string& written, const std::optional<Dimension>& wanted);

/// The unit without the multiplication sign before its factor: "1000 mm" for "x1000 mm"; else
/// `written`.
std::string without_times(const std::string& written);

}  // namespace wearwell
