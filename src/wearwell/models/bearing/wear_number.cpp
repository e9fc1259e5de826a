#include "wearwell/models/bearing/wear_number.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "wearwell/base/error.h"
#include "wearwell/physics/circle_area.h"

namespace wearwell::bearing {
namespace {

using std::numbers::pi;

void check_clearance(double sigma) {
  if (!(sigma > 0) || std::isinf(sigma)) {
    throw InputError(
        fmt::format("clearance/radius is {}; a bearing needs a clearance above 0", sigma));
  }
}

void check(Contact contact, double sigma, double delta) {
  check_clearance(sigma);
  if (!(delta >= 0) || std::isinf(delta))
    throw InputError(fmt::format("depth/radius is {}; it must be 0 or more", delta));
  if (contact == Contact::stationary && delta >= 2) {
    throw InputError(fmt::format(
        "depth/radius is {}; at 2 and above the whole journal is outside the bushing's bore",
        delta));
  }
  if (contact == Contact::journal && delta > 1)
    throw InputError(
        fmt::format("depth/radius is {}; a journal cannot wear by more than 1", delta));
}

[[noreturn]] void refuse(double wear_number, const char* reason) {
  throw InputError(fmt::format("wear number p_a k n is {}; {}", wear_number, reason));
}

/// The radius of the evenly worn surface, over the journal's.
double even_radius(Contact contact, double sigma) {
  return contact == Contact::bushing ? 1 + sigma : 1;
}

/// Newton's iteration on log(area) against log(delta). That curve increases with a slope that
/// decreases from 3/2, so the iteration approaches from below without passing the root, and always
/// converges.
double stationary_depth(double sigma, double wear_number) {
  if (wear_number >= 0.25)
    refuse(wear_number, "no scar reaches 1/4, the whole section of the journal");
  if (wear_number == 0) return 0;
  const double area = 4 * pi * wear_number;
  // Start: area = 2 sigma (v - atan v) with v = tan(alpha), which holds for small sigma and delta;
  // the cube root joins v^3 = 3h for small h to v = h + pi/2 for large.
  const double h = area / (2 * sigma);
  const double v = std::cbrt(h * (3 + h * (1.5 * pi + h)));
  double delta = std::min(sigma * v * v / (1 + std::sqrt(1 + v * v)), 1.);
  for (int i = 0; i < 100; ++i) {
    const double reached = lune_area(sigma, delta);
    const double excess = std::log(reached / area);
    const double step = excess * reached / (delta * lune_chord(sigma, delta));
    delta = std::min(delta * std::exp(-step), (delta + 2) / 2);
    // The next step would be about the square of this one; near delta = 2 the curvature is larger.
    if (std::abs(step) < 1e-8 * (2 - delta) || std::abs(excess) < 4e-16) break;
  }
  return delta;
}

}  // namespace

double wear_number(Contact contact, double sigma, double delta) {
  check(contact, sigma, delta);
  const double result = contact == Contact::stationary
                            ? lune_area(sigma, delta) / (4 * pi)
                            : delta * (2 * even_radius(contact, sigma) + delta) / 4;
  if (!std::isfinite(result))
    throw InputError(fmt::format(
        "the wear number cannot be computed for clearance/radius {} and depth/radius {}", sigma,
        delta));
  return result;
}

WearNumber wear_number_and_derivatives(Contact contact, double sigma, double delta) {
  check(contact, sigma, delta);
  if (contact == Contact::stationary) {
    const Lune l = lune(sigma, delta);
    return {l.area / (4 * pi), l.d_sigma / (4 * pi), l.d_delta / (4 * pi)};
  }
  const double radius = even_radius(contact, sigma);
  return {.value = delta * (2 * radius + delta) / 4,
          .d_sigma = contact == Contact::bushing ? delta / 2 : 0,
          .d_delta = (radius + delta) / 2};
}

double depth_for(Contact contact, double sigma, double wear_number) {
  check_clearance(sigma);
  if (!(wear_number >= 0) || std::isinf(wear_number)) refuse(wear_number, "it must be 0 or more");
  if (contact == Contact::stationary) return stationary_depth(sigma, wear_number);
  if (contact == Contact::journal && wear_number > 0.75)
    refuse(wear_number, "above 3/4 the journal is completely worn");
  const double radius = even_radius(contact, sigma);
  return 4 * wear_number / (radius + std::sqrt(radius * radius + 4 * wear_number));
}

}  // namespace wearwell::bearing
