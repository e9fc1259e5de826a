#pragma once

#include <optional>

#include "wearwell/base/monitor.h"
#include "wearwell/input/source.h"
#include "wearwell/study/result.h"
#include "wearwell/study/study.h"

namespace wearwell::prognosis {

/// What state.bin is to hold of a study that was read from `source`; none if it has no posterior. It
/// reads the tables again, so it belongs right behind the reading of the study. Throws like
/// carried_source.
std::optional<Source> source_to_carry(const Source& source, const Study& study);

/// The result of a study, with state.bin among its files if there is something to carry: what
/// `wearwell fit` writes. Throws like Study::run.
Result carried_run(std::optional<Source> carried, const Study& study, const RunOptions& options,
                   const Monitor& monitor);

}  // namespace wearwell::prognosis
