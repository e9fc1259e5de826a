#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "wearwell/study/model.h"

namespace wearwell::workbench {

/// Questions on a result folder. Each field of a question is a text and optional, named as the option
/// of the command with "_" for "-". Each answer is {text, answer, command, python}: what the command prints,
/// what it prints with --json, the command, and the line of Python that gives the same. Throws InputError.

/// The answer of `wearwell life` to {"unit", "survived", "horizon", "risk", "level", "sides"}. `changes`: other values of numbers of
/// [predict] (changed_prediction.h); then there are no command and python.
nlohmann::ordered_json life_answer(const std::filesystem::path& folder, Models models,
                                   const nlohmann::json& question);

/// The answer of `wearwell decide` to {"failure_cost", "replacement_cost", "inspection_cost",
/// "downtime_cost", "claims", "month", "at"}, with `curve`: {age, cost, age_unit, cost_unit}, the
/// long-run cost against the age of replacement.
nlohmann::ordered_json decision_answer(const std::filesystem::path& folder, Models models,
                                       const nlohmann::json& question);

/// The answer of `wearwell plan next` to {"goal", "grid", "specimens"}.
nlohmann::ordered_json next_test_answer(const std::filesystem::path& folder, Models models,
                                        const nlohmann::json& question);

/// The units of a result whose remaining useful lives can be asked: {noun, names, all, command, python};
/// no names if it follows none, at most 200 of `all`.
nlohmann::ordered_json followed_units(const std::filesystem::path& folder, Models models);

}  // namespace wearwell::workbench
