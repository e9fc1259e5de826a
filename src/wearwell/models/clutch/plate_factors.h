#pragma once

#include "wearwell/models/clutch/run_in.h"

namespace wearwell::clutch {

/// The scatter of plate factors: RunInFit::plate_sd, and each plate's posterior expectation. The
/// prior of the scatter is flat (Gelman 2006), and it is integrated out on a grid: with a dozen
/// plates the maximum-likelihood scatter is often 0 while a few percent are equally credible.
void shrink_factors(RunInFit& fit);

}  // namespace wearwell::clutch
