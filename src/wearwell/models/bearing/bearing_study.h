#pragma once

#include "wearwell/input/source.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/models/bearing/wear_fit.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell {

namespace bearing {

/// What is unknown of the bearings of a study: [likelihood] and [prior]. Throws InputError.
WearModel read_wear_model(const TomlReader& root);

}  // namespace bearing

/// Reads `model = "bearing-wear"` (docs/reference/bearing.md) into `study`, whose general parts are read
/// already.
void read_bearing_study(const TomlReader& root, const Source& source, PosteriorStudy& study);

}  // namespace wearwell
