#pragma once

#include <vector>

#include "wearwell/models/clutch/clutch_study.h"
#include "wearwell/present/section.h"

namespace wearwell::clutch {

/// The report, with the figures of Haramina et al. (2025).
std::vector<present::Section> report_sections(const ClutchStudy& study, const ClutchResult& result);

}  // namespace wearwell::clutch
