#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "wearwell/study/model.h"

namespace wearwell::workbench {

/// A result folder: {title, model, equation, trusted, checks: [{name, verdict, detail, advice}],
/// leads: [sentence], tiles: [{name, value, unit, note}], tables: [{id, caption, columns, rows}], lives}. Numbers are
/// texts as the report shows them. `command`, `python`: what fits the study again, if STUDY.toml stands
/// beside STUDY-results as it was fitted. `lives`: whether `life_answer` has a posterior to ask; `no_lives`:
/// why it cannot be read. `varied`: numbers that `life_answer` can change (changed_prediction.h). Throws InputError.
nlohmann::ordered_json result_json(const std::filesystem::path& folder, Models models);

/// The report as a page.
std::string report_page(const std::filesystem::path& folder);

}  // namespace wearwell::workbench
