#pragma once

#include "wearwell/input/source.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/models/fatigue/sn_law.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell {

/// Reads `model = "sn"` (docs/reference/fatigue.md) into `study`, whose common parts are already
/// read.
void read_sn_study(const TomlReader& root, const Source& source, PosteriorStudy& study);

/// The model of [formula], [likelihood] and [conditions]. Throws InputError.
fatigue::SnLaw read_sn_law(const TomlReader& root);

}  // namespace wearwell
