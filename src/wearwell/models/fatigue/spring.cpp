#include "wearwell/models/fatigue/spring.h"

#include <cmath>
#include <numbers>

namespace wearwell::fatigue {

double wahl_factor(double index) {
  return (4 * index - 1) / (4 * index - 4) + 0.615 / index;
}

double spring_rate(const HelicalSpring& spring) {
  return spring.shear_modulus * std::pow(spring.wire_diameter, 4) /
         (8 * std::pow(spring.coil_diameter, 3) * spring.active_coils);
}

double shear_stress(const HelicalSpring& spring, double deflection) {
  const double force = spring_rate(spring) * deflection;
  return wahl_factor(spring.coil_diameter / spring.wire_diameter) * 8 * force *
         spring.coil_diameter / (std::numbers::pi * std::pow(spring.wire_diameter, 3));
}

}  // namespace wearwell::fatigue
