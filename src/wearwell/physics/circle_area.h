#pragma once

namespace wearwell {

/// The part of a pin's circle that lies outside the circle of its bushing: a lune. Lengths are in
/// pin radii: pin radius 1, bushing radius 1 + sigma (sigma: radial clearance), centres sigma +
/// delta apart (delta: depth of penetration). circle_area.md derives every formula.
struct Lune {
  double area = 0;
  double d_sigma = 0;     ///< of the area, at constant delta
  double d_delta = 0;     ///< of the area, at constant sigma: the chord, 2 half_chord
  double alpha = 0;       ///< half angle of the lune seen from the pin's centre, 0 to pi
  double beta = 0;        ///< the same from the bushing's centre
  double half_chord = 0;  ///< sin(alpha): half the width of the lune's opening while alpha <= pi/2
};

/// For sigma >= 0 and any delta: nothing is outside for delta <= 0, the whole pin for delta >= 2.
/// Relative error below 1e-13 in the area and its derivatives. Throws InputError for a negative
/// sigma or one that is no number.
Lune lune(double sigma, double delta);

/// The area of `lune` alone, in half the time, and its chord alone: the derivative by delta.
double lune_area(double sigma, double delta);
double lune_chord(double sigma, double delta);

/// Area of the pin outside the bushing, any one unit of length: 0 when the pin lies inside, its
/// full area when it lies fully outside. Throws InputError unless 0 < pin_radius < bushing_radius
/// and centre_distance >= 0.
double area_outside(double pin_radius, double bushing_radius, double centre_distance);

}  // namespace wearwell
