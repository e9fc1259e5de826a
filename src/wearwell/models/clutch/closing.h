#pragma once

#include <string>
#include <vector>

#include "wearwell/models/clutch/campaign.h"

namespace wearwell::clutch {

/// When the clutch closes.
struct ClosingRule {
  double torque_on = 2;    ///< torque above which it closes, N m
  double slip_off = 0.5;   ///< slip speed below which it is closed, rad/s
  double longest_gap = 5;  ///< largest gap between two samples, in median steps of the trace
};

/// One closing found in a trace, with its fault if it has one.
struct Closing {
  Cycle cycle;
  double start = 0;  ///< time, s
  std::string flag;  ///< empty: valid. "gap", "never closes", "torque of the wrong sign"
};

/// Finds the closings in raw traces (Haramina et al. 2025, section 2.3): from the sample where the
/// torque sets in to the sample where the slip ends. omega0 is the slip speed at the first, t2 the
/// time between, Mz and Td means over time, and E = sum of Mz omega (t_i - t_{i-1}). Closings of a
/// plate are numbered from 1, including flagged ones. Flagged are those with a gap between samples,
/// those still slipping when the torque ends or the trace ends, and those with a torque below
/// -torque_on. Throws InputError if time does not ascend within a plate.
std::vector<Closing> find_closings(const std::vector<Sample>& samples,
                                   const ClosingRule& rule = {});

}  // namespace wearwell::clutch
