#pragma once

#include "wearwell/input/source.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/models/joint/joint_data.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell {

namespace joint {

/// The scatter of a volume: [likelihood]. Throws InputError.
ObservationFamily read_family(const TomlReader& root);
/// The parameters of the model: [prior].
Archard read_law(const TomlReader& root, const JointData& data);

}  // namespace joint

/// Reads `model = "archard-joint"` (docs/reference/joint.md) into `study`, whose common parts are
/// already read.
void read_joint_study(const TomlReader& root, const Source& source, PosteriorStudy& study);

}  // namespace wearwell
