#include "wearwell/models/formula_model/returns_triangle.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "support/messages.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/models/formula_model/field_returns.h"

namespace wearwell::formula_model {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class ReturnsTriangleTest : public ScratchTest {
 protected:
  std::shared_ptr<const FieldReturns> read(const std::string& table, const std::string& keys = "") {
    write("d.csv", table);
    const Source source =
        source_of(write("study.toml", "[data]\nfile = \"d.csv\"\n[data.returns]\n" + keys));
    const TomlReader root = TomlReader::parse(source.study);
    return read_field_returns(root, source);
  }
  std::string refusal(const std::string& table, const std::string& keys = "") {
    return message_of<InputError>([&] { lives_of_returns(*read(table, keys)); });
  }
  FormulaData lives(const std::string& table, const std::string& keys = "") {
    return lives_of_returns(*read(table, keys));
  }
};

constexpr const char* small =
    "sold,units,2024-01,2024-02,2024-03\n2024-01,100,1,2,3\n2024-02,200,,4,\n";

std::vector<double> in_months(const FormulaData& data, const char* name) {
  const NumberColumn& column = *data.number(name);
  std::vector<double> values;
  for (const double each : column.values) values.push_back(from_si(column.unit.unit, each));
  return values;
}

// A cell is a row of failures; what did not come back a row of survivors.
TEST_F(ReturnsTriangleTest, LivesFromTheMiddleOfTheMonth) {
  const FormulaData data = lives(small);
  const auto nan = [](double x) { return std::isnan(x) ? -1 : x; };
  std::vector<double> lower = in_months(data, "lower"), upper = in_months(data, "upper");
  std::transform(lower.begin(), lower.end(), lower.begin(), nan);
  std::transform(upper.begin(), upper.end(), upper.begin(), nan);
  ASSERT_EQ(lower.size(), 6U);
  const std::vector<double> expected_lower = {-1, 0.5, 1.5, 2.5, -1, 1.5},
                            expected_upper = {0.5, 1.5, 2.5, -1, 0.5, -1};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(lower[i], expected_lower[i], 1e-9);
    EXPECT_NEAR(upper[i], expected_upper[i], 1e-9);
  }
  EXPECT_THAT(data.number("count")->values, ElementsAre(1, 2, 3, 94, 4, 196));
  EXPECT_EQ(data.number("lower")->unit.unit.text, "month");
}

TEST_F(ReturnsTriangleTest, OtherAges) {
  EXPECT_NEAR(in_months(lives(small, "ages = \"start\"\n"), "upper")[0], 1, 1e-9);
  EXPECT_NEAR(in_months(lives(small, "ages = \"start\"\n"), "lower")[3], 3, 1e-9);
  const std::string later = "sold,units,2024-02,2024-03\n2024-01,100,2,3\n";
  EXPECT_NEAR(in_months(lives(later, "ages = \"end\"\n"), "upper")[0], 1, 1e-9);
  const FormulaData whole = lives(later, "ages = \"whole\"\n");
  EXPECT_EQ(in_months(whole, "lower")[1], in_months(whole, "upper")[1]);  // exact
  EXPECT_NEAR(in_months(whole, "upper")[1], 2, 1e-9);
  EXPECT_NEAR(in_months(whole, "lower")[2], 2, 1e-9);
  EXPECT_THAT(refusal(small, "ages = \"whole\"\n"),
              AllOf(HasSubstr("1 of the units sold in 2024-01 came back in 2024-01"),
                    HasSubstr("ages = \"middle\"")));
}

// Delays shift ages; a month of sale that is not in use yet tells nothing.
TEST_F(ReturnsTriangleTest, DelaysAndWarranty) {
  const std::string table = "sold,units,2024-01,2024-02,2024-03\n2024-01,100,,2,3\n2024-03,50,,,\n";
  const FormulaData late =
      lives(table, "delay_to_use = \"0.5 month\"\ndelay_of_report = \"0.5 month\"\n");
  EXPECT_THAT(late.number("count")->values, ElementsAre(2, 3, 95));
  EXPECT_NEAR(in_months(late, "upper")[0], 0.5, 1e-9);
  EXPECT_NEAR(in_months(late, "lower")[2], 1.5, 1e-9);
  EXPECT_THAT(refusal(table, "delay_to_use = \"2 month\"\n"),
              HasSubstr("with delays of 2 months no failure can be reported so early"));
  // The third month is beyond the warranty: 3 survivors of it more, and an interval that it cuts.
  const auto cut = read(table, "warranty = \"1 month\"\n");
  const FormulaData claimed = lives_of_returns(*cut);
  EXPECT_THAT(claimed.number("count")->values, ElementsAre(2, 98, 50));
  EXPECT_NEAR(in_months(claimed, "upper")[0], 1, 1e-9);
  EXPECT_NEAR(in_months(claimed, "lower")[1], 1, 1e-9);
  EXPECT_THAT(notes_of_returns(*cut), testing::Contains(HasSubstr("3 returns after the end")));
}

