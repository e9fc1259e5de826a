#pragma once

#include "wearwell/models/fatigue/mean_stress.h"

namespace wearwell::fatigue {

/// A helical spring of round wire, loaded along its axis. SI.
struct HelicalSpring {
  double wire_diameter = 0;  ///< m
  double coil_diameter = 0;  ///< m, of the wire's middle
  double active_coils = 0;
  double shear_modulus = 0;  ///< Pa
};

/// Wahl's factor for curvature and direct shear, (4C - 1)/(4C - 4) + 0.615/C, where C > 1 is coil
/// diameter over wire diameter (Wahl 1963).
double wahl_factor(double index);

/// Force over deflection, N/m: G d^4/(8 D^3 n).
double spring_rate(const HelicalSpring& spring);

/// The largest shear stress in the wire at a deflection [m]: Wahl's factor x 8 F D/(pi d^3), Pa.
double shear_stress(const HelicalSpring& spring, double deflection);

}  // namespace wearwell::fatigue
