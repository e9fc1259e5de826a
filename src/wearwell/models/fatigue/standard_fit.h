#pragma once

#include <optional>
#include <string>

#include "wearwell/models/fatigue/sn_data.h"
#include "wearwell/models/fatigue/sn_law.h"
#include "wearwell/models/fatigue/tolerance.h"

namespace wearwell {

/// The fit of the standards: failures only, a straight line in logarithms, ignoring all other
/// tests.
struct StandardFit {
  std::optional<fatigue::FittedLine> line;  ///< of log10 life [cycles] on log10 stress [Pa]
  std::string why_not;                      ///< if the standards do not apply
  int failures = 0, left_out = 0;
};
StandardFit standard_fit(const fatigue::SnLaw& law, const SnData& data);

/// log10 of the fully reversed stress/Pa for the standards' line, if they apply: the mean-stress
/// correction is then known.
double standard_log10_stress(const fatigue::SnLaw& law, const fatigue::Stress& stress);

}  // namespace wearwell
