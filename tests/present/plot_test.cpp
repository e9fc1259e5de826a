#include "wearwell/present/plot.h"

#include <gmock/gmock.h>

#include <cmath>

namespace wearwell::plot {
namespace {

using testing::ElementsAre;

TEST(Plot, HoldsItsOwnData) {
  const Json spec = plot("Wear", {"Cycles"}, {"Volume"},
                         {line({{"x", {1, 2}}, {"y", {0.123456789, NAN}}}, {"#123456"})});
  const Json& layer = spec["layer"][0];
  EXPECT_EQ(layer["data"]["values"], "x,y\n1,0.123457\n2,");
  EXPECT_EQ(layer["data"]["format"]["type"], "csv");
  EXPECT_EQ(layer["encoding"]["x"]["title"], "Cycles");
  EXPECT_EQ(layer["encoding"]["y"]["title"], "Volume");
  EXPECT_EQ(layer["mark"]["stroke"], "#123456");
  EXPECT_EQ(spec["description"], "Wear");
  EXPECT_EQ(Json::parse(spec.dump()), spec);
}

// A comma in a name would make two columns of it; a point or brackets, a part of something.
TEST(Plot, AnyNameIsOneColumn) {
  const Json spec = plot("", {"x"}, {"y"},
                         {line({{"x", {1}}, {"y", {2}}, {"N.m, \"[2]\u2028", {3}}}, {"#123456"})});
  const Json& layer = spec["layer"][0];
  EXPECT_EQ(layer["data"]["values"], "x,y,N m    2  u2028\n1,2,3");
  EXPECT_EQ(layer["encoding"]["tooltip"][0]["field"], "N m    2  u2028");
}

TEST(Plot, TicksMayHaveNamesOfTheirOwn) {
  Axis y{"Share [%]", false, -3.0, 1.0};
  y.ticks = {{-2.25, "10"}, {-0.37, "50"}};
  const Json spec = plot("", {"x"}, y, {line({{"x", {1}}, {"y", {-1}}}, {"#123456"})});
  const Json& axis = spec["layer"][0]["encoding"]["y"]["axis"];
  EXPECT_THAT(axis["values"], ElementsAre(-2.25, -0.37));
  EXPECT_GE(axis["tickCount"], 2);  // fewer drop values
  EXPECT_EQ(axis["labelExpr"],
            R"(abs(datum.value-(-2.25))<1e-9?"10":abs(datum.value-(-0.37))<1e-9?"50":'')");
}

// A plot without marks is no Vega-Lite; an end that is not finite is none of JSON's numbers.
TEST(Plot, NothingToDrawIsSaid) {
  const Json spec = plot("Hazard", {"x", false, NAN, INFINITY}, {"y"}, {}, 280, true);
  ASSERT_EQ(spec["layer"].size(), 1);
  EXPECT_EQ(spec["layer"][0]["mark"]["text"], "no finite value to plot");
  EXPECT_FALSE(spec["layer"][0].contains("params"));
  EXPECT_EQ(Json::parse(spec.dump()), spec);
}

TEST(Plot, EndsThatAreNoNumbersAreLeftToTheMarks) {
  const auto scale = [](const Axis& x) {
    const Json spec = plot("", x, {"y"}, {line({{"x", {1, 2}}, {"y", {3, 4}}}, {"#123456"})});
    return spec["layer"][0]["encoding"]["x"]["scale"];
  };
  EXPECT_EQ(scale({"x", false, 0, 5})["domainMax"], 5);
  EXPECT_EQ(scale({"x", false, 0, 5})["domainMin"], 0);
  EXPECT_FALSE(scale({"x", false, -INFINITY, 5}).contains("domainMin"));
  EXPECT_FALSE(scale({"x", false, 0, NAN}).contains("domainMax"));
  EXPECT_FALSE(scale({"x", true, 0, 5}).contains("domainMin"));
}

TEST(Plot, OneLegendForAllMarks) {
  const Json spec = plot("", {"x"}, {"y"},
                         {area({{"x", {1}}, {"y", {2}}, {"y2", {1}}}, {"#aaaaaa", "band"}),
                          line({{"x", {1}}, {"y", {2}}}, {"#bbbbbb"}),
                          points({{"x", {1}}, {"y", {2}}}, {"#cccccc", "measured"}),
                          points({{"x", {3}}, {"y", {2}}}, {"#cccccc", "measured"})});
  for (const int i : {0, 2, 3}) {
    const Json& scale = spec["layer"][i]["encoding"]["color"]["scale"];
    EXPECT_THAT(scale["domain"], ElementsAre("band", "measured"));
    EXPECT_THAT(scale["range"], ElementsAre("#aaaaaa", "#cccccc"));
  }
  EXPECT_FALSE(spec["layer"][1]["encoding"].contains("color"));
}

TEST(Plot, NamesStandAtOneTwoThree) {
  const Json spec = plot("", {"Rows", false, {}, {}, {"first", "\"second\""}}, {"y"},
                         {ranges({{"x", {1, 2}}, {"y", {0, 0}}, {"y2", {1, 1}}}, {"#aaaaaa"})});
  const Json& x = spec["layer"][0]["encoding"]["x"];
  EXPECT_THAT(x["axis"]["values"], ElementsAre(1, 2));
  EXPECT_EQ(x["axis"]["labelExpr"], R"(["first","\"second\""][datum.value - 1])");
  EXPECT_THAT(x["scale"]["domain"], ElementsAre(0.5, 2.5));
}

TEST(Plot, LinesAcrossHaveOneCoordinate) {
  const Json spec =
      plot("", {"x"}, {"y"}, {vertical_line(5, {"#aaaaaa"}), horizontal_line(7, {"#aaaaaa"})});
  EXPECT_FALSE(spec["layer"][0]["encoding"].contains("y"));
  EXPECT_FALSE(spec["layer"][1]["encoding"].contains("x"));
  EXPECT_EQ(spec["layer"][1]["data"]["values"], "y\n7");
}

// A dashed line is dashed in the legend, a point has its shape, a band is a square.
TEST(Plot, LegendsLookAsTheirMarks) {
  const Json spec =
      plot("", {"x"}, {"y"},
           {line({{"x", {1}}, {"y", {2}}}, {"#aaaaaa", "all", 1, 2, true}),
            line({{"x", {1}}, {"y", {2}}}, {"#bbbbbb", "scatter"}),
            area({{"x", {1}}, {"y", {2}}}, {"#cccccc", "band"}),
            arrows({{"x", {1}}, {"y", {2}}}, "triangle-right", {"#dddddd", "run-outs"})});
  const Json& symbols = spec["layer"][0]["encoding"]["color"]["legend"]["encoding"]["symbols"];
  const std::string labels =
      R"([indexof(["all","scatter","band","run-outs"], isObject(datum) ? datum.value : datum)])";
  EXPECT_EQ(symbols["shape"]["value"]["signal"],
            R"(["stroke","stroke","square","triangle-right"])" + labels);
  EXPECT_EQ(symbols["strokeDash"]["value"]["signal"], "[[4,3],[1,0],[1,0],[1,0]]" + labels);
}

// A selection needs both axes; a line across the plot has one.
TEST(Plot, ZoomsByAMarkWithBothAxes) {
  const Json spec = plot(
      "", {"x"}, {"y"},
      {horizontal_line(7, {"#aaaaaa"}), line({{"x", {1}}, {"y", {2}}}, {"#bbbbbb"})}, 280, true);
  EXPECT_FALSE(spec["layer"][0].contains("params"));
  EXPECT_EQ(spec["layer"][1]["params"][0]["name"], "zoom");
}

TEST(Plot, PointsHaveRoomAtTheEndsOfAxes) {
  const Json with = plot("", {"x"}, {"y"}, {points({{"x", {1}}, {"y", {2}}}, {"#aaaaaa"})});
  EXPECT_EQ(with["layer"][0]["encoding"]["x"]["scale"]["padding"]["expr"], "min(6, width / 20)");
  const Json without = plot("", {"x"}, {"y"}, {line({{"x", {1}}, {"y", {2}}}, {"#aaaaaa"})});
  EXPECT_FALSE(without["layer"][0]["encoding"]["x"]["scale"].contains("padding"));
}

TEST(Plot, AHeatMapHasAScaleOfItsNumbers) {
  const Json map = heat_map({{"x", {0}}, {"x2", {1}}, {"y", {0}}, {"y2", {1}}, {"density", {25}}},
                            {"#aaaaaa"}, {"wear rate", 10, 30});
  const Json& opacity = map["encoding"]["opacity"];
  EXPECT_THAT(opacity["scale"]["domain"], ElementsAre(10, 30));
  EXPECT_EQ(opacity["legend"]["title"], "wear rate");
  EXPECT_THAT(opacity["legend"]["values"], ElementsAre(10, 15, 20, 25, 30));
}

}  // namespace
}  // namespace wearwell::plot
