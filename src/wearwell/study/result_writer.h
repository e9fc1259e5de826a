#pragma once

#include <filesystem>
#include <string_view>

#include "wearwell/present/result_folder.h"
#include "wearwell/study/result.h"

namespace wearwell {

/// Writes a result into a folder that was opened before the study ran, all or nothing:
/// summary.json, the result's other files, every table of its report as tables/NAME.csv,
/// report.json and report.html if there are sections, and study.toml if there is a study. Throws
/// like ResultFolder.
void write_result(const Result& result, std::string_view study_text, ResultFolder& folder);

/// The text of summary.json, ending with a newline.
std::string summary_text(const Result& result);

}  // namespace wearwell
