#pragma once

#include <string>
#include <vector>

#include "wearwell/study/posterior_summary.h"

namespace wearwell {

/// The name of the share of a limited failure population that fails at all.
inline constexpr const char* share_failing = "share that fails at all";

/// Whether it is the life by which a share has failed; infinite, it is never reached.
bool is_b_life(const QuantitySummary& quantity);

/// "Never reached: at most 0.6744 % fail at all (0.4787 to 0.9214 %, 90 %)." if a B-life among them is never reached; else empty.
std::string never_reached(const std::vector<QuantitySummary>& quantities);

}  // namespace wearwell
