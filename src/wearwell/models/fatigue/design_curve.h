#pragma once

#include <string>
#include <vector>

#include "wearwell/models/fatigue/sn_data.h"
#include "wearwell/models/fatigue/sn_law.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell {

/// A design curve: under each stress this share outlasts the life, with this confidence.
struct DesignLevel {
  std::string name;  ///< "90/90", "B-basis"
  double reliability = 0, confidence = 0;
};

/// 90/90, B-basis (90 % with 95 % confidence), A-basis (99 % with 95 %), and FKM's 97.7 % with 90 %.
const std::vector<DesignLevel>& design_levels();

/// Stresses of the curves: along a line of stresses through the tests.
fatigue::StressLine line_of_tests(const fatigue::SnLaw& law, const SnData& data);

/// What an S-N study adds to its result: under "fatigue" the input of `wearwell fatigue life`,
/// under "design_curves" the curves together with the standards' numbers, scatter ranges T_N and
/// T_S, and the reasons of differences; the same as tables and text.
PresetAddition sn_addition(const fatigue::SnLaw& law, const SnData& data, const Fit& fit);

}  // namespace wearwell
