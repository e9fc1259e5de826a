#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "wearwell/models/clutch/clutch_study.h"

namespace wearwell::clutch {

/// Content of summary.json after the header (docs/reference/clutch.md). Wear rates in mm^3/MJ,
/// volumes in mm^3, energies in MJ.
nlohmann::ordered_json summary_body(const ClutchStudy& study, const ClutchResult& result);
/// One row per weighing of a sequence.
std::string sequences_csv(const ClutchResult& result);
/// The output on the terminal.
std::string summary_text(const ClutchStudy& study, const ClutchResult& result);

}  // namespace wearwell::clutch
