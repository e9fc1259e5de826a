#include "wearwell/models/clutch/life.h"

#include <gmock/gmock.h>

#include <cmath>

#include "models/clutch/sample_campaign.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/models/clutch/cycle_sum.h"

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
  // n v +- 2 s sqrt(n) = T for n: a quadratic in its root.
  for (const LifeAtLevel& at : life.levels) {
    const double v = 0.2, s = 1, target = at.level * 10'000, root = std::sqrt(s * s + v * target);
    EXPECT_NEAR(at.scatter.low / std::pow((root - s) / v, 2), 1, 1e-9);
    EXPECT_NEAR(at.scatter.high / std::pow((root + s) / v, 2), 1, 1e-9);
    EXPECT_NEAR(at.full.low / at.scatter.low, 1, 1e-9);
    EXPECT_NEAR(at.full.high / at.scatter.high, 1, 1e-9);
  }
}

// Where a plate may wear at next to nothing, as far as is known, its life has no upper end.
TEST(Life, AnIntervalMayHaveNoEnd) {
  WearModel model = constant_model(20 * mm3_per_MJ, 100 * mm3_per_MJ, {0, 0, 1, 1});
  model.plate_sd = 0.1;
  const Life known = predict_life(model, duty, {1});
  EXPECT_LT(known.levels[0].full.low, known.levels[0].scatter.low);
  EXPECT_GT(known.levels[0].full.high, known.levels[0].scatter.high);
  // V (1 -+ 2 * 0.1) and little scatter beside it.
  EXPECT_NEAR(known.levels[0].full.low, 50'000 / 1.2, 300);
  EXPECT_NEAR(known.levels[0].full.high, 50'000 / 0.8, 500);
  model.plate_sd = 0.6;
  const Life unknown = predict_life(model, duty, {1});
  EXPECT_TRUE(std::isinf(unknown.levels[0].full.high));
  EXPECT_TRUE(description(unknown.levels[0].full).ends_with(" to never"));
  EXPECT_EQ(description({28520, 36700}), "28\u202f520 to 36\u202f700");
}

// A level that the recursion reaches with the last cycle of a repetition is reached then: by one
// operating point, and by a duty whose cycles differ in energy and wear. Replicates likewise.
TEST(Life, AgreesWithTheRecursion) {
  WearModel model = constant_model(20 * mm3_per_MJ, 100 * mm3_per_MJ, {0.4, 4, 78e6, 6e6});
  model.terms.push_back({"Mz", 0, 0, 1, 0, 1, 0.2 * mm3_per_MJ});
  model.replicates = {{{1, 1, {{0, 0, 0, 22 * mm3_per_MJ}}}, {0.5, 3, 60e6, 4e6}}};
  OperatingPoint harder = middle;
  harder.torque = 70;
  const std::vector<std::vector<Cycle>> duties = {
      duty, {{1, 1, middle, 90e3}, {1, 2, harder, 400e3}, {1, 3, middle, 20e3}}};
  for (const std::vector<Cycle>& each : duties) {
    const int size = static_cast<int>(each.size());
    CycleColumns columns;
    const int repetitions = 3000;
    const Eigen::Index n = size * repetitions;
    for (Eigen::ArrayXd* column : {&columns.slip_speed, &columns.torque, &columns.temperature,
                                   &columns.closing_time, &columns.energy})
      column->resize(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Cycle& cycle = each[static_cast<std::size_t>(i % size)];
      columns.plate.push_back(1);
      columns.number.push_back(static_cast<double>(i + 1));
      columns.slip_speed[i] = cycle.at.slip_speed;
      columns.torque[i] = cycle.at.torque;
      columns.temperature[i] = cycle.at.temperature;
      columns.closing_time[i] = cycle.at.closing_time;
      columns.energy[i] = cycle.energy;
    }
    CycleSum sum(model, true);
    CycleSum::Rates rates;
    CycleSum::Trace trace;
    sum.rates(columns, rates);
    sum.add(columns, rates, 0, &trace);
    for (const int whole : {1, 2, 17, 400, repetitions}) {
      const double volume = trace.volume[static_cast<std::size_t>(whole * size - 1)];
      const Life life = predict_life(model, each, {volume / model.worn_out});
      EXPECT_NEAR(life.levels[0].repetitions / whole, 1, 1e-11) << whole << " of " << size;
    }
    const PlateWear& worn = sum.plates().front();
    const Life life = predict_life(model, each, {worn.volume / model.worn_out});
    EXPECT_NEAR(life.levels[0].full_sd / worn.full_sd(model.plate_sd), 1, 1e-10);
    EXPECT_NEAR(life.levels[0].sd / worn.sd(), 1, 1e-10);
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
