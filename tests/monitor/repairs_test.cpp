// Repairs in part: forecasts of a unit that goes on, and what people read about it, which is as it was measured.
#include <gmock/gmock.h>

#include "monitor/events_rig.h"

namespace wearwell::monitor {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class Repairs : public Events {
 protected:
  /// Of units that the study has: their events may come before their readings.
  Repairs() {
    source_.mapping.in_study = [](const std::string&) { return true; };
  }
  /// 1 m/h, every 20 h; a repair at reading 6 takes 60 m back.
  void send_repaired() {
    report("a", "repaired", R"("n": 6, "restored": 60)");
    for (int n = 1; n <= 10; ++n) deliver(message("a", n, 20 * n - (n >= 6 ? 60 : 0), 20 * n));
    ASSERT_EQ(view("a").doubt, "");
  }
};

// Wear at 1.2 m/h, of which a repair takes 300 m back at 500 h: the rate stays, and the limit of
// 1000 m is reached at (1000 + 300) / 1.2 h.
TEST_F(Repairs, TakeBackAPart) {
  open();
  for (int n = 1; n <= 16; ++n) {
    deliver(message("a", n, 60.0 * n - (n > 10 ? 300 : 0), 50 * n));
    deliver(message("never", n, 60.0 * n, 50 * n));
  }
  EXPECT_EQ(report("a", "repaired", R"("n": 11, "restored": 300)").events, 1U);
  const UnitView repaired = view("a"), never = view("never");
  EXPECT_EQ(repaired.doubt, "");
  EXPECT_EQ(repaired.part, 1);
  EXPECT_EQ(repaired.at, never.at);
  EXPECT_NEAR(repaired.level.q50, never.level.q50 - 300, 1e-9);
  EXPECT_NEAR(repaired.remaining.q50, 1300 / 1.2 - 800, 10);
  EXPECT_NEAR(never.remaining.q50, 1000 / 1.2 - 800, 5);
  // The past is as it was, and as it was measured.
  const UnitDetail detail = *fleet_->unit("a"), other = *fleet_->unit("never");
  EXPECT_EQ(detail.events[0].restored, 300);
  EXPECT_EQ(detail.moments[9].measured, 600);
  EXPECT_EQ(detail.moments[9].life.q50, other.moments[9].life.q50);
  EXPECT_EQ(detail.moments[10].measured, 360);
  // Also after a restart, and where the repair is known before its readings.
  catch_up();
  const std::string bits_before = bits();
  close();
  open();
  fleet_->refresh(true);
  EXPECT_TRUE(bits() == bits_before);
  report("b", "repaired", R"("n": 11, "restored": 300)");
  for (int n = 1; n <= 16; ++n) deliver(message("b", n, 60.0 * n - (n > 10 ? 300 : 0), 50 * n));
  expect_same("b", "a");
  // A new part has not been repaired.
  report("a", "replaced", R"("n": 17, "time": 800)");
  deliver(message("a", 17, 60, 850));
  deliver(message("new", 17, 60, 50));
  expect_same("a", "new");
}

// A level beyond the limit before the repair is no alarm after it, and is one without.
TEST_F(Repairs, EndALevelBeyondTheLimit) {
  open();
  for (int n = 1; n <= 10; ++n) deliver(message("a", n, 110.0 * n, 100 * n));
  EXPECT_TRUE(view("a").beyond);
  report("a", "repaired", R"("n": 11, "restored": 600)");
  EXPECT_FALSE(view("a").beyond);
  EXPECT_EQ(view("a").alarm, Alarm::ok);
  deliver(message("a", 11, 610, 1100));
  EXPECT_FALSE(view("a").beyond);
  for (int n = 12; n <= 16; ++n) deliver(message("a", n, 110.0 * n - 600, 100 * n));
  EXPECT_TRUE(view("a").beyond);
}

TEST_F(Repairs, AreRefusedWithAReason) {
  open();
  deliver(message("a", 1, 10, 10));
  EXPECT_THAT(report("a", "repaired", R"("n": 2)").problem,
              AllOf(HasSubstr("restored is missing"), HasSubstr("\"replaced\"")));
  EXPECT_THAT(report("a", "repaired", R"("n": 2, "restored": 0)").problem, HasSubstr("above 0"));
  EXPECT_THAT(report("a", "repaired", R"("n": 2, "wear": 3, "restored": 5)").problem,
              HasSubstr("what the repair takes back or what is left after it"));
  EXPECT_EQ(store_->events_after(0).size(), 0U);
}

// The path falls where the level did, also where few moments are kept, and at a repair after the last reading.
TEST_F(Repairs, AreSeenInThePath) {
  open();
  report("a", "repaired", R"("n": 32, "restored": 300)");
  for (int n = 1; n <= 33; ++n) deliver(message("a", n, 20.0 * n - (n >= 32 ? 300 : 0), 20 * n));
  catch_up();
  const auto level_at = [&](double at) {
    std::vector<double> levels;
    const UnitDetail detail = fleet_->unit("a").value();
    for (const auto& each : detail.path)
      if (each.at == at) levels.push_back(each.level.q50);
    return levels;
  };
  ASSERT_EQ(level_at(620).size(), 1U);
  ASSERT_EQ(level_at(640).size(), 1U);
  EXPECT_NEAR(level_at(620)[0], 620, 1);
  EXPECT_NEAR(level_at(640)[0], 340, 1);
  report("a", "repaired", R"("n": 34, "restored": 200)");
  catch_up();
  ASSERT_EQ(level_at(660).size(), 2U);
  EXPECT_NEAR(level_at(660)[0], 360, 1);
  EXPECT_NEAR(level_at(660)[1], 160, 1);
  EXPECT_NEAR(fleet_->unit("a")->path.back().level.q50, 1000, 50);
}

// 10 m too much: the rate is wrong by 1 % and the distance to the limit by little; 60 m look like a step.
TEST_F(Repairs, AnAmountThatIsWrongShiftsTheRate) {
  open();
  for (const int restored : {300, 310, 360}) {
    const std::string unit = std::to_string(restored);
    for (int n = 1; n <= 16; ++n) deliver(message(unit, n, 60.0 * n - (n > 10 ? 300 : 0), 50 * n));
    report(unit, "repaired", fmt::format(R"("n": 11, "restored": {})", restored));
  }
  EXPECT_NEAR(view("310").remaining.q50, view("300").remaining.q50, 4);
  EXPECT_EQ(view("310").doubt, "");
  EXPECT_NE(view("360").doubt, "");
}

// The forecast follows 140 m at 200 h; 220 m is expected with what the repair took back.
TEST_F(Repairs, ReasonsNameWhatWasMeasured) {
  open();
  send_repaired();
  deliver(message("a", 11, 300, 220));
  EXPECT_THAT(view("a").doubt,
              HasSubstr("the last reading, 300 m, lies above the forecast of 160"));
  report("a", "withdrawn", R"("n": 11)");
  for (int n = 12; n <= 18; ++n) deliver(message("a", n, 181, 240 + n));
  EXPECT_THAT(view("a").doubt, HasSubstr("readings are all 181 m: the sensor is stuck"));
}

TEST_F(Repairs, AUnitIsThatOfWhatWasMeasured) {
  open();
  send_repaired();
  for (int n = 11; n <= 13; ++n) deliver(message("a", n, 0.001 * (20 * n - 60), 20 * n));
  EXPECT_THAT(view("a").doubt, HasSubstr("after multiplication by 1000: the unit has changed"));
}

TEST_F(Repairs, AUnitOutsideItsPopulationIsAsMeasured) {
  open();
  report("a", "repaired", R"("n": 1, "restored": 60)");
  deliver(message("a", 1, 900, 200));
  EXPECT_THAT(view("a").doubt, AllOf(HasSubstr("wear of 900 m at 200 h is outside"),
                                     HasSubstr("can have there, about 140 m")));
}

// A sensor in steps of 5 m shows equal values; what is added to them has other digits.
TEST_F(Repairs, ASensorGoesOnInItsSteps) {
  open();
  report("a", "repaired", R"("n": 60, "restored": 12.37)");
  report("b", "sensor", R"("n": 60, "wear": -12.37)");
  for (int n = 1; n <= 120; ++n) {
    const double step = 5, level = n - (n >= 60 ? 12.37 : 0);
    for (const char* unit : {"a", "b"})
      deliver(message(unit, n, step * std::round(level / step), n));
  }
  EXPECT_EQ(view("a").doubt, "");
  EXPECT_EQ(view("b").doubt, "");
}

}  // namespace
}  // namespace wearwell::monitor
