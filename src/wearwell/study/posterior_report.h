#pragma once

#include <vector>

#include "wearwell/present/section.h"
#include "wearwell/study/posterior_summary.h"

namespace wearwell {

/// The report of a study of a posterior; requires `plots`.
std::vector<present::Section> report_sections(const PosteriorSummary& result);

}  // namespace wearwell
