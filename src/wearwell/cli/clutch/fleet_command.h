#pragma once

#include "wearwell/cli/fleet_options.h"

namespace wearwell::clutch {

/// wearwell fleet with a fitted clutch; returns the exit code. Throws InputError.
int run_clutch_fleet(const FleetOptions& options);

}  // namespace wearwell::clutch
