#pragma once

#include <optional>

#include "wearwell/models/bearing/wear_number.h"

namespace wearwell::bearing {

/// What to solve k = W/(F s) for, that is p_a k n = A/(4 pi r^2).
enum class Quantity {
  rate,         ///< k, m^3/(N m)
  depth,        ///< m
  pressure,     ///< allowable apparent pressure F/(2 r L), Pa
  length,       ///< required bearing length under a force, m
  revolutions,  ///< life
  time,         ///< life at a speed, s
};

/// A partially known bearing, in SI. A depth may be given as the width of its scar, a pressure as
/// force and length, revolutions as speed and time.
struct Bearing {
  Contact contact = Contact::stationary;
  std::optional<double> radius;       ///< of the journal, m
  std::optional<double> clearance;    ///< radial, m
  std::optional<double> depth;        ///< m
  std::optional<double> scar_width;   ///< stationary only, m
  std::optional<double> rate;         ///< k, m^3/(N m)
  std::optional<double> pressure;     ///< Pa
  std::optional<double> force;        ///< N
  std::optional<double> length;       ///< m
  std::optional<double> revolutions;  ///< 1
  std::optional<double> speed;        ///< rev/s
  std::optional<double> time;         ///< s
};

/// What `solve` finds (Ligterink and de Gee 1996, Tribotest 3-1, 45-54).
struct Solution {
  double value = 0;        ///< of the quantity, SI
  double sigma = 0;        ///< clearance/radius
  double delta = 0;        ///< depth/radius
  double wear_number = 0;  ///< p_a k n
};

/// The wanted quantity of a bearing, from the others. Throws InputError, naming the input, when an input is missing, given twice, not used, not
/// positive, or impossible together with the others (a depth beyond the geometry, a wear number
/// that no depth reaches).
Solution solve(Quantity wanted, const Bearing& bearing);

/// sigma, delta and wear number of a bearing with given radius, clearance and depth (or scar
/// width), and nothing else; `value` is the wear number too. Throws InputError as `solve` does.
Solution geometry(const Bearing& bearing);

/// d ln(quantity) / d ln(input) for each input given, without a unit: the percent by which the
/// quantity changes when the input grows by 1 %. Throws InputError as `solve` does.
Bearing sensitivity(Quantity wanted, const Bearing& bearing);

}  // namespace wearwell::bearing
