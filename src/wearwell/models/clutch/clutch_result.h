#pragma once

#include <memory>

#include "wearwell/models/clutch/clutch_study.h"
#include "wearwell/study/result.h"

namespace wearwell::clutch {

/// The result of a clutch study for all commands. `report`: with the sections of a report.
Result result_of(const ClutchStudy& study, const ClutchResult& found, bool report);

}  // namespace wearwell::clutch
