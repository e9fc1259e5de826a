#pragma once

#include <filesystem>

#include "wearwell/report/json_reader.h"
#include "wearwell/report/result.h"

namespace wearwell {

/// summary.json of `folder`, with the tables beside it that it names; without draws and plots.
/// Throws InputError naming file and key. Counts fit together: every stage has the parameters of the
/// whole, a quantity with a bound has its level.
StudyResult read_summary(const JsonReader& json, const std::filesystem::path& folder);

}  // namespace wearwell
