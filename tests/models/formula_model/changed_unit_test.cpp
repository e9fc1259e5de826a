// Units on line that do what none did before: a rate that changes, a change of unit, a replaced part, a stuck sensor.
#include <gmock/gmock.h>

#include "calibration/changing_units.h"
#include "wearwell/base/error.h"
#include "wearwell/models/formula_model/simulated_fleet.h"
#include "wearwell/prognosis/bytes.h"

namespace wearwell::formula_model {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;

// The population of examples/fleet.
const Guides& guides() {
  static const Guides all = [] {
    std::vector<double> wear, use;
    std::vector<std::string> names;
    const SimulatedFleet fleet = simulate_fleet(1, 0);
    for (const SimulatedReading& each : fleet.learned_readings) {
      wear.push_back(each.wear);
      use.push_back(each.use);
      names.push_back(fleet.learned[each.machine].name);
    }
    return Guides(wear, use, names);
  }();
  return all;
}

// Ten readings of a guide that wears by 0.02 um/h, every 300 h.
constexpr double deviations[] = {0.8, -1.1, 0.3, 1.6, -0.7, 0.1, -1.4, 0.9, -0.2, 0.6};

WatchedGuide read(const std::function<double(int i, double wear)>& as_read, double rate = 0.02,
                  double step = 300) {
  WatchedGuide guide(guides(), "M1");
  for (int i = 1; i <= 10; ++i)
    guide.read(step * i, as_read(i, rate * step * i + deviations[i - 1]));
  return guide;
}

TEST(ChangedUnit, IsNotInDoubtIfNothingChanges) {
  const WatchedGuide guide = read([](int, double wear) { return wear; });
  EXPECT_FALSE(guide.watch.in_doubt());
  EXPECT_EQ(guide.watch.reason(), "");
  EXPECT_FALSE(guide.watch.is_beyond());
  EXPECT_LT(guide.watch.test().evidence(), 1);
}

// To 108 um at 3,000 h, where the threshold is 100 um.
TEST(ChangedUnit, WearsThreeTimesAsFast) {
  WatchedGuide guide(guides(), "M1");
  int doubted_at = 0;
  for (int i = 1; i <= 10; ++i) {
    guide.read(300 * i, 6.0 * i + (i > 6 ? 12.0 * (i - 6) : 0) + deviations[i - 1]);
    if (!doubted_at && guide.watch.in_doubt()) doubted_at = i;
    EXPECT_EQ(guide.watch.is_beyond(), i == 10) << i;
  }
  EXPECT_EQ(doubted_at, 8);  // the first one after the change is low by chance
  EXPECT_THAT(guide.watch.reason(),
              ContainsRegex("the last 4 readings lie above the forecast; the rate has changed "
                            "\\((2.9|3.0) times the earlier one\\)"));
  EXPECT_THAT(guide.watch.reason(), HasSubstr("or the sensor has"));
}

TEST(ChangedUnit, ReportsMillimetres) {
  const auto reports = [](double factor, double rate, double step) {
    return read([=](int i, double wear) { return i > 6 ? wear * factor : wear; }, rate, step);
  };
  const WatchedGuide guide = reports(0.001, 0.02, 300);
  EXPECT_TRUE(guide.watch.in_doubt());
  EXPECT_EQ(guide.watch.reason(),
            "the last 4 readings fit the forecast after multiplication by 1000: the unit has "
            "changed (such as mm in place of um)");
  EXPECT_FALSE(guide.watch.is_beyond());
  // Other factors, and another guide.
  for (const auto& [factor, words] :
       {std::pair(1000.0, "by 1/1000: the unit has changed (such as um in place of mm)"),
        {10.0, "by 1/10"},
        {0.1, "by 10:"},
        {25.4, "by 1/25.4"},
        {1 / 25.4, "by 25.4: the unit has changed (such as inches"}}) {
    const WatchedGuide other = reports(factor, 0.031, 220);
    EXPECT_TRUE(other.watch.in_doubt()) << factor;
    EXPECT_THAT(other.watch.reason(), HasSubstr(words));
  }
}

// From the first reading on, where no earlier reading contradicts; and a new part on the counter of an earlier one.
// Deviations four times as large as the population's, before and after.
TEST(ChangedUnit, ReportsMillimetresThoughItScattersMoreThanOthers) {
  for (const auto& [factor, words] : {std::pair(1000.0, "by 1/1000: the unit has changed"),
                                      {0.001, "by 1000: the unit has changed"}}) {
    WatchedGuide guide(guides(), "M1");
    for (int i = 1; i <= 13; ++i) {
      const double wear = 6.0 * i + 4 * deviations[(i - 1) % 10];
      guide.read(300 * i, i > 8 ? factor * wear : wear);
    }
    EXPECT_THAT(guide.watch.reason(), HasSubstr(words));
  }
}

TEST(ChangedUnit, IsNoneOfItsPopulation) {
  WatchedGuide metres(guides(), "M1");
  metres.read(300, 6.4 * 1000);
  EXPECT_THAT(metres.watch.reason(), ContainsRegex("400 um at 300 h is outside what such a machine "
                                                   "can have there, about 7.[012][0-9] um; after"));
  EXPECT_THAT(metres.watch.reason(),
              HasSubstr("after multiplication by 1/1000 it fits: the unit is "
                        "not that of the study (such as um in place of mm)"));

  WatchedGuide later(guides(), "M1");
  later.read(20'300, 6.4);
  EXPECT_THAT(later.watch.reason(), HasSubstr("the counter of use is not that of the study"));
}

// Five machines do not exclude one that wears a tenth as fast, but its readings scatter a tenth as much, too. A sensor
// that averages is right.
TEST(ChangedUnit, ReadsInAnotherUnitFromTheFirstReadingOn) {
  Rng rng(3, 0);
  const Guides few(5, rng);
  ASSERT_TRUE(few.tracker);
  const auto doubted_at = [&](double factor, double noise, std::string& reason) {
    WatchedGuide guide(few, "new");
    for (int i = 1; i <= 20; ++i) {
      guide.read(150 * i, factor * (3.0 * i + noise * deviations[i % 10]));
      reason = guide.watch.reason();
      if (!reason.empty()) return i;
    }
    return 0;
  };
  std::string reason;
  for (const auto& [factor, words] :
       {std::pair(0.001, "by 1000: the unit is not that of the study (such as mm in place of um)"),
        {1e-6, "by 1000000: the unit is not that of the study (such as m in place of um)"},
        {1e-4, "by 10000: the unit is not that of the study (such as cm in place of um)"},
        {0.01, "by 100:"},
        {0.1, "by 10:"},
        {1 / 25.4, "by 25.4:"},
        {10.0, "by 1/10"},
        {1000.0, "by 1/1000"}}) {
    const int at = doubted_at(factor, 1, reason);
    EXPECT_GE(at, 1) << factor;
    EXPECT_LE(at, 8) << factor;
    EXPECT_THAT(reason, HasSubstr(words)) << factor;
  }
  for (const double noise : {1.0, 0.1, 0.0})
    EXPECT_EQ(doubted_at(1, noise, reason), 0) << noise << reason;
}

// Doubt lasts as long as what caused it, although the forecast follows the readings.
TEST(ChangedUnit, StaysInDoubtUntilItsReadingsAreAsBefore) {
  const auto last = [](const std::function<double(int)>& off) {
    WatchedGuide guide(guides(), "M1");
    bool doubted = false, ended = false;
    for (int i = 1; i <= 45; ++i) {
      guide.read(100 * i, 2.0 * i + deviations[i % 10] + off(i));
      doubted |= guide.watch.in_doubt();
      ended |= doubted && !guide.watch.in_doubt();
    }
    EXPECT_TRUE(doubted);
    return !ended;
  };
  EXPECT_TRUE(last([](int i) { return i > 12 ? -24.0 : 0.0; }));   // reset to zero
  EXPECT_TRUE(last([](int i) { return i > 12 ? -15.0 : 0.0; }));   // a step
  EXPECT_FALSE(last([](int i) { return i == 12 ? 30.0 : 0.0; }));  // one wrong reading
}

TEST(ChangedUnit, IsReplaced) {
  for (const auto& [rate, step] : {std::pair(0.02, 300.0), {0.027, 250.0}, {0.014, 500.0}}) {
    const WatchedGuide guide =
        read([rate = rate, step = step](
                 int i, double wear) { return i > 6 ? wear - rate * step * 6 : wear; },
             rate, step);
    EXPECT_TRUE(guide.watch.in_doubt());
    EXPECT_THAT(guide.watch.reason(), HasSubstr("the last 4 readings lie below the forecast and "
                                                "fit a new machine: the part was replaced"));
  }
}

TEST(ChangedUnit, IsStuck) {
  for (const double value : {6.0, 7.35, 4.1}) {
    const WatchedGuide guide = read([=](int, double) { return value; });
    EXPECT_TRUE(guide.watch.in_doubt()) << value << " " << guide.watch.test().evidence();
    EXPECT_THAT(guide.watch.reason(), HasSubstr("the last 10 readings are all"));
    EXPECT_THAT(guide.watch.reason(), HasSubstr("the sensor is stuck"));
  }
  // Later, and to a coarse sensor two equal readings are nothing.
  const WatchedGuide late =
      read([](int i, double wear) { return i > 5 ? 30.25 : changing::round_to(wear, 0.01); });
  EXPECT_THAT(late.watch.reason(),
              HasSubstr("the last 5 readings are all 30.25 um: the sensor is stuck"));
  const WatchedGuide coarse =
      read([](int, double wear) { return changing::round_to(wear, 5); }, 0.008);
  EXPECT_FALSE(coarse.watch.in_doubt()) << coarse.watch.reason();
}

TEST(ChangedUnit, Steps) {
  const WatchedGuide guide = read([](int i, double wear) { return i > 5 ? wear - 14 : wear; });
  EXPECT_TRUE(guide.watch.in_doubt());
  EXPECT_THAT(guide.watch.reason(), HasSubstr("the last 5 readings lie 1"));
  EXPECT_THAT(guide.watch.reason(),
              HasSubstr("below the forecast, all by about the same amount: a step"));
}

TEST(ChangedUnit, GoesBack) {
  WatchedGuide guide = read([](int, double wear) { return wear; });
  guide.read(50, 1.2);
  EXPECT_EQ(
      guide.watch.reason(),
      "use goes back from 3\u202f000 h to 50 h: the counter was reset, or the machine replaced");
  guide.read(3300, 66);
  EXPECT_FALSE(guide.watch.in_doubt());
}

TEST(ChangedUnit, OneWrongReadingPasses) {
  WatchedGuide guide = read([](int i, double wear) { return i == 10 ? wear + 40 : wear; });
  EXPECT_TRUE(guide.watch.in_doubt());
  EXPECT_THAT(guide.watch.reason(),
              HasSubstr("the last reading, 100.6 um, lies above the forecast of "));
  EXPECT_TRUE(guide.watch.is_beyond());
  int more = 0;
  for (; guide.watch.in_doubt() && more < 60; ++more)
    guide.read(3300 + 300 * more, 66 + 6 * more + deviations[more % 10]);
  EXPECT_LT(more, 40);
  EXPECT_FALSE(guide.watch.is_beyond() && more == 0);
}

TEST(ChangedUnit, IsTheSameFromASavedState) {
  const auto as_read = [](int i) {
    return 6.0 * i + (i > 6 ? 12.0 * (i - 6) : 0) + deviations[i - 1];
  };
  // The readings of the second unit are in cm from the first on.
  for (const auto& [cut, factor] : {std::pair(1, 1.0),
                                    {2, 1.0},
                                    {3, 1.0},
                                    {4, 1.0},
                                    {5, 1.0},
                                    {6, 1.0},
                                    {7, 1.0},
                                    {8, 1.0},
                                    {9, 1.0},
                                    {3, 0.1},
                                    {4, 0.1},
                                    {5, 0.1},
                                    {6, 0.1},
                                    {7, 0.1}}) {
    WatchedGuide whole(guides(), "M1"), again(guides(), "M1");
    for (int i = 1; i <= 10; ++i) {
      whole.read(300 * i, factor * as_read(i));
      again.read(300 * i, factor * as_read(i));
      if (i != cut) continue;
      prognosis::ByteWriter to;
      again.watch.save(to);
      const std::string bytes = to.take();
      prognosis::ByteReader from(bytes, "state");
      again.watch = {};
      again.watch.load(from, *guides().tracker);
      from.end();
      again.unit = guides().tracker->restore(again.unit->save());
    }
    prognosis::ByteWriter a, b;
    whole.watch.save(a);
    again.watch.save(b);
    EXPECT_EQ(a.take(), b.take()) << cut;
  }
}

}  // namespace
}  // namespace wearwell::formula_model