TEST_F(ReturnsTriangleTest, HeldOutMonthsAreNotFitted) {
  const FormulaData data = lives(small, "hold_out = \"1 month\"\n");
  EXPECT_THAT(data.number("count")->values, ElementsAre(1, 2, 97, 4, 196));
  EXPECT_THAT(refusal(small, "hold_out = \"3 month\"\n"), HasSubstr("leaves no period to fit"));
  EXPECT_THAT(refusal(small, "hold_out = \"0.5 month\"\n"), HasSubstr("must be whole months"));
}

// As tables come: names of months, slashes, any order of rows and columns, columns that are no month.
TEST_F(ReturnsTriangleTest, TablesAsTheyCome) {
  for (const char* table :
       {"month;shipped;Jan-24;Feb-24;Mar-24\nJan-24;100;1;2;3\nFeb-24;200;;4;\n",
        "month,shipped,01/2024,02/2024,03/2024\n02/2024,200,,4,\n01/2024,100,1,2,3\n",
        "month,shipped,202401,202402,202403\n202401,100,1,2,3\n202402,200,,4,\n",
        "Monat;Stück;März 2024;Januar 2024;Februar 2024\nJanuar 2024;100;3;1;2\nFebruar "
        "2024;200;0;0;4\n",
        "product,month,shipped,2024-01-01,2024-02-01,2024-03-01,comment\nA,2024-01-01,100,1,2,3,"
        "\nA,"
        "2024-02-01,200,,4,,new\n",
        "month,shipped,1,2,3\n1,100,1,2,3\n2,200,,4,\n",
        "month,shipped,M1,M2,M3\nM1,100,1,2,3\nM2,200,,4,\n"}) {
    const bool numbered = std::string(table).find("24") == std::string::npos;
    SCOPED_TRACE(table);
    const auto returns = read(table, numbered ? "period = \"month\"\n" : "");
    ASSERT_EQ(returns->triangle.sales.size(), 2U);
    EXPECT_EQ(returns->triangle.sales[0].sold, 100);
    EXPECT_THAT(returns->triangle.sales[0].returns, ElementsAre(1, 2, 3));
    EXPECT_THAT(returns->triangle.sales[1].returns, ElementsAre(4, 0));
    EXPECT_EQ(returns->triangle.last - returns->triangle.sales[0].at, 2);
  }
}

