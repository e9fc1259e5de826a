#include <gmock/gmock.h>

#include "models/clutch/sample_campaign.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/models/clutch/clutch_tables.h"
#include "wearwell/models/clutch/clutch_truth.h"

namespace wearwell::clutch {
namespace {

using testing::HasSubstr;

// The truth that the tests of tests/clutch write in code is that of the example.
TEST(ClutchTruth, OfTheExampleIsThatOfTheTests) {
  const Truth read = read_truth(PROJECT_SOURCE_DIR "/examples/clutch/truth.toml");
  const Truth expected = paper_like_truth();
  EXPECT_EQ(read.r, expected.r);
  EXPECT_EQ(read.q, expected.q);
  const OperatingPoint at{200, 50, 170, 2};
  EXPECT_NEAR(read.w(at) / expected.w(at), 1, 1e-12);
  EXPECT_EQ(read.terms.size(), expected.terms.size());
  EXPECT_NEAR(read.run_in.g(5e6), expected.run_in.g(5e6), 1e-12);
  EXPECT_NEAR(read.run_in.g(5e7), expected.run_in.g(5e7), 1e-12);
  EXPECT_NEAR(read.scatter.formula(1e-14, at) / expected.scatter.formula(1e-14, at), 1, 1e-12);
  EXPECT_EQ(read.plate_sd, expected.plate_sd);
  EXPECT_EQ(read.plates, expected.plates);
  EXPECT_NEAR(read.density, expected.density, 1e-9);
  EXPECT_NEAR(read.balance_sd, expected.balance_sd, 1e-18);
  EXPECT_EQ(read.run_in_weighings, expected.run_in_weighings);
  EXPECT_EQ(read.run_out_cycles, expected.run_out_cycles);
  EXPECT_EQ(read.least_cycles, expected.least_cycles);
  EXPECT_NEAR(read.least_mass, expected.least_mass, 1e-15);
  EXPECT_NEAR(read.worn_out, expected.worn_out, 1e-18);
  for (const Input& input : inputs) {
    EXPECT_NEAR(read.reference.*input.value, expected.reference.*input.value, 1e-9);
    EXPECT_NEAR(read.run_in_point.*input.value, expected.run_in_point.*input.value, 1e-9);
  }
}

class ClutchTables : public ScratchTest {};

// examples/clutch/design.csv is `wearwell clutch design` with the paper's levels.
TEST_F(ClutchTables, DesignComesBack) {
  const auto design = plan(paper_design());
  const auto read = read_design(write("design.csv", design_csv(design)));
  ASSERT_EQ(read.size(), design.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].number, design[i].number);
    EXPECT_EQ(read[i].role, design[i].role);
    for (const Input& input : inputs)
      EXPECT_NEAR(read[i].at.*input.value / (design[i].at.*input.value), 1, 1e-8);
  }
}

// A campaign through its files is the campaign.
TEST_F(ClutchTables, CampaignComesBack) {
  const Campaign& campaign = paper_like_campaign().campaign;
  const auto cycles = read_cycles(write("cycles.csv", cycles_csv(campaign.cycles)));
  const auto weighings = read_weighings(write("weighings.csv", weighings_csv(campaign.weighings)));
  ASSERT_EQ(cycles.size(), campaign.cycles.size());
  ASSERT_EQ(weighings.size(), campaign.weighings.size());
  for (std::size_t i = 0; i < cycles.size(); i += 97) {
    EXPECT_EQ(cycles[i].plate, campaign.cycles[i].plate);
    EXPECT_EQ(cycles[i].number, campaign.cycles[i].number);
    EXPECT_EQ(cycles[i].energy, campaign.cycles[i].energy);
    EXPECT_NEAR(cycles[i].at.temperature, campaign.cycles[i].at.temperature, 1e-9);
    EXPECT_NEAR(cycles[i].at.slip_speed, campaign.cycles[i].at.slip_speed, 1e-9);
  }
  for (std::size_t i = 0; i < weighings.size(); ++i) {
    EXPECT_EQ(weighings[i].block, campaign.weighings[i].block);
    EXPECT_EQ(weighings[i].point, campaign.weighings[i].point);
    EXPECT_EQ(weighings[i].sequence, campaign.weighings[i].sequence);
    EXPECT_NEAR(weighings[i].mass, campaign.weighings[i].mass, 1e-12);
  }
}

TEST_F(ClutchTables, RefusesByRow) {
  const auto weighings = [&](const std::string& rows) {
    return message_of<InputError>(
        [&] { read_weighings(write("w.csv", "plate,cycle,block,mass [g]\n" + rows)); });
  };
  EXPECT_THAT(weighings("1,0,start,250\n1,5,runin,249\n"),
              HasSubstr("row 2, column 'block': 'runin' is not a block"));
  EXPECT_THAT(weighings("1,0,start,250\n1,5,point x,249\n"), HasSubstr("'point x' is not a block"));
  EXPECT_THAT(weighings("1,0,start,-250\n"), HasSubstr("row 1, column 'mass [g]'"));
  EXPECT_THAT(weighings("1,0.5,start,250\n"),
              HasSubstr("row 1, column 'cycle': 0.5 must be a whole number of at least 0"));
  EXPECT_THAT(
      message_of<InputError>([&] {
        read_design(write("d.csv",
                          "point,role,slip_speed [rpm],torque [N m],temperature [degC],"
                          "closing_time [s]\n1,model,1200,25,120,1\n1,model,1300,25,120,1\n"));
      }),
      HasSubstr("row 2, column 'point': point 1 occurs twice"));
}

}  // namespace
}  // namespace wearwell::clutch
