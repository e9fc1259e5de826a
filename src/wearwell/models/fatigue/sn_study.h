#pragma once

#include "wearwell/input/source.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/models/fatigue/sn_law.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell {

/// Reads `model = "sn"` (docs/reference/fatigue.md) into `study`, whose general parts are read already.
void read_sn_study(const TomlReader& root, const Source& source, PosteriorStudy& study);

/// The law that [formula], [likelihood] and [conditions] of it choose. Throws InputError.
fatigue::SnLaw read_sn_law(const TomlReader& root);

}  // namespace wearwell
