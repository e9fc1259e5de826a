#include "wearwell/models/bearing/profile.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/base/rng.h"

namespace wearwell::bearing {
namespace {

using std::numbers::pi;

// A surface with waves of its own, and a parabolic groove: 8 mm wide, 20 um deep, whose area is two
// thirds of width times depth.
constexpr double groove_area = 2. / 3 * 8e-3 * 20e-6;

double waves(double x) {
  return 0.8e-6 * std::sin(2 * pi * x / 1.7e-3) + 0.5e-6 * std::sin(2 * pi * x / 0.7e-3 + 1);
}
double groove(double x) {
  return 20e-6 * std::max(0.0, 1 - std::pow(x / 4e-3, 2));
}

struct Instrument {
  double shift = 0, raised = 0, turned = 0;
  double noise = 0;
  double memory = 0;  ///< of the noise, from point to point: its autocorrelation at lag 1
};

template <class Surface>
Profile measure(const Surface& surface, const Instrument& instrument, Rng& rng) {
  Profile profile;
  double noise = rng.normal();
  for (int i = -250; i <= 250; ++i) {
    const double x = 40e-6 * i;
    noise = instrument.memory * noise +
            std::sqrt(1 - instrument.memory * instrument.memory) * rng.normal();
    profile.position.push_back(x);
    profile.height.push_back(surface(x - instrument.shift) + instrument.raised +
                             instrument.turned * x + instrument.noise * noise);
  }
  return profile;
}

WornArea measured_groove(const Instrument& first, const Instrument& second, std::uint64_t seed) {
  Rng rng(seed, 0);
  const Profile before = measure(waves, first, rng);
  return worn_area(before, measure([](double x) { return waves(x) - groove(x); }, second, rng));
}

// Without noise what is left is the interpolation of the surface: trapezoids 40 um wide.
TEST(WornArea, OfExactProfiles) {
  const WornArea worn = measured_groove({}, {0, 5e-6, 3e-4, 1e-12}, 1);
  EXPECT_NEAR(worn.area / groove_area, 1, 1e-4);
  EXPECT_NEAR(worn.offset, -5e-6, 1e-9);
  EXPECT_NEAR(worn.tilt, -3e-4, 1e-7);
  EXPECT_LT(worn.from, -4e-3);
  EXPECT_GT(worn.to, 4e-3);
}

TEST(WornArea, FindsTheShift) {
  const WornArea worn =
      measured_groove({.noise = 0.1e-6}, {.shift = 130e-6, .raised = 2e-6, .noise = 0.1e-6}, 2);
  EXPECT_NEAR(worn.shift, -130e-6, 15e-6);
  EXPECT_NEAR(worn.area, groove_area, 4 * worn.sd);
}

TEST(WornArea, ShiftsNothingWithoutFeatures) {
  Rng rng(3, 0);
  const auto flat = [](double) { return 0.0; };
  const Profile before = measure(flat, {.noise = 0.2e-6}, rng);
  const Profile after = measure([](double x) { return -groove(x); }, {.noise = 0.2e-6}, rng);
  const WornArea worn = worn_area(before, after);
  EXPECT_EQ(worn.shift, 0);
  EXPECT_NEAR(worn.area, groove_area, 4 * worn.sd);
}

// The stated interval must hold the truth as often as it says, with white noise and with noise that
// remembers, the autocorrelation of which is estimated from the flanks alone. 600 profiles: the
// standard error of a share of 90 % is 1.2 %.
TEST(WornArea, IntervalCoversTheTruth) {
  for (const double memory : {0.0, 0.7}) {
    int inside = 0;
    for (std::uint64_t seed = 0; seed < 600; ++seed) {
      const Instrument noisy{
          .shift = 60e-6, .raised = 1e-6, .turned = 1e-4, .noise = 0.2e-6, .memory = memory};
      const WornArea worn = measured_groove({.noise = 0.2e-6, .memory = memory}, noisy, seed);
      inside += std::abs(worn.area - groove_area) < worn.half_width;
    }
    EXPECT_GT(inside / 600., 0.86) << memory;
    EXPECT_LT(inside / 600., 0.97) << memory;
  }
}

// A bore of radius R worn evenly by h, over the length s of the surface: ((R + h)^2 - R^2) s/2R.
TEST(WornArea, OfACurvedSurface) {
  constexpr double radius = 10e-3, depth = 50e-6;
  Rng rng(6, 0);
  const auto flat = [](double) { return 0.0; };
  const auto step = [](double x) { return std::abs(x) < 4.02e-3 ? -depth : 0.0; };
  const Profile before = measure(flat, {.noise = 1e-12}, rng);
  const Profile after = measure(step, {.noise = 1e-12}, rng);
  const double straight = worn_area(before, after).area;
  EXPECT_NEAR(worn_area(before, after, {}, 1 / radius).area / straight, 1 + depth / (2 * radius),
              1e-6);
  EXPECT_NEAR(worn_area(before, after, {}, -1 / radius).area / straight, 1 - depth / (2 * radius),
              1e-6);
}

TEST(WornArea, SaysWhenWearReachesTheFlanks) {
  Rng rng(4, 0);
  const Profile before = measure(waves, {.noise = 0.1e-6}, rng);
  const Profile after =
      measure([](double x) { return waves(x) - groove(x); }, {.noise = 0.1e-6}, rng);
  EXPECT_LT(worn_area(before, after, 4e-3).flank_step, 4);
  EXPECT_GT(worn_area(before, after, 7e-3).flank_step, 4);
}

TEST(WornArea, RefusesImpossibleProfiles) {
  Rng rng(5, 0);
  const Profile good = measure(waves, {.noise = 0.1e-6}, rng);
  Profile turned = good, far = good, few = good;
  std::swap(turned.position[7], turned.position[8]);
  for (double& x : far.position) x += 1;
  few.position.resize(2);
  few.height.resize(2);
  const auto message = [](const Profile& a, const Profile& b, std::optional<double> flank = {}) {
    return message_of<InputError>([&] { worn_area(a, b, flank); });
  };
  EXPECT_THAT(message(turned, good), testing::HasSubstr("row 9 of the profile before"));
  EXPECT_THAT(message(good, far), testing::HasSubstr("no position in common"));
  EXPECT_THAT(message(good, few), testing::HasSubstr("the profile after has 2 points"));
  EXPECT_THAT(message(good, good, 0.1), testing::HasSubstr("a flank of 0.1 m"));
  EXPECT_THAT(message(good, good, 1e-4), testing::HasSubstr("each flank needs 20"));
}

}  // namespace
}  // namespace wearwell::bearing
