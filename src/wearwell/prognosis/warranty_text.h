#pragma once

#include <string>

#include "wearwell/prognosis/decisions_report.h"

namespace wearwell::prognosis {

/// "2.5 %", "< 0.01 %".
std::string share_text(double share);

/// The length of a warranty and what it costs, as sentences; with the error of its bound where that is not negligible.
std::string warranty_text(const DecisionsReport& report);

}  // namespace wearwell::prognosis
