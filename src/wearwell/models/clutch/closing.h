#pragma once

#include <string>
#include <vector>

#include "wearwell/models/clutch/campaign.h"

namespace wearwell::clutch {

/// When the clutch closes.
struct ClosingRule {
  double torque_on = 2;    ///< torque above which it is closing, N m
  double slip_off = 0.5;   ///< slip speed at which it is closed, rad/s
  double longest_gap = 5;  ///< between two samples, in median steps of the trace
};

/// One closing found in a trace, and what is wrong with it.
struct Closing {
  Cycle cycle;
  double start = 0;  ///< time, s
  std::string flag;  ///< empty: good. "gap", "never closes", "torque of the wrong sign"
};

/// Finds the closings in raw traces (Haramina et al. 2025, section 2.3): from the sample where the
/// torque comes on to the sample where the slip has ended. omega0 is the slip speed at the first,
/// t2 the time between, Mz and Td means over time, and E = sum of Mz omega (t_i - t_{i-1}).
/// Closings of a plate are numbered on from 1, flagged ones too: nothing is left out. Flagged are
/// those with a gap between samples, those still slipping when the torque goes off or the trace
/// ends, and those with a torque below -torque_on.
/// Throws InputError where time does not ascend within a plate.
std::vector<Closing> find_closings(const std::vector<Sample>& samples,
                                   const ClosingRule& rule = {});

}  // namespace wearwell::clutch
