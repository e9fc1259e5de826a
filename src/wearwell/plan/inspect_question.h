#pragma once

#include "wearwell/plan/inspect.h"
#include "wearwell/plan/inspect_report.h"

namespace wearwell::plan {

/// A question in numbers, with the units that it is about, before anything is planned. The report
/// refers to `lives`. Throws InputError that begins with the option's name.
InspectReport read_inspect_question(const InspectQuestion& question,
                                    const prognosis::KnownLives& lives);

}  // namespace wearwell::plan
