#include "wearwell/models/joint/work_history.h"

#include <gtest/gtest.h>

#include <cmath>

namespace wearwell::joint {
namespace {

TEST(WorkHistory, AConstantRateNeedsNoInspections) {
  const WorkHistory history({}, {}, 5.966);
  EXPECT_DOUBLE_EQ(history.work_at(20585), 20585 * 5.966);
  EXPECT_DOUBLE_EQ(history.cycles_at(20585 * 5.966), 20585);
}

TEST(WorkHistory, RunsEvenlyBetweenInspectionsInAnyOrder) {
  const WorkHistory history({300, 100}, {900, 100}, 10);
  EXPECT_DOUBLE_EQ(history.work_at(50), 50);
  EXPECT_DOUBLE_EQ(history.work_at(100), 100);
  EXPECT_DOUBLE_EQ(history.work_at(150), 300);
  EXPECT_DOUBLE_EQ(history.work_at(310), 1000);
  EXPECT_DOUBLE_EQ(history.cycles_at(300), 150);
  EXPECT_DOUBLE_EQ(history.cycles_at(1000), 310);
}

// What a limit passed before the last inspection was once extrapolated to: -70 cycles.
TEST(WorkHistory, AWorkPassedLongAgoWasReachedThen) {
  const WorkHistory history({1000, 2000}, {100, 2100}, 1);
  EXPECT_DOUBLE_EQ(history.cycles_at(30), 300);
  EXPECT_DOUBLE_EQ(history.cycles_at(0), 0);
}

TEST(WorkHistory, CyclesAndWorkAreInverseWhereWorkGrows) {
  const WorkHistory history({10, 40, 90}, {5, 200, 201}, 3.5);
  for (const double cycles : {1., 10., 17., 40., 66., 90., 91., 1e6}) {
    EXPECT_NEAR(history.cycles_at(history.work_at(cycles)), cycles, 1e-9 * cycles);
  }
}

TEST(WorkHistory, WithoutARateNothingComes) {
  const WorkHistory history({10}, {5}, {});
  EXPECT_DOUBLE_EQ(history.work_at(1e9), 5);
  EXPECT_DOUBLE_EQ(history.cycles_at(5), 10);
  EXPECT_TRUE(std::isinf(history.cycles_at(5.1)));
}

}  // namespace
}  // namespace wearwell::joint
