#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wearwell/models/fatigue/sn_data.h"
#include "wearwell/models/fatigue/sn_law.h"
#include "wearwell/models/fatigue/tolerance.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell {

/// A curve to design with: under each stress such a share outlasts its life, with such confidence.
struct DesignLevel {
  std::string name;  ///< "90/90", "B-basis"
  double reliability = 0, confidence = 0;
};

/// 90/90, B-basis (90 % with 95 % confidence), A-basis (99 % with 95 %), and FKM's 97.7 % with 90 %.
const std::vector<DesignLevel>& design_levels();

/// Where the curves are told: along a line of stresses through the tests.
fatigue::StressLine line_of_tests(const fatigue::SnLaw& law, const SnData& data);

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

/// What an S-N study adds to its result: under "fatigue" what `wearwell fatigue life` goes on from, under
/// "design_curves" the curves with the standards' own numbers beside them, scatter ranges T_N and T_S,
/// and why they differ; the same as tables and text.
TradeAddition sn_addition(const fatigue::SnLaw& law, const SnData& data, const Fit& fit);

}  // namespace wearwell
