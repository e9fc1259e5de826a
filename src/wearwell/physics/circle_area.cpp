#include "wearwell/physics/circle_area.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "wearwell/base/error.h"

namespace wearwell {
namespace {

using std::numbers::pi;

/// z - atan(z) for z >= 0 without cancellation: z^3/3 - z^5/5 + ...
double less_atan(double z) {
  if (z > 0.3) return z - std::atan(z);
  const double u = z * z;
  double sum = 0;
  for (int power = 27; power >= 3; power -= 2) sum = 1. / power - u * sum;
  return z * u * sum;
}

/// The four factors of the sixteenfold squared area of the triangle between the two centers and a
/// corner of the lune (Heron). No subtraction except 2 - delta, which is the height of the lens
/// that stays inside.
struct Triangle {
  double a, b, p, q;
  double tan_half_beta;

  Triangle(double sigma, double delta)
      : a(delta),
        b(2 - delta),
        p(2 * sigma + delta),
        q(2 + 2 * sigma + delta),
        tan_half_beta(std::sqrt(a * b / (p * q))) {}
};

void check(double sigma, double delta) {
  if (!(sigma >= 0) || std::isinf(sigma) || std::isnan(delta)) {
    throw InputError(fmt::format(
        "no lune with clearance {} and depth {} (in pin radii); the clearance must be 0 or more",
        sigma, delta));
  }
}

double area_of(const Triangle& t, double sigma, double delta) {
  const double y = t.tan_half_beta;
  // Two forms of one area; each has only terms that do not cancel on its side of delta = 1.
  if (delta <= 1) {
    return t.a * y / t.b * (4 + sigma * (6 - 2 * delta) - delta * delta / 2) +
           2 * (sigma * (2 + sigma) * less_atan(y) - less_atan(y * t.p / t.b));
  }
  const double gamma = 2 * std::atan2(y * t.p, t.b);
  return gamma + y / 2 * (4 * sigma * (delta - 1) + delta * (2 + delta)) +
         2 * sigma * (2 + sigma) * less_atan(y);
}

double chord_of(const Triangle& t, double sigma, double delta) {
  return t.tan_half_beta * t.p * t.q / (sigma + delta);
}

}  // namespace

double lune_area(double sigma, double delta) {
  check(sigma, delta);
  if (delta <= 0) return 0;
  if (delta >= 2) return pi;
  return area_of(Triangle(sigma, delta), sigma, delta);
}

double lune_chord(double sigma, double delta) {
  check(sigma, delta);
  if (delta <= 0 || delta >= 2) return 0;
  return chord_of(Triangle(sigma, delta), sigma, delta);
}

Lune lune(double sigma, double delta) {
  check(sigma, delta);
  if (delta <= 0) return {};
  if (delta >= 2) return {.area = pi, .alpha = pi};
  const Triangle t(sigma, delta);
  const double y = t.tan_half_beta;
  Lune result;
  result.area = area_of(t, sigma, delta);
  result.d_sigma = -4 * (1 + sigma) * (y * y * y / (1 + y * y) - less_atan(y));
  result.d_delta = chord_of(t, sigma, delta);
  result.half_chord = result.d_delta / 2;
  result.alpha = 2 * std::atan2(y * t.q, t.b);
  result.beta = 2 * std::atan(y);
  return result;
}

double area_outside(double pin_radius, double bushing_radius, double centre_distance) {
  if (!(pin_radius > 0) || !(bushing_radius > pin_radius) || std::isinf(bushing_radius)) {
    throw InputError(
        fmt::format("pin radius {} and bushing radius {}: the pin's must be positive and smaller",
                    pin_radius, bushing_radius));
  }
  if (!(centre_distance >= 0)) {
    throw InputError(
        fmt::format("distance {} between the centers must be 0 or more", centre_distance));
  }
  // Both differences are exact if they are small (Sterbenz), so no digit of the input is lost.
  const double clearance = bushing_radius - pin_radius;
  const double depth = centre_distance - clearance;
  return pin_radius * pin_radius * lune_area(clearance / pin_radius, depth / pin_radius);
}

}  // namespace wearwell
