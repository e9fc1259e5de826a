#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "wearwell/prognosis/backtest.h"

namespace wearwell::prognosis {

/// As text, ending with a newline.
std::string backtest_text(const Backtest& test, const Tracker& tracker);
/// Counts, and coverage by number of readings under `ages`.
nlohmann::ordered_json backtest_json(const Backtest& test);
/// Each forecast in the units of the study, as CSV.
std::string backtest_csv(const Backtest& test, const Tracker& tracker);

}  // namespace wearwell::prognosis
