#pragma once

#include "wearwell/study/study.h"
#include "wearwell/study/toml_reader.h"

namespace wearwell {

/// Reads `model = "sn"` (docs/fatigue.md) into `study`, whose general parts are read already.
/// `folder` is where relative paths start.
void read_sn_study(const TomlReader& root, const std::filesystem::path& folder, Study& study);

}  // namespace wearwell
