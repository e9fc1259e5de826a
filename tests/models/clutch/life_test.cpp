#include "wearwell/models/clutch/life.h"

#include <gmock/gmock.h>

#include <cmath>

#include "models/clutch/sample_campaign.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"

namespace wearwell::clutch {
namespace {

using testing::HasSubstr;

const OperatingPoint middle{200, 50, 170, 2};
const std::vector<Cycle> duty = {{1, 1, middle, 10e3}};

// Haramina et al. (2025), section 3.6: n_x = x V_total/V_mu1, relative interval 2 w_sigma/(w_mu
// sqrt(n_x)). V_mu1 = 20 mm^3/MJ * 0.01 MJ = 0.2 mm^3, V_total = 10,000 mm^3.
TEST(Life, ClosedFormWithoutRunIn) {
  const WearModel model = constant_model(20 * mm3_per_MJ, 100 * mm3_per_MJ, {0, 0, 1, 1});
  const Life life = predict_life(model, duty, {0.1, 1});
  EXPECT_NEAR(life.volume / 0.2e-9, 1, 1e-12);
  EXPECT_NEAR(life.sd / 1e-9, 1, 1e-12);
  ASSERT_EQ(life.levels.size(), 2u);
  EXPECT_NEAR(life.levels[0].repetitions, 5000, 1e-6);
  EXPECT_NEAR(life.levels[0].without_run_in, 5000, 1e-8);
  EXPECT_NEAR(life.levels[0].relative, 2 * 5 / std::sqrt(5000), 1e-9);
  EXPECT_NEAR(life.levels[1].repetitions, 50'000, 1e-5);
  EXPECT_NEAR(life.levels[1].relative, 2 * 5 / std::sqrt(50'000), 1e-9);
  EXPECT_NEAR(life.levels[1].full_relative, life.levels[1].relative, 1e-12)
      << "nothing else is uncertain";
  EXPECT_EQ(life.outside, 0u);
}

// The same number of cycles as summing one by one until the level is reached; g is taken at the
// beginning of each cycle there, which is worth less than one cycle of the fast mode.
TEST(Life, AgreesWithTheSumOfCycles) {
  const RunIn run_in{0.4, 4, 78e6, 6e6};
  const WearModel model = constant_model(20 * mm3_per_MJ, 100 * mm3_per_MJ, run_in);
  const Life life = predict_life(model, duty, {0.05, 0.5, 1});
  double volume = 0, energy = 0;
  int n = 0;
  for (const LifeAtLevel& at : life.levels) {
    while (volume < at.level * 10e-6) {
      volume += run_in.g(energy) * 20 * mm3_per_MJ * 10e3;
      energy += 10e3;
      ++n;
    }
    EXPECT_NEAR(at.repetitions, n, 4);
    EXPECT_LT(at.repetitions, at.without_run_in);
  }
}

// A duty of two different cycles wears per repetition what both wear.
TEST(Life, OfADutyOfSeveralCycles) {
  WearModel model = constant_model(20 * mm3_per_MJ, 100 * mm3_per_MJ, {0, 0, 1, 1});
  model.plate_sd = 0.05;
  model.replicates = {{{1, 1, {{0, 0, 0, 22 * mm3_per_MJ}}}, {0, 0, 1, 1}},
                      {{1, 1, {{0, 0, 0, 18 * mm3_per_MJ}}}, {0, 0, 1, 1}}};
  const OperatingPoint hot{200, 50, 300, 2};
  const Life life = predict_life(model, {{1, 1, middle, 10e3}, {1, 2, hot, 30e3}}, {1});
  EXPECT_NEAR(life.energy, 40e3, 1e-9);
  EXPECT_NEAR(life.volume / 0.8e-9, 1, 1e-12);
  EXPECT_NEAR(life.sd / (std::sqrt(10.0) * 1e-9), 1, 1e-12);
  EXPECT_EQ(life.outside, 4u) << "the temperature";
  const LifeAtLevel& at = life.levels[0];
  EXPECT_NEAR(at.repetitions, 12'500, 1e-5);
  // Replicates are off by 10 % either way, plates by 5 %.
  const double scatter = std::sqrt(12'500 * 10.0) * 1e-9;
  EXPECT_NEAR(at.full_sd / std::sqrt(scatter * scatter + 1e-12 + 0.25e-12), 1, 1e-9);
}

TEST(Life, RefusesWhatHasNone) {
  const WearModel model = constant_model(20 * mm3_per_MJ, 0, {0, 0, 1, 1});
  const auto refused = [](const WearModel& m, const std::vector<Cycle>& d, double level) {
    return message_of<InputError>([&] { predict_life(m, d, {level}); });
  };
  EXPECT_THAT(refused(model, {}, 1), HasSubstr("at least one cycle"));
  EXPECT_THAT(refused(model, duty, 0), HasSubstr("must be positive"));
  EXPECT_THAT(refused(constant_model(0, 0, {0, 0, 1, 1}), duty, 1), HasSubstr("no wear"));
}

}  // namespace
}  // namespace wearwell::clutch
