#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/prognosis/new_data.h"
#include "wearwell/study/posterior_study.h"
#include "wearwell/study/result.h"

namespace wearwell::prognosis {

/// Readings that contradict the posterior before them: each by its two-sided predictive p-value
/// under `before`; where units vary, given all readings of its own unit (which makes it milder).
/// Reported below one in a thousand over all new rows. Empty if the study does not have one score
/// per row: the check is then not possible.
std::optional<std::vector<Contradiction>> hardly_possible(const PosteriorStudy& study,
                                                          const WeightedDraws& before,
                                                          const JoinedData& joined);

/// Adds them to the known contradictions; if the check is not possible, adds a note.
void judge_new_data(const PosteriorStudy& study, const WeightedDraws& before, JoinedData& joined);

/// What became of the new rows, as `update` in summary.json.
nlohmann::ordered_json rows_json(const JoinedData& joined, const std::string& files);

/// The study with an additional check `new-data`, which reports the counts of rows; summary.json
/// has it under `update`.
PosteriorStudy updated_study(const PosteriorStudy& study, JoinedData joined,
                             const std::string& files);

/// The same for a result without a posterior: a check `new-data`, `update` in summary.json, and a
/// section of the report.
void add_new_data(const JoinedData& joined, const std::string& files, Result& result);

}  // namespace wearwell::prognosis
