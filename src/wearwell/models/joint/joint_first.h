#pragma once

#include <optional>

#include "wearwell/study/first_study.h"

namespace wearwell::joint {

/// A study of worn volumes against cycles, or nothing where the headings name none.
std::optional<FirstStudy> first_study(const Table& table, const std::string& file);

}  // namespace wearwell::joint
