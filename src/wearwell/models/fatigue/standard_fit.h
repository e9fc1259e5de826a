#pragma once

#include <optional>
#include <string>

#include "wearwell/models/fatigue/sn_data.h"
#include "wearwell/models/fatigue/sn_law.h"
#include "wearwell/models/fatigue/tolerance.h"

namespace wearwell {

/// What the standards fit: failures alone, a straight line in logarithms, as if it were known that
/// nothing else was seen.
struct StandardFit {
  std::optional<fatigue::FittedLine> line;  ///< of log10 life [cycles] on log10 stress [Pa]
  std::string why_not;                      ///< where the standards do not apply
  int failures = 0, left_out = 0;
};
StandardFit standard_fit(const fatigue::SnLaw& law, const SnData& data);

/// log10 of the fully reversed stress/Pa on which the standards' line is fitted, where they apply: constants of
/// the mean stress are known then.
double standard_log10_stress(const fatigue::SnLaw& law, const fatigue::Stress& stress);

}  // namespace wearwell
