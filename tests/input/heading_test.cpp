// Units where tables have them: in headings of every form, and in rows of their own.
#include "wearwell/input/heading.h"

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/input/columns.h"

namespace wearwell {
namespace {

using testing::AllOf;
using testing::DoubleEq;
using testing::ElementsAre;
using testing::HasSubstr;

class HeadingTest : public ScratchTest {
 protected:
  /// The column V of a table, as a study line names it.
  std::vector<double> read(const std::string& heading, const std::string& line, const char* si,
                           const std::string& below = "") const {
    const Table table =
        read_table(write("a.csv", "\"" + heading + "\";other\n" + below + "2;1\n3;1\n"));
    const TomlReader root = TomlReader::parse({folder() / "study.toml", line + "\n"});
    return si_numbers(table, required_column(root, "V", si, table));
  }
  std::string refused(const std::string& heading, const std::string& line, const char* si,
                      const std::string& below = "") const {
    return message_of<InputError>([&] { read(heading, line, si, below); });
  }
};

TEST_F(HeadingTest, EveryFormOfAHeading) {
  for (const std::string heading :
       {"V [mm\u00B3]", "V [mm^3]", "V(mm\u00B3)", "V (mm3)", "V / mm\u00B3", "V/mm\u00B3",
        "V in mm\u00B3", "V, mm^3", "V_mm3", "Verschlei\u00DF V [mm3]", "V_max_mm^3"})
    EXPECT_THAT(read(heading, "V = '" + heading + "'", "m^3"),
                ElementsAre(DoubleEq(2e-9), DoubleEq(3e-9)))
        << heading;
  // The study may leave the unit out of the name as well.
  EXPECT_THAT(read("V [mm^3]", "V = 'V'", "m^3"), ElementsAre(DoubleEq(2e-9), DoubleEq(3e-9)));
  EXPECT_THAT(read("k (mm^3/(N m))", "V = 'k'", "m^3/(N m)"),
              ElementsAre(DoubleEq(2e-9), DoubleEq(3e-9)));
  EXPECT_THAT(read("n / (1/min)", "V = 'n'", "rev/s"),
              ElementsAre(DoubleEq(2 / 60.), DoubleEq(0.05)));
  EXPECT_THAT(read("n / 1/min", "V = 'n'", "rev/s"),
              ElementsAre(DoubleEq(2 / 60.), DoubleEq(0.05)));
  EXPECT_THAT(read("T [\u00B0"
                   "C]",
                   "V = 'T'", "K"),
              ElementsAre(DoubleEq(275.15), DoubleEq(276.15)));
  EXPECT_THAT(read("Zyklen / 1000", "V = 'Zyklen'", "cycle"), ElementsAre(2000, 3000));
  EXPECT_THAT(read("cycles [-]", "V = 'cycles'", "cycle"), ElementsAre(2, 3));
}

TEST_F(HeadingTest, ARowBelow) {
  EXPECT_THAT(read("V", "V = 'V'", "m^3", "mm\u00B3;-\n"),
              ElementsAre(DoubleEq(2e-9), DoubleEq(3e-9)));
  EXPECT_THAT(read("V", "V = 'V'", "m^3", "[mm^3];[N]\n"),
              ElementsAre(DoubleEq(2e-9), DoubleEq(3e-9)));
  EXPECT_THAT(
      refused("V", "V = { column = 'V', unit = 'cm^3' }", "m^3", "mm^3;N\n"),
      HasSubstr("column 'V' is in mm^3 by its row of units, and cm^3 is given as its unit"));
}

TEST_F(HeadingTest, WhereStudyAndHeadingContradict) {
  EXPECT_THAT(
      refused("V [mm\u00B3]", "V = { column = 'V', unit = 'cm^3' }", "m^3"),
      AllOf(
          HasSubstr(
              "column 'V [mm\u00B3]' is in mm\u00B3 by its heading, and cm^3 is given as its unit"),
          HasSubstr("(1 mm\u00B3 is 0.001 cm^3)")));
  EXPECT_THAT(refused("cycles [kcycles]", "V = { column = 'cycles', unit = 'cycles' }", "cycle"),
              HasSubstr("in kcycles by its heading, and cycles is given as its unit"));
  EXPECT_THAT(refused("F [N]", "V = { column = 'F', unit = 'mm' }", "m"),
              HasSubstr("unit 'N' has the wrong dimension"));
  EXPECT_THAT(refused("depth_um", "V = { column = 'depth_um', unit = 'mm' }", "m"),
              HasSubstr("in um by its heading"));
  EXPECT_THAT(refused("depth (m)", "V = { column = 'depth', unit = 'mm' }", "m"),
              HasSubstr("in m by its heading"));
  // The same unit in other letters is the same.
  EXPECT_THAT(read("V [mm\u00B3]", "V = { column = 'V', unit = 'mm^3' }", "m^3"),
              ElementsAre(DoubleEq(2e-9), DoubleEq(3e-9)));
}

TEST_F(HeadingTest, WhatIsNoUnit) {
  EXPECT_THAT(read("V [corrected]", "V = { column = 'V [corrected]', unit = 'mm^3' }", "m^3"),
              ElementsAre(DoubleEq(2e-9), DoubleEq(3e-9)));
  EXPECT_THAT(read("life (N)", "V = 'life (N)'", "cycle"), ElementsAre(2, 3));
  EXPECT_THAT(read("radius_m", "V = { column = 'radius_m', unit = 'mm' }", "m"),
              ElementsAre(DoubleEq(2e-3), DoubleEq(3e-3)));
  EXPECT_THAT(read("life_10", "V = 'life_10'", "cycle"), ElementsAre(2, 3));
  EXPECT_THAT(read("life (2)", "V = 'life (2)'", "cycle"), ElementsAre(2, 3));
  // Also where any dimension is allowed: the second of its kind, not a factor of 2.
  for (const char* second : {"film_2", "film (2)", "film_10"})
    EXPECT_EQ(read_heading(second, "").unit, "") << second;
  EXPECT_EQ(read_heading("N (1000)", "").unit, "1000");
  EXPECT_THAT(refused("V [corrected]", "V = 'V'", "m^3"), HasSubstr("'corrected' is not a unit"));
  EXPECT_THAT(refused("cycles [Stk]", "V = 'cycles'", "cycle"), HasSubstr("'Stk' is not a unit"));
  EXPECT_THAT(refused("V", "V = 'V'", "m^3"),
              AllOf(HasSubstr("V: needs a unit: V = { column = \"V\", unit = \"m^3\" }"),
                    HasSubstr("or 'V [m^3]' as the heading")));
  EXPECT_THAT(refused("n [1/s]", "V = 'n'", "rev/s"), HasSubstr("write rev/s (rpm, Hz) or rad/s"));
}

// What stands in brackets is a unit or an error. A mil is 25.4 um (NIST SP 811, appendix B.8).
TEST_F(HeadingTest, BracketsAreNeverDropped) {
  for (const std::string mil : {"Wear [mil]", "Wear [mils]", "Wear (mil)", "Wear [thou]"})
    EXPECT_THAT(read(mil, "V = '" + mil + "'", "m"),
                ElementsAre(DoubleEq(2 * 25.4e-6), DoubleEq(3 * 25.4e-6)))
        << mil;
  for (const std::string micrometre :
       {"Wear [mikron]", "Wear [Mikron]", "Wear (microns)", "Wear [Mikrometer]"})
    EXPECT_THAT(read(micrometre, "V = '" + micrometre + "'", "m"),
                ElementsAre(DoubleEq(2e-6), DoubleEq(3e-6)))
        << micrometre;
  EXPECT_THAT(read("Wear [um] (left)", "V = 'Wear [um] (left)'", "m"),
              ElementsAre(DoubleEq(2e-6), DoubleEq(3e-6)));
  EXPECT_THAT(refused("Wear [left]", "V = 'Wear'", "m"),
              AllOf(HasSubstr("column 'Wear [left]': 'left' is not a unit (expected one like 'm'"),
                    HasSubstr("state the unit: V = { column = \"Wear [left]\", unit = \"m\" }")));
  EXPECT_THAT(refused("Wear [left] of pin", "V = 'Wear [left] of pin'", "m"),
              HasSubstr("'left' is not a unit"));
  EXPECT_THAT(refused("Wear [milimeter]", "V = 'Wear'", "m"),
              HasSubstr("'milimeter' is not a unit"));
  EXPECT_THAT(refused("Wear [mikrn]", "V = 'Wear'", "m"), HasSubstr("did you mean 'micron'?"));
  EXPECT_THAT(refused("Wear [x1000 mm]", "V = 'Wear'", "m"),
              AllOf(HasSubstr("'x1000 mm' is not a unit"), HasSubstr("did you mean '1000 mm'?")));
  EXPECT_THAT(refused("life (x1000)", "V = 'life'", "cycle"), HasSubstr("'x1000' is not a unit"));
  // The study may state the unit of a column whose brackets hold a remark; a factor is no remark.
  EXPECT_THAT(read("Wear [left]", "V = { column = 'Wear [left]', unit = 'um' }", "m"),
              ElementsAre(DoubleEq(2e-6), DoubleEq(3e-6)));
  EXPECT_THAT(refused("Wear [x1000 mm]", "V = { column = 'Wear', unit = 'mm' }", "m"),
              HasSubstr("is in x1000 mm by its heading, and mm is given as its unit"));
  EXPECT_THAT(read("Wear [x1000 mm]", "V = { column = 'Wear', unit = '1000 mm' }", "m"),
              ElementsAre(DoubleEq(2), DoubleEq(3)));
  EXPECT_THAT(refused("Wear [mil]", "V = { column = 'Wear', unit = 'um' }", "m"),
              HasSubstr("(1 mil is 25.4 um)"));
  // Within other brackets they are part of a name.
  EXPECT_EQ(read_heading("a (log10[MPa])", "").unit, "");
}

// A unit in a heading means what it means in a study, however the heading has it.
RC_GTEST_PROP(Heading, MeansWhatAStudyWouldMean, ()) {
  struct Kind {
    std::string si, unit;
  };
  const auto [si, unit] = *rc::gen::elementOf(std::vector<Kind>{{"m^3", "mm^3"},
                                                                {"m^3", "mm3"},
                                                                {"m^3", "cm\u00B3"},
                                                                {"m", "\u00B5m"},
                                                                {"N", "kN"},
                                                                {"Pa", "N/mm^2"},
                                                                {"cycle", "kcycles"},
                                                                {"cycle", "1e5"},
                                                                {"rev", "Mrev"},
                                                                {"rev/s", "rpm"},
                                                                {"rev/s", "1/min"},
                                                                {"rad/s", "rpm"},
                                                                {"rad/s", "deg/s"},
                                                                {"rev/s", "rad/s"},
                                                                {"K", "degC"},
                                                                {"s", "h"},
                                                                {"m^3/(N m)", "mm^3/(N m)"},
                                                                {"N m/cycle", "J"}});
  const std::string heading = fmt::format(
      fmt::runtime(*rc::gen::element<std::string>("x [{}]", "x ({})", "x / {}", "x in {}", "x_{}")),
      unit);
  const Heading read = read_heading(heading, si);
  if (heading.find('_') != heading.npos && unit == "1e5") {
    RC_ASSERT(read.unit.empty());  // the number of a column
    return;
  }
  RC_ASSERT(read.name == "x");
  const Unit here = read_unit(read.unit, si), there = read_unit(unit, si);
  RC_ASSERT(here.scale == there.scale && here.offset == there.offset);
}

}  // namespace
}  // namespace wearwell
