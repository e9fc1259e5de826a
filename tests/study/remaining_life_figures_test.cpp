#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>

#include "wearwell/study/figures.h"

namespace wearwell {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

// Unit i of n has about 10 (n - i) h: the last is the most urgent.
PosteriorSummary fleet(std::size_t units, bool alike = true) {
  PosteriorSummary result;
  for (std::size_t i = 0; i < units; ++i) {
    QuantitySummary each;
    each.name = "remaining useful life";
    each.of = fmt::format("pump {}", i + 1);
    each.at = fmt::format("to wear = 1 mm from {} h on", alike ? 50 : 50 + i);
    each.unit = "h";
    each.is_life = true;
    const double life = 10.0 * static_cast<double>(units - i);
    each.drawn = {0.8 * life, life, 1.3 * life, 0.7 * life, 0.85 * life, life};
    result.quantities.push_back(each);
  }
  return result;
}

TEST(RemainingLifeFigures, NameUnitsMostUrgentFirst) {
  const auto figures = remaining_life_figures(fleet(3));
  ASSERT_EQ(figures.size(), 1u);
  EXPECT_EQ(figures[0].title, "Remaining useful life, most urgent first");
  EXPECT_THAT(figures[0].caption, HasSubstr("To wear = 1 mm from 50 h on"));
  // From below: the most urgent is at the top.
  const auto& y = figures[0].specification["layer"][0]["encoding"]["y"];
  EXPECT_EQ(y["axis"]["labelExpr"], R"(["pump 1","pump 2","pump 3"][datum.value - 1])");
  EXPECT_EQ(figures[0].specification["layer"][1]["data"]["values"],
            "x,y,median\n10,3,10\n20,2,20\n30,1,30");
}

TEST(RemainingLifeFigures, OfAThousandUnitsNameTheMostUrgentAndRankAll) {
  const auto figures = remaining_life_figures(fleet(1000, false));
  ASSERT_EQ(figures.size(), 2u);
  EXPECT_EQ(figures[0].title, "Remaining useful life: the 40 most urgent of 1000");
  EXPECT_THAT(figures[0].caption, HasSubstr("from where each stands now"));
  const auto& names = figures[0].specification["layer"][0]["encoding"]["y"]["axis"]["labelExpr"];
  EXPECT_THAT(names.get<std::string>(), HasSubstr("\"pump 1000\"]"));
  EXPECT_THAT(names.get<std::string>(), Not(HasSubstr("\"pump 960\"")));
  EXPECT_EQ(figures[1].title, "Remaining useful life of all 1000 units");
}

TEST(RemainingLifeFigures, ALifeWithoutEndIsCutOffAtTheAxis) {
  PosteriorSummary result = fleet(3);
  result.quantities[0].drawn.q95 = INFINITY;
  const auto figures = remaining_life_figures(result);
  const auto& x = figures[0].specification["layer"][0]["encoding"]["x"];
  EXPECT_LT(x["scale"]["domainMax"].get<double>(), 100);
  EXPECT_THAT(figures[0].specification.dump(), Not(HasSubstr("inf")));
}

TEST(RemainingLifeFigures, AreOfSeveralUnits) {
  EXPECT_THAT(remaining_life_figures(fleet(2)), IsEmpty());
  PosteriorSummary result = fleet(3);
  for (QuantitySummary& each : result.quantities) each.name = "life";
  EXPECT_THAT(remaining_life_figures(result), IsEmpty());
}

}  // namespace
}  // namespace wearwell
