#pragma once

#include <string>

#include "wearwell/models/clutch/operating_point.h"

namespace wearwell::clutch {

/// What the next operating points are to determine: a wear rate or a life at a point.
struct PointGoal {
  bool is_life = false;
  OperatingPoint at;
  std::string text;  ///< of `at`, as written
};

/// "wear rate at POINT" or "life at POINT", POINT like "slip_speed = 1700 rpm, torque = 50 N m,
/// temperature = 170 degC, closing_time = 2.15 s". Throws InputError that names what is unknown,
/// missing or given twice.
PointGoal read_point_goal(const std::string& text);

}  // namespace wearwell::clutch
