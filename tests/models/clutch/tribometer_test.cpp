#include "wearwell/models/clutch/tribometer.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "models/clutch/sample_campaign.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"

namespace wearwell::clutch {
namespace {

using testing::HasSubstr;

// Haramina et al. (2025): at least 750 cycles and 0.3 g a point, 3 to 14 points on each of 13
// plates, run-in and run-out on each, two sequences.
TEST(Tribometer, RunsThePapersCampaign) {
  const Simulation& simulation = paper_like_campaign();
  const Campaign& campaign = simulation.campaign;
  EXPECT_EQ(simulation.plate_factors.size(), 15u);
  ASSERT_EQ(simulation.realized.size(), campaign.weighings.size());
  std::vector<int> points(16, 0), run_outs(16, 0);
  std::vector<int> numbers;
  for (std::size_t i = 1; i < campaign.weighings.size(); ++i) {
    const Weighing &before = campaign.weighings[i - 1], &after = campaign.weighings[i];
    EXPECT_EQ(simulation.realized[i].cycle, after.cycle);
    const auto plate = static_cast<std::size_t>(after.plate);
    if (after.block == Block::run_out) ++run_outs[plate];
    if (after.block != Block::point) continue;
    ++points[plate];
    numbers.push_back(after.point);
    EXPECT_GE(after.cycle - before.cycle, 750);
    const double worn = simulation.realized[i].volume - simulation.realized[i - 1].volume;
    EXPECT_GE(worn * campaign.density, 0.3e-3);
  }
  std::sort(numbers.begin(), numbers.end());
  for (int i = 0; i < 121; ++i) EXPECT_EQ(numbers[static_cast<std::size_t>(i)], i + 1);
  for (std::size_t p = 1; p <= 13; ++p) {
    EXPECT_GE(points[p], 3);
    EXPECT_LE(points[p], 14);
    EXPECT_EQ(run_outs[p], 1);
  }
  EXPECT_GE(simulation.realized.back().volume, 10e-6)
      << "a sequence ends when the plate is worn out";
}

// What the balance says of a plate is what it lost, within the balance's error: 2 weighings of
// 1 mg, rounded to 0.1 mg. 288 differences, none beyond 4.5 standard deviations, and of the right
// size together: chi2/288 within 0.75..1.3, about 3.3 of its standard deviations of sqrt(2/288).
TEST(Tribometer, BalanceErrsByItsStandardDeviation) {
  const Simulation& simulation = paper_like_campaign();
  const auto& weighings = simulation.campaign.weighings;
  double squares = 0;
  int count = 0;
  for (std::size_t i = 1; i < weighings.size(); ++i) {
    if (weighings[i].block == Block::start) continue;
    const double read = weighings[i - 1].mass - weighings[i].mass;
    const double real = (simulation.realized[i].volume - simulation.realized[i - 1].volume) *
                        simulation.campaign.density;
    const double z = (read - real) / (std::sqrt(2) * 1e-6);
    EXPECT_LT(std::abs(z), 4.5);
    squares += z * z;
    ++count;
  }
  EXPECT_NEAR(squares / count, 1, 0.27);
}

// A constant wear rate and run-in without scatter: each block wears the integral of g over it.
TEST(Tribometer, WearsByTheLaw) {
  Truth truth = paper_like_truth();
  truth.terms = {{0, 0, 0, 20 * mm3_per_MJ}};
  truth.scatter.p = {1e-6 * mm3_per_MJ, 0};
  truth.plate_sd = 0;
  truth.plates = 1;
  const Simulation simulation = simulate({{1, Role::model, {200, 50, 170, 2}}}, truth, 5);
  double energy = 0;
  std::size_t next = 0;
  for (const Realized& each : simulation.realized) {
    if (each.plate != 1) break;
    for (; next < static_cast<std::size_t>(each.cycle); ++next)
      energy += simulation.campaign.cycles[next].energy;
    if (each.cycle == 0) continue;
    // The sum over cycles takes g at the beginning of each: half a cycle of at most 25 kJ early.
    const double expected = 20 * mm3_per_MJ * truth.run_in.integral(energy);
    EXPECT_NEAR(each.volume / expected, 1, 4e-3) << each.cycle;
  }
}

TEST(Tribometer, PlatesOwnTheirStreams) {
  Truth truth = paper_like_truth();
  truth.plates = 2;
  truth.run_in_weighings = {50};
  truth.run_out_cycles = 10;
  truth.worn_out = 1e-7;
  const std::vector<DesignPoint> design = {{1, Role::model, {200, 50, 170, 2}},
                                           {2, Role::model, {250, 60, 190, 2.5}}};
  const Simulation once = simulate(design, truth, 8), again = simulate(design, truth, 8);
  ASSERT_EQ(once.realized.size(), again.realized.size());
  for (std::size_t i = 0; i < once.realized.size(); ++i)
    EXPECT_EQ(once.realized[i].volume, again.realized[i].volume);
  truth.plates = 3;  // a third plate changes nothing on the first until points are dealt
  const Simulation more = simulate(design, truth, 8);
  EXPECT_EQ(more.realized[1].volume, once.realized[1].volume);
  EXPECT_NE(simulate(design, truth, 9).realized[1].volume, once.realized[1].volume);
}

TEST(Tribometer, RefusesATruthThatCannotBe) {
  const std::vector<DesignPoint> design = {{1, Role::model, {200, 50, 170, 2}}};
  const auto refused = [&](const Truth& truth, const std::vector<DesignPoint>& points) {
    return message_of<InputError>([&] { simulate(points, truth, 1); });
  };
  Truth truth = paper_like_truth();
  truth.terms = {{0, 0, 0, -mm3_per_MJ}};
  EXPECT_THAT(refused(truth, design), HasSubstr("wear rate is -1 mm^3/MJ at"));
  truth = paper_like_truth();
  truth.scatter.p = {-1e-15, 0};
  EXPECT_THAT(refused(truth, design), HasSubstr("scatter must be positive"));
  EXPECT_THAT(refused(paper_like_truth(), {{1, Role::validation, {200, 50, 170, 2}}}),
              HasSubstr("no point of role 'model'"));
}

}  // namespace
}  // namespace wearwell::clutch
