#pragma once

#include <optional>
#include <string>

#include "wearwell/base/unit_system.h"

namespace wearwell {

/// "; did you mean 'mm'?": what may be meant by `written`, which is no unit of `wanted`, or none at
/// all: other capitals, the factor of "x1000 mm", or, where it is none at all, a common name near to
/// it. Empty where nothing is near.
std::string unit_hint(const std::string& written, const std::optional<Dimension>& wanted);

/// The unit without the times sign in front of its factor: "1000 mm" of "x1000 mm"; else `written`.
std::string without_times(const std::string& written);

}  // namespace wearwell
