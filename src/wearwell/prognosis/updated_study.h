#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wearwell/prognosis/new_data.h"
#include "wearwell/study/posterior_study.h"
#include "wearwell/study/result.h"

namespace wearwell::prognosis {

/// Readings that the posterior before them hardly bears: each by its place in its predictive distribution over
/// `before`, two-sided; given, where units differ, what all readings of its own unit say of that (which makes it
/// milder). Told below one in a thousand over all that are new. None where the study's scores are not one a row: then it
/// cannot be said.
std::optional<std::vector<Contradiction>> hardly_possible(const PosteriorStudy& study,
                                                          const WeightedDraws& before,
                                                          const JoinedData& joined);

/// Adds them to the contradictions that are known; where it cannot be said, a note.
void judge_new_data(const PosteriorStudy& study, const WeightedDraws& before, JoinedData& joined);

/// The study with a check `new-data` more, which says what became of the rows; summary.json has it under `update`.
PosteriorStudy updated_study(const PosteriorStudy& study, JoinedData joined,
                             const std::string& files);

/// The same of a result that has no posterior: a check `new-data`, `update` in summary.json, and a section of the report.
void add_new_data(const JoinedData& joined, const std::string& files, Result& result);

}  // namespace wearwell::prognosis
