#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "wearwell/study/clutch_study.h"

namespace wearwell::clutch {

/// summary.json (docs/clutch.md). Wear rates in mm^3/MJ, volumes in mm^3, energies in MJ.
nlohmann::ordered_json summary_json(const ClutchStudy& study, const ClutchResult& result);
/// One row a weighing of a sequence.
std::string sequences_csv(const ClutchResult& result);
/// What the terminal shows.
std::string summary_text(const ClutchStudy& study, const ClutchResult& result);

}  // namespace wearwell::clutch
