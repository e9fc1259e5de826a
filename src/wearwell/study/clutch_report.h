#pragma once

#include <string>

#include "wearwell/study/clutch_study.h"

namespace wearwell::clutch {

/// The result as one page that opens without a network, with the figures of Haramina et al. (2025).
std::string clutch_report(const ClutchStudy& study, const ClutchResult& result);

}  // namespace wearwell::clutch
