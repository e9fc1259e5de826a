#pragma once

#include <string>

#include "wearwell/report/result.h"

namespace wearwell {

/// The result as one page that opens without a network: verdict, predictions, parameters, fit,
/// checks, method. `result.plots` must be there.
std::string html_report(const StudyResult& result);

}  // namespace wearwell
