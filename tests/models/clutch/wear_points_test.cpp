#include "wearwell/models/clutch/wear_points.h"

#include <gmock/gmock.h>

#include <cmath>

#include "models/clutch/sample_campaign.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"

namespace wearwell::clutch {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Four cycles of 10 kJ on plate 7, weighed after two and after four.
Campaign small_campaign() {
  Campaign campaign;
  for (int i = 1; i <= 4; ++i) campaign.cycles.push_back({7, i, {200.0 + i, 50, 170, 2}, 10e3});
  campaign.weighings = {{7, 0, 0.25, Block::start, 0, {}},
                        {7, 2, 0.25 - 3e-6, Block::run_in, 0, {}},
                        {7, 4, 0.25 - 4e-6, Block::point, 17, {}}};
  campaign.density = 2000;
  campaign.balance_sd = 1e-7;
  return campaign;
}

TEST(WornBlocks, ByHand) {
  const WornBlocks result = worn_blocks(small_campaign());
  EXPECT_THAT(result.flags, IsEmpty());
  ASSERT_EQ(result.blocks.size(), 2u);
  const WornBlock& run_in = result.blocks[0];
  EXPECT_EQ(run_in.block, Block::run_in);
  EXPECT_EQ(run_in.cycles(), 2);
  EXPECT_EQ(run_in.energy_before, 0);
  EXPECT_EQ(run_in.energy, 20e3);
  EXPECT_NEAR(run_in.volume / (3e-6 / 2000), 1, 1e-9);
  EXPECT_NEAR(run_in.w / (1.5e-9 / 20e3), 1, 1e-9);
  EXPECT_NEAR(run_in.balance_sd / (std::sqrt(2) * 1e-7 / 2000 / 20e3), 1, 1e-12);
  EXPECT_EQ(run_in.mean.slip_speed, 201.5);
  const WornBlock& point = result.blocks[1];
  EXPECT_EQ(point.point, 17);
  EXPECT_EQ(point.energy_before, 20e3);
  EXPECT_EQ(point.mean.slip_speed, 203.5);
  EXPECT_NEAR(point.volume / 0.5e-9, 1, 1e-6);
}

TEST(WornBlocks, CyclesFarFromTheDesignAreNamed) {
  Campaign campaign = small_campaign();
  const auto found = [&] { return off_design(campaign, worn_blocks(campaign).blocks); };
  campaign.design = {{17, Role::model, {200, 52, 160, 2.1}}};
  EXPECT_THAT(found(), IsEmpty());
  campaign.design[0].at = {200 / rpm, 50, 443, 2};  // rpm and kelvin read as rad/s and degC
  EXPECT_THAT(found(), ElementsAre("slip_speed of point 17 is 1910 rad/s in the design, and its "
                                   "cycles ran at 203.5",
                                   "temperature of point 17 is 443 degC in the design, and its "
                                   "cycles ran at 170"));
  const Campaign& whole = paper_like_campaign().campaign;
  EXPECT_THAT(off_design(whole, worn_blocks(whole).blocks), IsEmpty());
}

// All mass that a plate loses is in its blocks, all energy and all cycles too.
TEST(WornBlocks, NothingIsLost) {
  const Campaign& campaign = paper_like_campaign().campaign;
  const WornBlocks result = worn_blocks(campaign);
  EXPECT_THAT(result.flags, IsEmpty());
  double volume = 0, energy = 0, cycles = 0, lost = 0, logged = 0;
  for (const WornBlock& block : result.blocks) {
    volume += block.volume;
    energy += block.energy;
    cycles += block.cycles();
  }
  for (const Cycle& cycle : campaign.cycles) logged += cycle.energy;
  for (std::size_t i = 0; i < campaign.weighings.size(); ++i) {
    const bool last =
        i + 1 == campaign.weighings.size() || campaign.weighings[i + 1].block == Block::start;
    if (campaign.weighings[i].block == Block::start) lost += campaign.weighings[i].mass;
    if (last) lost -= campaign.weighings[i].mass;
  }
  EXPECT_NEAR(volume * campaign.density / lost, 1, 1e-9);
  EXPECT_NEAR(energy / logged, 1, 1e-12);
  EXPECT_EQ(cycles, static_cast<double>(campaign.cycles.size()));
}

template <class Change>
std::string refused(const Change& change) {
  Campaign campaign = small_campaign();
  change(campaign);
  return message_of<InputError>([&] { worn_blocks(campaign); });
}

TEST(WornBlocks, RefusesWhatCannotBe) {
  EXPECT_THAT(refused([](Campaign& c) { c.weighings[2].cycle = 2; }),
              HasSubstr("weighings, row 3: plate 7 is weighed twice at cycle 2"));
  EXPECT_THAT(refused([](Campaign& c) { std::swap(c.weighings[1], c.weighings[2]); }),
              HasSubstr("row 3: plate 7: the weighing at cycle 2 follows that at cycle 4"));
  EXPECT_THAT(refused([](Campaign& c) { c.weighings[2].block = Block::start; }),
              HasSubstr("row 3: plate 7 starts twice"));
  EXPECT_THAT(refused([](Campaign& c) { c.weighings.erase(c.weighings.begin()); }),
              HasSubstr("row 1: plate 7: its first weighing must be that of block 'start'"));
  EXPECT_THAT(refused([](Campaign& c) { c.weighings[0].cycle = 1; }),
              HasSubstr("row 1: plate 7 starts at cycle 1"));
  EXPECT_THAT(refused([](Campaign& c) {
                c.weighings.push_back({8, 0, 0.25, Block::start, 0, {}});
                c.weighings.push_back({7, 5, 0.2, Block::run_out, 0, {}});
              }),
              HasSubstr("row 5: plate 7: its weighings are not consecutive"));
  EXPECT_THAT(refused([](Campaign& c) { c.cycles.erase(c.cycles.begin() + 1); }),
              HasSubstr("row 2: plate 7: 1 cycles are logged between the weighings at 0 and 2, "
                        "but 2 ran"));
  EXPECT_THAT(refused([](Campaign& c) { std::swap(c.cycles[1], c.cycles[2]); }),
              HasSubstr("cycles, row 3: plate 7, cycle 2 follows cycle 3"));
  EXPECT_THAT(refused([](Campaign& c) { c.cycles[2].number = 2; }),
              HasSubstr("cycles, row 3: plate 7, cycle 2 follows cycle 2"));
  EXPECT_THAT(refused([](Campaign& c) { c.cycles[3].energy = 0; }),
              HasSubstr("cycles, row 4: plate 7, cycle 4: the energy is 0 J"));
  EXPECT_THAT(refused([](Campaign& c) { c.cycles[1].plate = 8; }),
              HasSubstr("cycles, row 3: plate 7: its cycles are not consecutive"));
  EXPECT_THAT(refused([](Campaign& c) { c.weighings[2].mass = c.weighings[1].mass + 1e-6; }),
              HasSubstr("row 3: plate 7 gained 1 mg between cycles 2 and 4: more than 4 standard"));
}

TEST(WornBlocks, FlagsWhatIsOdd) {
  Campaign campaign = small_campaign();
  campaign.weighings[2].mass = campaign.weighings[1].mass + 2e-7;  // 1.4 standard deviations
  WornBlocks result = worn_blocks(campaign);
  ASSERT_EQ(result.blocks.size(), 2u);
  EXPECT_LT(result.blocks[1].w, 0) << "kept as it is";
  EXPECT_THAT(result.flags, ElementsAre(HasSubstr("gained 0.2 mg between cycles 2 and 4, within")));

  campaign = small_campaign();
  campaign.weighings.pop_back();
  campaign.cycles.push_back({9, 1, {200, 50, 170, 2}, 10e3});
  EXPECT_THAT(worn_blocks(campaign).flags,
              ElementsAre("cycles: no weighing of plate 7 follows 2 of its cycles",
                          "cycles: no weighing of plate 9 follows 1 of its cycles"));
}

}  // namespace
}  // namespace wearwell::clutch
