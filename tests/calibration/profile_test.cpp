// How often the intervals of worn areas from profiles hold the truth: surfaces with and without
// waves, white noise and noise that remembers from point to point, little and much of it.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "wearwell/base/rng.h"
#include "wearwell/models/bearing/profile.h"

namespace wearwell::bearing {
namespace {

using std::numbers::pi;

// 501 points 40 um apart; a parabolic groove 8 mm wide and 20 um deep in the middle.
constexpr double groove_area = 2. / 3 * 8e-3 * 20e-6;

struct Condition {
  double memory;  // autocorrelation of the noise at one point's distance
  double noise;   // m
  bool waves;
};

double waves(double x) {
  return 0.8e-6 * std::sin(2 * pi * x / 1.7e-3) + 0.5e-6 * std::sin(2 * pi * x / 0.7e-3 + 1);
}

Profile measure(const Condition& condition, bool worn, Rng& rng) {
  const double shift = worn ? 60e-6 : 0, raised = worn ? 1e-6 : 0, turned = worn ? 1e-4 : 0;
  Profile profile;
  double noise = rng.normal();
  for (int i = -250; i <= 250; ++i) {
    const double x = 40e-6 * i, at = x - shift;
    noise = condition.memory * noise +
            std::sqrt(1 - condition.memory * condition.memory) * rng.normal();
    const double groove = worn ? 20e-6 * std::max(0.0, 1 - std::pow(at / 4e-3, 2)) : 0;
    profile.position.push_back(x);
    profile.height.push_back((condition.waves ? waves(at) : 0) - groove + raised + turned * x +
                             condition.noise * noise);
  }
  return profile;
}

// 400 profiles: the standard error of a share of 90 % is 1.5 %.
TEST(ProfileCalibration, IntervalsHoldTheTruth) {
  constexpr int profiles = 400;
  for (const double memory : {0.0, 0.4, 0.7}) {
    for (const double noise : {0.2e-6, 1e-6}) {
      for (const bool features : {false, true}) {
        std::atomic<int> inside = 0;
        tbb::parallel_for(0, profiles, [&](int i) {
          Rng rng(static_cast<std::uint64_t>(i), 20261121);
          const Condition condition{memory, noise, features};
          const Profile before = measure(condition, false, rng);
          const WornArea worn = worn_area(before, measure(condition, true, rng));
          inside += std::abs(worn.area - groove_area) < worn.half_width;
        });
        const double share = 1.0 * inside / profiles;
        std::printf("memory %.1f, noise %.1f um, %s: %.1f %%\n", memory, 1e6 * noise,
                    features ? "waves" : "no features", 100 * share);
        EXPECT_GT(share, 0.86);
        EXPECT_LT(share, 0.97);
      }
    }
  }
}

}  // namespace
}  // namespace wearwell::bearing
