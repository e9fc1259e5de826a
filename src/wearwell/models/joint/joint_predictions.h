#pragma once

#include "wearwell/bayes/observation.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/models/joint/archard.h"
#include "wearwell/models/joint/joint_data.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell::joint {

/// What to tell of a joint, into `study`: the worn volume at each stage and along the history, and
/// what `[predict]` asks for: volumes at cycles to come, the life until a limit (docs/reference/joint.md).
void add_predictions(const TomlReader& root, const Archard& law, ObservationFamily family,
                     const JointData& data, PosteriorStudy& study);

}  // namespace wearwell::joint
