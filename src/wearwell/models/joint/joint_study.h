#pragma once

#include "wearwell/input/source.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/models/joint/joint_data.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell {

namespace joint {

/// How a volume scatters: [likelihood]. Throws InputError.
ObservationFamily read_family(const TomlReader& root);
/// Which parameters the law has: [prior].
Archard read_law(const TomlReader& root, const JointData& data);

}  // namespace joint

/// Reads `model = "archard-joint"` (docs/reference/joint.md) into `study`, whose general parts are read
/// already.
void read_joint_study(const TomlReader& root, const Source& source, PosteriorStudy& study);

}  // namespace wearwell
