#pragma once

#include "wearwell/base/monitor.h"
#include "wearwell/input/source.h"
#include "wearwell/study/result.h"
#include "wearwell/study/study.h"

namespace wearwell::prognosis {

/// The result of a study that was read from `source`, with state.bin among its files if it has a
/// posterior: what `wearwell fit` writes. Throws like Study::run and carried_source.
Result carried_run(const Source& source, const Study& study, const RunOptions& options,
                   const Monitor& monitor);

}  // namespace wearwell::prognosis
