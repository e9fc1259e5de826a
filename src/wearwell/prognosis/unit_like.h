#pragma once

#include <optional>
#include <string>

#include "wearwell/base/unit.h"

namespace wearwell::prognosis {

/// A unit of the same dimension as one that is known, as its user wrote it; nothing where it is none.
std::optional<Unit> unit_like(const std::string& text, const Unit& like);

}  // namespace wearwell::prognosis
