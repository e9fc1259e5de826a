#pragma once

#include "wearwell/infer/maximize.h"
#include "wearwell/infer/profile.h"

namespace wearwell {

/// A maximum of any density, in a box; `unit` > 0 is about the possible change of each variable.
struct ProfiledMaximum {
  Eigen::VectorXd position;
  double value = 0;
  Eigen::VectorXd unit;
  Box box;
};

/// The profile-likelihood interval (infer/profile.h) of one variable of a density, or of a quantity.
ProfileInterval profile_interval(const LogDensity& density, const ProfiledMaximum& maximum,
                                 Eigen::Index variable, double level);
ProfileInterval profile_interval(const LogDensity& density, const ProfiledMaximum& maximum,
                                 const ProfiledQuantity& quantity, double level);

}  // namespace wearwell
