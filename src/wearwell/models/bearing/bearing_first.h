#pragma once

#include <optional>

#include "wearwell/study/first_study.h"

namespace wearwell::bearing {

/// A study of wear depths of journal bearings, or nothing where the headings name none.
std::optional<FirstStudy> first_study(const Table& table, const std::string& file);

}  // namespace wearwell::bearing
