#include "wearwell/present/table.h"

#include <gmock/gmock.h>

#include <cmath>

#include "wearwell/present/section.h"

namespace wearwell::present {
namespace {

using testing::HasSubstr;

Table sample() {
  Table table{"lives",
              "Lives",
              {{"Bearing"}, {"life", "h", life()}, {"90 %", "h", digits(3), true}, {"share", "%"}}};
  table.rows = {{"new, \"one\"", 21583.25, Range{18000, 26000.5}, 1. / 3},
                {"=1+1", INFINITY, Cell(), std::nan("")}};
  return table;
}

// RFC 4180: lines end with CR LF, quotes are doubled; a spreadsheet computes nothing.
TEST(Table, IsWrittenWithAllDigitsAndUnits) {
  EXPECT_EQ(csv(sample()),
            "Bearing,life [h],\"90 %, from [h]\",\"90 %, to [h]\",share [%]\r\n"
            "\"new, \"\"one\"\"\",21583.25,18000,26000.5,0.3333333333333333\r\n"
            "'=1+1,inf,,,\r\n");
}

// ECMA-48 and Unicode Standard Annex 9: `cat` shows a file without being commanded by it.
TEST(Table, CommandsNoTerminal) {
  Table table{"t", "T", {{"Of \x1b[2J"}}};
  table.rows = {{"\x1b[31mA\u202eB\r"}, {"two\nlines"}};
  EXPECT_EQ(csv(table), "Of \\x1b[2J\r\n\\x1b[31mA\\u202eB\\x0d\r\n\"two\nlines\"\r\n");
}

TEST(Table, IsShownAsPeopleReadIt) {
  const Table table = sample();
  EXPECT_EQ(description(table.rows[0][1], table.columns[1]), "21 580");
  EXPECT_EQ(description(table.rows[1][1], table.columns[1]), "never");
  EXPECT_EQ(description(table.rows[0][2], table.columns[2]), "18 000 to 26 000");
  EXPECT_EQ(description(table.rows[1][2], table.columns[2]), "–");
  EXPECT_EQ(description(2.0 / 3, fixed(2)), "0.67");
  EXPECT_EQ(description(20585, given), "20 585");
}

// "2 to 3.580 × 10¹²" would be read with one power for both ends.
TEST(Table, EndsOfLivesDecadesApartAreNotMisread) {
  EXPECT_EQ(description(Cell(Range{2, 3.58e12}), {"90 %", "h", life(), true}),
            "2.000\u00a0×\u00a010⁰ to 3.580\u00a0×\u00a010¹²");
  EXPECT_EQ(description(Cell(Range{2, 1.8e4}), {"90 %", "h", life(), true}), "2 to 18\u202f000");
}

TEST(Table, LongOnesAreCutWhereTheyAreShown) {
  Table table{"long", "Long", {{"x"}}};
  for (int i = 0; i < 1500; ++i) table.rows.push_back({static_cast<double>(i)});
  Section section{"s", "S"};
  section.add(table);
  EXPECT_THAT(html_of(section), HasSubstr("of 1 500; all are in tables/long.csv"));
  EXPECT_THAT(text(table),
              HasSubstr("the first 1\u202f000 of 1\u202f500; all are in tables/long.csv"));
  const std::string file = csv(table);
  EXPECT_EQ(std::count(file.begin(), file.end(), '\n'), 1501);
}

}  // namespace
}  // namespace wearwell::present
