#pragma once

#include "wearwell/models/bearing/contact.h"

namespace wearwell::bearing {

/// The wear number p_a k n = A / (4 pi r^2) and its derivatives, where A is the worn cross-section.
struct WearNumber {
  double value = 0;
  double d_sigma = 0;
  double d_delta = 0;
};

/// From sigma = clearance/r > 0 and delta = depth/r >= 0, where r is the journal's radius:
///   stationary  A/r^2 of the lune (physics/circle_area.h), delta < 2
///   journal     pi (2 delta + delta^2), delta <= 1: as printed, so r is that of the worn journal
///   bushing     pi (2 (1 + sigma) delta + delta^2)
/// Throws InputError outside this range.
double wear_number(Contact contact, double sigma, double delta);
WearNumber wear_number_and_derivatives(Contact contact, double sigma, double delta);

/// The delta of a wear number, to machine precision: the inverse of `wear_number`. Throws
/// InputError for a wear number that no delta reaches (1/4 and more for stationary, above 3/4 for
/// journal).
double depth_for(Contact contact, double sigma, double wear_number);

}  // namespace wearwell::bearing
