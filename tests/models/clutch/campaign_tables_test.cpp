// A rig's tables as they are: headings of its own, plates that have names, cycles that the log lost.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <random>

#include "models/clutch/sample_campaign.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/models/clutch/clutch_describe.h"
#include "wearwell/models/clutch/clutch_study.h"
#include "wearwell/models/clutch/clutch_tables.h"
#include "wearwell/models/clutch/missing_cycles.h"
#include "wearwell/models/clutch/wear_points.h"

namespace wearwell::clutch {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::SizeIs;

constexpr const char* rest_of_study =
    "\n[lining]\ndensity = '2.2 g/cm^3'\ndepth = '1 mm'\narea = '100 cm^2'\n[balance]\nsd = '1 "
    "mg'\n";

class CampaignTables : public ScratchTest {
 protected:
  ClutchStudy study(const std::string& data) const {
    return read_clutch_study(
        write("study.toml", "model = \"clutch-wear\"\n" + data + rest_of_study));
  }
  std::string refused(const std::string& data) const {
    return message_of<InputError>([&] { prepare_campaign(study(data)); });
  }
  void write_campaign(const Campaign& campaign) const {
    write("design.csv", design_csv(campaign.design));
    write("cycles.csv", cycles_csv(campaign.cycles));
    write("weighings.csv", weighings_csv(campaign.weighings));
  }
  static constexpr const char* as_written =
      "[data]\ndesign = 'design.csv'\ncycles = 'cycles.csv'\nweighings = 'weighings.csv'\n";
};

/// Every 1000th cycle or so, by chance.
Campaign without_some(Campaign campaign, double share) {
  std::mt19937_64 random(7);
  std::erase_if(campaign.cycles, [&](const Cycle&) {
    return static_cast<double>(random() >> 11) * 0x1p-53 < share;
  });
  return campaign;
}

// The same campaign as a German rig writes it: other headings and units, mapped in the study.
TEST_F(CampaignTables, HeadingsAreMappedAndPlatesHaveNames) {
  Campaign campaign = paper_like_campaign().campaign;
  std::erase_if(campaign.cycles, [](const Cycle& cycle) { return cycle.plate > 3; });
  std::erase_if(campaign.weighings, [](const Weighing& each) { return each.plate > 3; });
  write_campaign(campaign);
  const auto german = [](double value) {
    std::string text = fmt::format("{:.10g}", value);
    std::replace(text.begin(), text.end(), '.', ',');
    return text;
  };
  std::string cycles = "Scheibe;Zyklus;Drehzahl;Moment (Nm);T_degC;Zeit;Energie\n;;1/min;;;s;kJ\n";
  for (const Cycle& c : campaign.cycles)
    cycles +=
        fmt::format("VIN-{};{};{};{};{};{};{}\n", c.plate, c.number, german(c.at.slip_speed / rpm),
                    german(c.at.torque), german(c.at.temperature), german(c.at.closing_time),
                    german(c.energy / 1e3));
  write("rig.csv", cycles);
  std::string weighings = "Scheibe;Zyklus;Block;Masse in mg\n";
  const std::vector<std::string> rows = [&] {
    std::vector<std::string> all;
    std::istringstream stream(weighings_csv(campaign.weighings));
    for (std::string line; std::getline(stream, line);) all.push_back(line);
    return all;
  }();
  for (std::size_t i = 0; i < campaign.weighings.size(); ++i) {
    const Weighing& w = campaign.weighings[i];
    const std::string row = rows[i + 1];
    const std::size_t from = row.find(',', row.find(',') + 1) + 1;
    weighings += fmt::format("VIN-{};{};{};{}\n", w.plate, w.cycle,
                             row.substr(from, row.rfind(',') - from), german(w.mass * 1e6));
  }
  write("balance.csv", weighings);
  const ClutchStudy plain = study(as_written);
  const ClutchStudy mapped = study(
      "[data]\ndesign = 'design.csv'\n"
      "[data.cycles]\nfile = 'rig.csv'\n[data.cycles.columns]\nplate = 'Scheibe'\ncycle = "
      "'Zyklus'\n"
      "slip_speed = 'Drehzahl'\ntorque = 'Moment'\ntemperature = 'T'\nclosing_time = 'Zeit'\n"
      "energy = 'Energie'\n"
      "[data.weighings]\nfile = 'balance.csv'\n[data.weighings.columns]\nplate = 'Scheibe'\n"
      "cycle = 'Zyklus'\nblock = 'Block'\nmass = 'Masse'\n");
  const Campaign &a = plain.campaign, &b = mapped.campaign;
  ASSERT_EQ(a.cycles.size(), b.cycles.size());
  ASSERT_EQ(a.weighings.size(), b.weighings.size());
  for (std::size_t i = 0; i < a.cycles.size(); i += 31) {
    EXPECT_EQ(a.cycles[i].plate, b.cycles[i].plate);
    for (const Input& input : inputs)
      EXPECT_NEAR(a.cycles[i].at.*input.value / (b.cycles[i].at.*input.value), 1, 1e-8);
    EXPECT_NEAR(a.cycles[i].energy / b.cycles[i].energy, 1, 1e-8);
  }
  for (std::size_t i = 0; i < a.weighings.size(); ++i)
    EXPECT_NEAR(a.weighings[i].mass / b.weighings[i].mass, 1, 1e-8);
  EXPECT_TRUE(a.plate_names.empty());
  EXPECT_EQ(b.plate_name(2), "VIN-2");
  EXPECT_THAT(mapped.layouts[1].text,
              HasSubstr("semicolons, decimal comma, units in the row below"));
  EXPECT_EQ(mapped.data_columns[5].name, "cycles.slip_speed");
  EXPECT_EQ(mapped.data_columns[5].unit.text, "1/min");
  // Another language of the weighings' plates is a plate that was never run.
  EXPECT_THAT(
      refused("[data]\ndesign = 'design.csv'\ncycles = 'cycles.csv'\n[data.weighings]\nfile = "
              "'balance.csv'\n[data.weighings.columns]\nplate = 'Scheibe'\ncycle = 'Zyklus'\n"
              "block = 'Block'\nmass = 'Masse'\n"),
      HasSubstr("balance.csv, row 2: plate VIN-1: 0 cycles are logged"));
  EXPECT_THAT(
      refused("[data]\ndesign = 'design.csv'\nweighings = 'weighings.csv'\n[data.cycles]\nfile = "
              "'rig.csv'\n[data.cycles.columns]\nplate = 'Scheibe'\n"),
      HasSubstr("has no column 'cycle' (nearest:"));
}

TEST_F(CampaignTables, MissingCyclesAreRefusedOrFilled) {
  const Campaign& whole = paper_like_campaign().campaign;
  const Campaign lossy = without_some(whole, 1e-3);
  const std::size_t lost = whole.cycles.size() - lossy.cycles.size();
  ASSERT_GT(lost, 300u);
  write_campaign(lossy);
  EXPECT_THAT(refused(as_written), AllOf(HasSubstr("cycles are logged between the weighings at"),
                                         HasSubstr("data.missing_cycles = \"fill\" says so")));
  EXPECT_EQ(refused(std::string(as_written) + "missing_cycles = 'refuse'\n"), refused(as_written));
  // `check` says what `fit` would.
  const ClutchStudy unfilled = study(as_written);
  EXPECT_EQ(message_of<InputError>([&] { study_description(unfilled); }), refused(as_written));

  const ClutchStudy filled = study(std::string(as_written) + "missing_cycles = 'fill'\n");
  EXPECT_EQ(filled.campaign.cycles.size(), whole.cycles.size());
  EXPECT_THAT(study_description(filled),
              HasSubstr("were not logged; each counts as a copy of the previous cycle"));
  EXPECT_THAT(filled.campaign.filled, SizeIs(15));
  // What a cycle too few or too many of its kind could do to a block is its scatter over the root of
  // their number; energies of cycles of one block differ by some per cent.
  const WornBlocks a = worn_blocks(whole), b = worn_blocks(filled.campaign);
  ASSERT_EQ(a.blocks.size(), b.blocks.size());
  for (std::size_t i = 0; i < a.blocks.size(); ++i) {
    EXPECT_EQ(a.blocks[i].cycles(), b.blocks[i].cycles());
    EXPECT_NEAR(b.blocks[i].energy / a.blocks[i].energy, 1, 2e-3);
    EXPECT_NEAR(b.blocks[i].energy_before, a.blocks[i].energy_before,
                1e-3 * a.blocks[i].energy_before);
  }
}

TEST_F(CampaignTables, WhatCannotBeFilled) {
  Campaign campaign;
  const OperatingPoint at{100, 50, 170, 2};
  for (long long n = 1; n <= 100; ++n)
    campaign.cycles.push_back({1, n, at, 1e4 + static_cast<double>(n)});
  campaign.weighings = {{1, 0, 0.25, Block::start, 0, {}},
                        {1, 60, 0.2499, Block::run_in, 0, {}},
                        {1, 100, 0.2498, Block::run_in, 0, {}}};
  campaign.density = 2200;
  campaign.balance_sd = 1e-6;
  Campaign none = campaign;
  fill_missing_cycles(none);
  EXPECT_THAT(none.filled, SizeIs(0));
  EXPECT_EQ(none.cycles.size(), 100u);

  // The first of a block, its last, and one within: 2 of 60 and 1 of 40.
  Campaign some = campaign;
  std::erase_if(some.cycles,
                [](const Cycle& c) { return c.number == 1 || c.number == 30 || c.number == 100; });
  fill_missing_cycles(some);
  ASSERT_EQ(some.cycles.size(), 100u);
  EXPECT_EQ(some.cycles[0].number, 1);
  EXPECT_EQ(some.cycles[0].energy, 1e4 + 2);
  EXPECT_EQ(some.cycles[29].energy, 1e4 + 29);
  EXPECT_EQ(some.cycles[99].energy, 1e4 + 99);
  EXPECT_THAT(some.filled,
              testing::ElementsAre("plate 1: 3 of 100 cycles (3 %) were not logged; each "
                                   "counts as a copy of the previous cycle"));
  // 3 of 40 are more than can be made up.
  Campaign many = campaign;
  std::erase_if(many.cycles, [](const Cycle& c) { return c.number > 70 && c.number < 74; });
  EXPECT_THAT(
      message_of<InputError>([&] { fill_missing_cycles(many); }),
      HasSubstr("row 3: plate 1: 3 of the 40 cycles between the weighings at 60 and 100 are "
                "missing (7.5 %); at most 5 % can be filled in"));
  Campaign twice = campaign;
  twice.cycles[5].number = 5;
  EXPECT_THAT(message_of<InputError>([&] { fill_missing_cycles(twice); }),
              HasSubstr("cycles must ascend"));
}

}  // namespace
}  // namespace wearwell::clutch
