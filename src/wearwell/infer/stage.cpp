#include "wearwell/infer/stage.h"

#include <fmt/format.h>

namespace wearwell {

const char* stage_name(Stage stage) {
  switch (stage) {
    case Stage::mode:
      return "search for the mode";
    case Stage::maxima:
      return "search for other maxima";
    case Stage::tails:
      return "tails";
    case Stage::quadrature:
      return "quadrature";
    case Stage::digits:
      return "conditioning";
    case Stage::constrained_mode:
      return "mode in the parameters' own units";
    case Stage::effects:
      return "integrals over effects";
  }
  return "";
}

Check computation(const std::vector<StageDiagnostic>& stage_diagnostics,
                  const std::string& precision) {
  Findings findings("computation");
  for (const StageDiagnostic& each : stage_diagnostics) {
    findings.add(each.verdict, fmt::format("{}: {}", stage_name(each.stage), each.what),
                 each.advice);
  }
  return findings.result(precision);
}

}  // namespace wearwell
