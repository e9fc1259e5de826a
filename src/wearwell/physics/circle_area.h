#pragma once

namespace wearwell {

/// The part of a pin's circle outside the circle of its bushing: a lune. Lengths are in pin radii:
/// pin radius 1, bushing radius 1 + sigma (sigma: radial clearance), centers sigma + delta apart
/// (delta: depth of penetration). circle_area.md derives every formula.
struct Lune {
  double area = 0;
  double d_sigma = 0;     ///< of the area, at constant delta
  double d_delta = 0;     ///< of the area, at constant sigma: the chord, 2 half_chord
  double alpha = 0;       ///< half angle of the lune seen from the pin's center, 0 to pi
  double beta = 0;        ///< the same from the bushing's center
  double half_chord = 0;  ///< sin(alpha): half the width of the lune's opening while alpha <= pi/2
};

/// For sigma >= 0 and any delta: nothing is outside for delta <= 0, the whole pin for delta >= 2.
/// Relative error below 1e-13 in the area and its derivatives. Throws InputError for a negative
/// sigma or NaN.
Lune lune(double sigma, double delta);

/// The area of `lune` only, in half the time, and its chord only: the derivative by delta.
double lune_area(double sigma, double delta);
double lune_chord(double sigma, double delta);

/// Area of the pin outside the bushing, any one unit of length: 0 if the pin lies inside, its full
/// area if it lies fully outside. Throws InputError unless 0 < pin_radius < bushing_radius and
/// centre_distance >= 0.
double area_outside(double pin_radius, double bushing_radius, double centre_distance);

}  // namespace wearwell
