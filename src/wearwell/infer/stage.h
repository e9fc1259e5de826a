#pragma once

#include <array>
#include <string>
#include <vector>

#include "wearwell/infer/check.h"

namespace wearwell {

/// The stages of a fit that can miss their accuracy. A new stage needs an entry here; a test checks
/// for each that its failure makes the fit untrusted.
enum class Stage { mode, maxima, tails, quadrature, digits, constrained_mode, effects };

inline constexpr std::array all_stages = {Stage::mode,       Stage::maxima, Stage::tails,
                                          Stage::quadrature, Stage::digits, Stage::constrained_mode,
                                          Stage::effects};

/// A shortfall of a stage. Verdict::warn if the numbers are confirmed otherwise.
struct StageDiagnostic {
  Stage stage;
  Verdict verdict;
  std::string what;
  std::string advice;
};

/// "search for the mode".
const char* stage_name(Stage stage);

/// The check "computation", with one finding for each shortfall. `precision` is its finding where there is none.
Check computation(const std::vector<StageDiagnostic>& stage_diagnostics,
                  const std::string& precision);

}  // namespace wearwell
