#pragma once

#include <filesystem>

#include "wearwell/report/result.h"

namespace wearwell {

/// A result as `wearwell fit` wrote it: summary.json, plots.json (when it is there) and
/// draws_1.csv, draws_2.csv, ... Of the draws it reads the parameters and which were divergent.
/// Throws InputError naming the file that is missing or is not what wearwell writes.
StudyResult read_result(const std::filesystem::path& folder);

}  // namespace wearwell