TEST_F(ReturnsTriangleTest, ErrorsNameTheCell) {
  const std::string heading = "sold,units,2024-01,2024-02,2024-03\n";
  EXPECT_THAT(refusal(heading + "2024-01,5,1,2,3\n"),
              HasSubstr("d.csv, row 1, column '2024-03': '3': with this, 6 of the 5 units sold "
                        "('units') have come back"));
  EXPECT_THAT(refusal(heading + "2024-02,50,1,2,3\n"),
              HasSubstr("row 1, column '2024-01': '1': a return before the sale"));
  EXPECT_THAT(refusal(heading + "2024-01,50,1,2,3\n2024-02,,,2,3\n2024-03,50,,,3\n"),
              HasSubstr("row 2, column 'units': no quantity"));
  EXPECT_THAT(refusal(heading + "2024-01,50,1,2.5,3\n"),
              HasSubstr("row 1, column '2024-02': '2.5' must be a whole number"));
  EXPECT_THAT(refusal(heading + "2024-01,50,1,-2,3\n"), HasSubstr("'-2' must be a whole number"));
  EXPECT_THAT(refusal(heading + "2024-01,50,1,,3\n2024-01,50,1,2,3\n"),
              HasSubstr("row 2, column 'sold': '2024-01': the same period of sale as in row 1"));
  EXPECT_THAT(refusal(heading + "2024-01,50,1,,3\n2024-04,50,,,\n"),
              HasSubstr("sold after '2024-03'"));
  EXPECT_THAT(refusal(heading + "2024-01,50,1,,3\n01/02/2024,50,,,\n2024-03,5,,,0\n"),
              HasSubstr("row 2, column 'sold': '01/02/2024' is not a period of sale"));
  EXPECT_THAT(refusal(heading + "2023-11,50,1,,3\n"), HasSubstr("sold before '2024-01'"));
  EXPECT_THAT(refusal("sold,units,2024-01,2024-03\n2024-01,50,1,2\n",
                      "sold = \"sold\"\nquantity = \"units\"\n"),
              HasSubstr("no column of 2024-02 between '2024-01' and '2024-03'"));
  EXPECT_THAT(refusal("sold,units,2024-01,2024-02\n2024-01,50,1,\n"),
              AllOf(HasSubstr("column '2024-02' is empty"), HasSubstr("write 0"),
                    HasSubstr("remove the column")));
  EXPECT_THAT(
      refusal("sold,units,0,1,2\n2024-01,50,1,2,3\n", "sold = \"sold\"\nquantity = \"units\"\n"),
      AllOf(HasSubstr("is a month, but the column '0' a number"), HasSubstr("months in service")));
  EXPECT_THAT(refusal("sold,units,1,2\n1,50,1,2\n"), HasSubstr("period"));
  EXPECT_THAT(refusal("a,b\n1,2\n"), HasSubstr("sold"));
  EXPECT_THAT(refusal(heading + "2024-01,50,1,2,3\n", "sold = \"month\"\n"),
              HasSubstr("no column 'month'"));
}

// A total of the returns is no quantity, whatever the numbers of the quantity look like.
TEST_F(ReturnsTriangleTest, QuantityStandsBeforeTheReturns) {
  EXPECT_EQ(read("month,sold,2024-01,2024-02,total\n2024-01,100,1,2,3\n2024-02,200,,4,4\n")
                ->triangle.quantity_column,
            "sold");
  EXPECT_THAT(refusal("month,sold,2024-01,2024-02,total\n2024-01,\"1,100\",1,2,3\n2024-02,200,,4,"
                      "4\n"),
              HasSubstr("column 'sold'"));
  EXPECT_EQ(read("line,month,sold,2024-01,2024-02\n7,2024-01,100,1,2\n7,2024-02,200,,4\n")
                ->triangle.quantity_column,
            "sold");
  EXPECT_THAT(refusal("line,month,number,2024-01,2024-02\n7,2024-01,100,1,2\n7,2024-02,200,,4\n"),
              HasSubstr("data.returns"));
  EXPECT_THAT(refusal("month,2024-01,2024-02,total\n2024-01,1,2,3\n2024-02,,4,4\n"),
              HasSubstr("data.returns"));
}

TEST_F(ReturnsTriangleTest, PlannedSales) {
  const auto planned = [&](const std::string& text) {
    const Source source = source_of(write("p.toml", "[planned]\nfile = \"p.csv\"\n"));
    write("p.csv", text);
    const TomlReader root = TomlReader::parse(source.study);
    const TomlReader keys = root.required_table("planned");
    return read_planned_sales(keys, read_table(keys, source), {true, ""}, 2024 * 12);
  };
  EXPECT_THAT(planned("month,units\n2024-03,20\n2024-02,10\n"),
              ElementsAre(std::pair(2024 * 12 + 1, 10), std::pair(2024 * 12 + 2, 20)));
  EXPECT_THAT(message_of<InputError>([&] { planned("month,units\n2024-01,20\n"); }),
              HasSubstr("row 1, column 'month': '2024-01' is not after 2024-01"));
  EXPECT_THAT(message_of<InputError>([&] { planned("month,units\n2024-02,\n"); }),
              HasSubstr("no quantity"));
  EXPECT_THAT(message_of<InputError>([&] { planned("month,units\n2024-02,1\n2024-02,1\n"); }),
              HasSubstr("row 2, column 'month': '2024-02': a second row"));
}

