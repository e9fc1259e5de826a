#pragma once

#include <filesystem>
#include <string_view>

#include "wearwell/present/result_folder.h"
#include "wearwell/study/result.h"

namespace wearwell {

/// Writes a result into a folder that was opened before the study ran, whole or not at all:
/// summary.json, the result's own files, every table of its report as tables/NAME.csv, report.json
/// and report.html where there are sections, and study.toml where there is a study. Throws as
/// ResultFolder does.
void write_result(const Result& result, std::string_view study_text, ResultFolder& folder);

/// summary.json as it is written, ending with a newline.
std::string summary_text(const Result& result);

}  // namespace wearwell
