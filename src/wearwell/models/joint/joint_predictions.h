#pragma once

#include "wearwell/bayes/observation.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/models/joint/archard.h"
#include "wearwell/models/joint/joint_data.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell::joint {

/// Adds the quantities of a joint to `study`: the worn volume at each stage and along the history,
/// and those of `[predict]`: volumes at future cycles, the life until a threshold
/// (docs/reference/joint.md).
void add_predictions(const TomlReader& root, const Archard& law, ObservationFamily family,
                     const JointData& data, PosteriorStudy& study);

}  // namespace wearwell::joint