// Numbers of weeks beside numbers of months.
TEST_F(ReturnsTriangleTest, PeriodsOfTwoKinds) {
  const std::string keys = "period = \"month\"\n";
  EXPECT_THAT(refusal("sold,units,M4,M5,M6\nM4,100,1,2,3\nW5,200,,4,1\n", keys),
              HasSubstr("row 2, column 'sold': 'W5' is a period of another kind than those that "
                        "begin with 'M'"));
  EXPECT_THAT(refusal("sold,units,4,5,6\nM4,100,1,2,3\nW5,200,,4,1\n", keys),
              HasSubstr("another kind"));
  EXPECT_EQ(read("sold,units,4,5,6\nM4,100,1,2,3\nm5,200,,4,1\n", keys)->triangle.sales.size(), 2U);
  EXPECT_EQ(read("sold,units,M4,M5,M6\n4,100,1,2,3\n5,200,,4,1\n", keys)->triangle.sales.size(),
            2U);
}

// A row a unit, or a row of several, gives the triangle of their counts.
TEST_F(ReturnsTriangleTest, CountsUnits) {
  const std::string keys = "sold = \"sale\"\nreturned = \"failure\"\nuntil = \"2024-03\"\n";
  const auto one = read(
      "serial,sale,failure\nA,2024-01-05,2024-02-01\nB,2024-01-31,\nC,2024-02-11,2024-02-12\n"
      "D,2024-01-07,2024-02-28\nE,2024-02-02,2024-04-01\nF,2024-04-02,\n",
      keys);
  ASSERT_EQ(one->triangle.sales.size(), 2U);
  EXPECT_EQ(one->triangle.sales[0].sold, 3);
  EXPECT_THAT(one->triangle.sales[0].returns, ElementsAre(0, 2, 0));
  EXPECT_EQ(one->triangle.sales[1].sold, 2);  // one of them came back after the end
  EXPECT_THAT(one->triangle.sales[1].returns, ElementsAre(1, 0));
  const std::vector<std::string> notes = notes_of_returns(*one);
  EXPECT_THAT(notes, testing::Contains(HasSubstr("6 units counted")));
  EXPECT_THAT(notes, testing::Contains(HasSubstr("left out: 1 sold after 2024-03")));
  EXPECT_THAT(notes, testing::Contains(HasSubstr("counted as in use: 1 returned after 2024-03")));
  const auto several =
      read("sale,failure,n\n2024-01,,1\n2024-01,2024-02,2\n2024-02,2024-02,1\n2024-02,,1\n",
           keys + "quantity = \"n\"\n");
  EXPECT_THAT(several->triangle.sales[0].returns, ElementsAre(0, 2, 0));
  EXPECT_EQ(several->triangle.sales[1].sold, 2);
  const auto weeks = read("w,back\n3,5\n3,\n4,\n",
                          "sold = \"w\"\nreturned = \"back\"\nuntil = 6\nperiod = \"week\"\n");
  EXPECT_THAT(weeks->triangle.sales[0].returns, ElementsAre(0, 0, 1, 0));
}

TEST_F(ReturnsTriangleTest, RefusesUnitsByTheirCell) {
  const std::string keys = "sold = \"sale\"\nreturned = \"failure\"\n",
                    until = "until = \"2024-03\"\n";
  const std::string good = "sale,failure\n2024-01,2024-02\n";
  EXPECT_THAT(refusal(good, keys), HasSubstr("until"));
  EXPECT_THAT(refusal(good, keys + "until = \"soon\"\n"), HasSubstr("2024-01"));
  EXPECT_THAT(refusal(good + "2024-02,2024-01\n", keys + until),
              testing::AllOf(HasSubstr("row 2, column 'failure'"), HasSubstr("before the sale")));
  EXPECT_THAT(refusal(good + ",2024-01\n", keys + until),
              HasSubstr("row 2, column 'sale': '' is not a month"));
  EXPECT_THAT(refusal(good + "2024-01,03/04/2024\n", keys + until),
              HasSubstr("row 2, column 'failure': '03/04/2024' is not a month"));
  EXPECT_THAT(refusal("sale,failure\n2025-01,\n", keys + until),
              HasSubstr("no unit was sold until"));
  EXPECT_THAT(refusal(good, "sold = \"sale\"\nreturned = \"sale\"\n" + until),
              HasSubstr("is the column of `sold`"));
}

}  // namespace
}  // namespace wearwell::formula_model
