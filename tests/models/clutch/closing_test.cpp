#include "wearwell/models/clutch/closing.h"

#include <gmock/gmock.h>

#include <cmath>

#include "models/clutch/sample_campaign.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"

namespace wearwell::clutch {
namespace {

using testing::HasSubstr;

// Sampled once a second: torque comes on at 1 s, slip has ended at 4 s.
const std::vector<Sample> trace = {{1, 0, 100, 0, 150}, {1, 1, 90, 10, 150}, {1, 2, 60, 20, 160},
                                   {1, 3, 30, 20, 170}, {1, 4, 0, 20, 180},  {1, 5, 0, 0, 180},
                                   {1, 6, 100, 0, 180}};

// Haramina et al. (2025), section 2.3: E = sum of M omega (t_i - t_(i-1)) over the samples after the
// first: 20*60 + 20*30 + 20*0 = 1800 J.
TEST(Closings, ByHand) {
  const auto closings = find_closings(trace);
  ASSERT_EQ(closings.size(), 1u);
  const Closing& c = closings[0];
  EXPECT_EQ(c.flag, "");
  EXPECT_EQ(c.cycle.plate, 1);
  EXPECT_EQ(c.cycle.number, 1);
  EXPECT_EQ(c.start, 1);
  EXPECT_EQ(c.cycle.at.slip_speed, 90);
  EXPECT_EQ(c.cycle.at.closing_time, 3);
  EXPECT_EQ(c.cycle.at.torque, 20);
  EXPECT_EQ(c.cycle.at.temperature, 170);
  EXPECT_EQ(c.cycle.energy, 1800);
}

// A finer trace of slip that falls evenly under a constant torque: E = M omega0 t2/2.
TEST(Closings, EnergyTendsToItsIntegral) {
  std::vector<Sample> fine;
  constexpr int steps = 20'000;
  for (int i = -10; i <= steps + 10; ++i) {
    const double share = static_cast<double>(i) / steps;
    fine.push_back(
        {1, 2 * share, 200 * std::min(1.0, 1 - share), share < 0 || share > 1 ? 0.0 : 50.0, 170});
  }
  const auto closings = find_closings(fine);
  ASSERT_EQ(closings.size(), 1u);
  const OperatingPoint& at = closings[0].cycle.at;
  EXPECT_NEAR(at.closing_time, 2 * (1 - 0.5 / 200), 1e-3);  // slip_off is 0.5 rad/s
  EXPECT_NEAR(closings[0].cycle.energy / closing_energy({200, 50, 170, 2}), 1, 2e-4);
}

// What the simulated rig logs comes back, within its noise.
TEST(Closings, OfTheSimulatedRig) {
  const Campaign& campaign = paper_like_campaign().campaign;
  const auto closings = find_closings(simulate_traces(campaign, 20, 4));
  ASSERT_EQ(closings.size(), 20u);
  for (std::size_t i = 0; i < closings.size(); ++i) {
    const Cycle &found = closings[i].cycle, &logged = campaign.cycles[i];
    EXPECT_EQ(closings[i].flag, "");
    EXPECT_EQ(found.number, logged.number);
    EXPECT_NEAR(found.at.slip_speed / logged.at.slip_speed, 1, 0.005);
    EXPECT_NEAR(found.at.closing_time / logged.at.closing_time, 1, 0.01);
    EXPECT_NEAR(found.at.temperature, logged.at.temperature, 0.5);
    EXPECT_NEAR(found.at.torque / logged.at.torque, 1, 0.02);
    EXPECT_NEAR(found.energy / logged.energy, 1, 0.03);
  }
}

std::string flag_of(std::vector<Sample> samples) {
  const auto closings = find_closings(samples);
  EXPECT_EQ(closings.size(), 1u);
  return closings.empty() ? "" : closings[0].flag;
}

TEST(Closings, FlagsWhatIsOddAndKeepsIt) {
  auto samples = trace;
  for (std::size_t i = 3; i < samples.size(); ++i) samples[i].time += 6;  // 7 steps are missing
  EXPECT_EQ(flag_of(samples), "gap");
  samples = trace;
  samples.resize(4);  // ends while it slips
  EXPECT_EQ(flag_of(samples), "never closes");
  samples = trace;
  samples[3].torque = 0;  // the torque goes off while it slips
  EXPECT_EQ(flag_of(samples), "never closes");
  samples = trace;
  for (Sample& s : samples) s.torque = -s.torque;
  EXPECT_EQ(flag_of(samples), "torque of the wrong sign");
  samples = trace;
  samples[2].torque = -20;
  EXPECT_EQ(flag_of(samples), "torque of the wrong sign");
}

// Closings are numbered by plate; a new plate ends the closing before.
TEST(Closings, OfSeveralPlates) {
  std::vector<Sample> samples;
  for (int plate = 1; plate <= 2; ++plate) {
    for (int repeat = 0; repeat < 3; ++repeat) {
      for (Sample s : trace) {
        s.plate = plate;
        s.time += 100 * repeat;
        samples.push_back(s);
      }
    }
  }
  auto closings = find_closings(samples);
  ASSERT_EQ(closings.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(closings[i].cycle.plate, i < 3 ? 1 : 2);
    EXPECT_EQ(closings[i].cycle.number, static_cast<long long>(i % 3) + 1);
    EXPECT_EQ(closings[i].flag, "") << "a pause between closings is no gap";
  }
  samples.erase(samples.begin() + 18, samples.begin() + 21);  // plate 1 stops while it slips
  closings = find_closings(samples);
  ASSERT_EQ(closings.size(), 6u);
  EXPECT_EQ(closings[2].flag, "never closes");
  EXPECT_EQ(closings[3].flag, "");
}

TEST(Closings, RefusesTimeThatStandsStill) {
  auto samples = trace;
  samples[3].time = samples[2].time;
  EXPECT_THAT(message_of<InputError>([&] { find_closings(samples); }),
              HasSubstr("row 4: time 2 s follows 2 s; it must ascend"));
  EXPECT_TRUE(find_closings({}).empty());
}

}  // namespace
}  // namespace wearwell::clutch
