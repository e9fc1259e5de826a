#pragma once

#include "wearwell/models/clutch/run_in.h"

namespace wearwell::clutch {

/// What the factors say of their own scatter: RunInFit::plate_sd, and each plate's expectation. The
/// prior of the scatter is flat (Gelman 2006), and it is integrated out on a grid: with a dozen
/// plates the most likely scatter is often 0 where a few per cent are as credible.
void shrink_factors(RunInFit& fit);

}  // namespace wearwell::clutch
