#include "wearwell/workbench/advice_changes.h"

#include <gmock/gmock.h>

#include "wearwell/infer/fit_check.h"
#include "wearwell/infer/residual_shape.h"

namespace wearwell::workbench {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::vector<std::string> changes_of(ResidualShape shape, bool life) {
  Remedies remedies;
  remedies.life = life;
  return advised_changes(advice_on(shape, remedies));
}

TEST(AdviceChanges, OfEachShapeOfLives) {
  EXPECT_THAT(changes_of(ResidualShape::two_groups, true), ElementsAre("mixture"));
  EXPECT_THAT(changes_of(ResidualShape::short_tails, true), ElementsAre("mixture"));
  EXPECT_THAT(changes_of(ResidualShape::long_lower, true), ElementsAre("mixture", "families"));
  EXPECT_THAT(changes_of(ResidualShape::long_upper, true), ElementsAre("share", "families"));
  EXPECT_THAT(changes_of(ResidualShape::long_tails, true), IsEmpty());
}

// Readings of wear are no lives: no share of the units can fail.
TEST(AdviceChanges, OfReadings) {
  for (const ResidualShape shape :
       {ResidualShape::two_groups, ResidualShape::short_tails, ResidualShape::long_lower,
        ResidualShape::long_upper, ResidualShape::long_tails})
    EXPECT_THAT(changes_of(shape, false), IsEmpty());
}

TEST(AdviceChanges, LinesOfAStudy) {
  EXPECT_THAT(advised_changes("The scatter grows: try family = \"lognormal\", or family = "
                              "\"student-t\"."),
              ElementsAre("family lognormal", "family student-t"));
  for (const char* none : {"", "family = \"", "Try another family.", "family = lognormal"})
    EXPECT_THAT(advised_changes(none), IsEmpty()) << none;
}

}  // namespace
}  // namespace wearwell::workbench
