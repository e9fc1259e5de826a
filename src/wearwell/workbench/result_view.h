#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "wearwell/study/model.h"

namespace wearwell::workbench {

/// A result folder: {title, model, equation, trusted, checks: [{name, verdict, detail, advice}],
/// leads: [sentence], tiles: [{name, value, unit, note}], tables: [{id, caption, columns, rows}], lives}. Numbers are
/// texts as the report shows them. `lives`: whether `life_answer` has a posterior to ask; `no_lives`:
/// why it cannot be read. Throws InputError.
nlohmann::ordered_json result_json(const std::filesystem::path& folder);

/// The report as a page.
std::string report_page(const std::filesystem::path& folder);

/// The answer of `wearwell life` to {"unit", "survived", "horizon", "risk", "level", "sides"}, texts,
/// all optional: {text, answer, command}. `answer` is what --json prints. Throws InputError.
nlohmann::ordered_json life_answer(const std::filesystem::path& folder, Models models,
                                   const nlohmann::json& question);

}  // namespace wearwell::workbench
