#pragma once

#include "wearwell/input/source.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/models/bearing/wear_fit.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell {

namespace bearing {

/// The unknowns of a bearing study: [likelihood] and [prior]. Throws InputError.
WearModel read_wear_model(const TomlReader& root);

}  // namespace bearing

/// Reads `model = "bearing-wear"` (docs/reference/bearing.md) into `study`, whose common parts are
/// already read.
void read_bearing_study(const TomlReader& root, const Source& source, PosteriorStudy& study);

}  // namespace wearwell
