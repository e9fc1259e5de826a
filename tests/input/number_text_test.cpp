// "35.000": thirty-five, or thirty-five thousand? Where the file cannot tell, nobody may.
#include "wearwell/input/number_text.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/input/column_stream.h"
#include "wearwell/input/table.h"

namespace wearwell {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

class ThousandsTest : public ScratchTest {
 protected:
  std::string refused(const std::string& content, const char* column = "life",
                      const char* name = "a.csv") {
    const auto file = write(name, content);
    return message_of<InputError>([&] { si_numbers(read_table(file), column, Unit{}); });
  }
  std::vector<double> read(const std::string& content, const char* column = "life",
                           const char* name = "a.csv") {
    return si_numbers(read_table(write(name, content)), column, Unit{});
  }
};

TEST_F(ThousandsTest, AnotherColumnShowsTheDecimalComma) {
  EXPECT_THAT(read("load;life\n250,5;35.000\n240,5;60.000\n"), ElementsAre(35000, 60000));
  EXPECT_THAT(read("load;life\n250,5;900\n240,5;35.250\n"), ElementsAre(900, 35250));
  EXPECT_THAT(read("load\tlife\n0,125\t35.000\n240,5\t1.060.000\n"), ElementsAre(35000, 1060000));
  // A stream reads the same.
  ColumnStream stream(write("a.csv", "load;life\n250,5;35.000\n240,5;60.000\n"));
  stream.select({"life", "load"});
  ColumnStream::Batch batch;
  ASSERT_TRUE(stream.next(batch));
  EXPECT_THAT(batch.columns[0], ElementsAre(35000, 60000));
  EXPECT_THAT(batch.columns[1], ElementsAre(250.5, 240.5));
}

TEST_F(ThousandsTest, SignsThatContradictAreRefused) {
  // Where commas separate the columns, points are decimal marks in most files.
  EXPECT_THAT(
      refused("load,life\n\"250,5\",35.000\n\"240,5\",60.250\n"),
      AllOf(HasSubstr("a.csv, row 1, column 'life': '35.000' can mean 35 or, with a thousands "
                      "separator, 35000"),
            HasSubstr("the file has '250,5', with a decimal comma"), HasSubstr("decimal = \",\"")));
  EXPECT_THAT(refused("load;slip;life\n250,5;1.5;35.000\n240,5;2.5;60.000\n"),
              HasSubstr("'35.000' can mean 35 or"));
  EXPECT_THAT(refused("n;life\n1;1,5\n2;2.5\n"),
              HasSubstr("row 2, column 'life': '2.5' has a decimal point and '1,5' in row 1 a "
                        "decimal comma"));
  EXPECT_THAT(refused("n;life\n1;1.234\n2;1,234\n"), HasSubstr("'1.234' can mean 1.234 or"));
  // Another column is read by its own signs.
  EXPECT_THAT(read("load;slip;life\n250,5;1.5;35.000\n240,5;2.5;60.000\n", "load"),
              ElementsAre(250.5, 240.5));
  EXPECT_THAT(read("load;slip;life\n250,5;1.5;35.000\n240,5;2.5;60.000\n", "slip"),
              ElementsAre(1.5, 2.5));
}

TEST_F(ThousandsTest, WithoutAnySignTheyAreRefusedToo) {
  EXPECT_THAT(refused("load;life\n250;35.000\n240;60.000\n"), HasSubstr("35000"));
  EXPECT_THAT(refused("load\tlife\n250\t35.000\n240\t60.000\n"), HasSubstr("35000"));
  EXPECT_THAT(refused("[{\"life\": \"35.000\"}, {\"life\": \"60.000\"}]", "life", "a.json"),
              HasSubstr("row 1, column 'life': '35.000' can mean 35 or"));
}

TEST_F(ThousandsTest, OrdinaryNumbersAreNot) {
  EXPECT_THAT(read("load,life\n250,35.000\n240,60.000\n"), ElementsAre(35, 60));
  EXPECT_THAT(read("load,life\n34.125,35.000\n33.250,60.000\n"), ElementsAre(35, 60));
  EXPECT_THAT(read("load;life\n250.5;35.000\n240;60.000\n"), ElementsAre(35, 60));
  EXPECT_THAT(read("load;life\n250;35.000\n240;60.5\n"), ElementsAre(35, 60.5));
  EXPECT_THAT(read("load;life\n250;35.000\n240;0.125\n"), ElementsAre(35, 0.125));
  EXPECT_THAT(read("load\tlife\n250\t1234.500\n240\t60.000\n"), ElementsAre(1234.5, 60));
  EXPECT_THAT(read("load;life\n250,5;35000\n240,5;6e4\n"), ElementsAre(35000, 60000));
  EXPECT_THAT(read("load;life\n250,5;35000\n240,5;60000\n"), ElementsAre(35000, 60000));
  // Three digits behind a comma may be a mark for thousands of a text: no sign of decimal commas.
  EXPECT_THAT(read("note,life\n\"about 1,000\",35.125\nb,60.250\n"), ElementsAre(35.125, 60.25));
  EXPECT_THAT(read("[{\"life\": \"35.000\"}, {\"life\": \"60.5\"}]", "life", "a.json"),
              ElementsAre(35, 60.5));
}

TEST_F(ThousandsTest, MarksThatAreSure) {
  const auto expect = [&](const char* cell, double meaning) {
    EXPECT_THAT(read(std::string("n;life\n1;5\n2;\"") + cell + "\"\n"), ElementsAre(5, meaning))
        << cell;
  };
  expect("1,234,567", 1234567);
  expect("1.234.567", 1234567);
  expect("1'234", 1234);
  expect(
      "1\xE2\x80\x99"
      "234.5",
      1234.5);
  expect("35 000", 35000);
  expect(
      "35\xC2\xA0"
      "000",
      35000);
  expect(
      "1\xE2\x80\xAF"
      "234\xE2\x80\xAF"
      "567,25",
      1234567.25);
  expect("12,5", 12.5);
  expect("1.234,5", 1234.5);
  expect("1,234.5", 1234.5);
  expect("-1.234,5", -1234.5);
  expect(
      "\xE2\x88\x92"
      "12,5",
      -12.5);
  expect("+12,5", 12.5);
  expect("1,5E+06", 1.5e6);
  expect("0,125", 0.125);
  expect(",5", 0.5);
}

TEST_F(ThousandsTest, WhatIsNoNumber) {
  for (const char* cell : {"1,23,456", "12.05.2023", "1.2.3", "12 34", "1 2345", "5 pieces",
                           "1.234.5", "0.123.456", "#DIV/0!", "<a", "1e", "1,5e1,5", "--5"})
    EXPECT_THAT(refused(std::string("n;life\n1;5\n2;\"") + cell + "\"\n"),
                HasSubstr(std::string("row 2, column 'life': '") + cell + "' is not a number"))
        << cell;
  // What says more than a number has its own words.
  for (const auto& [cell, why] :
       {std::pair{"5 mm", "'5 mm' has the unit mm and '5' in row 1 has none"},
        std::pair{"35 200 cycles", "'35 200 cycles' has the unit cycles"},
        std::pair{"#NV", "no value"}, std::pair{"<5", "'<5' is a limit"}})
    EXPECT_THAT(refused(std::string("n;life\n1;5\n2;\"") + cell + "\"\n"), HasSubstr(why));
  EXPECT_THAT(refused("n;life\n1;5\n2;\"1,234\"\n"),
              HasSubstr("'1,234' can mean 1.234 or, with a thousands separator, 1234"));
  EXPECT_EQ(not_a_number("abc"), "'abc' is not a number");
  EXPECT_EQ(not_a_number("1,2,3"), "'1,2,3' is not a number");
}

// Any number, written as any country does, is read back or refused, never another one.
RC_GTEST_PROP(NumberText, IsReadBackOrRefused, ()) {
  const auto [decimal, thousands] =
      *rc::gen::element(std::pair{'.', ','}, std::pair{'.', '\''}, std::pair{'.', '\0'},
                        std::pair{',', '.'}, std::pair{',', ' '}, std::pair{',', '\0'});
  const auto number = *rc::gen::inRange(-50'000'000, 50'000'000);
  const int decimals = *rc::gen::inRange(0, 5);
  const double value = number / std::pow(10.0, decimals);
  std::string digits = fmt::format("{:.{}f}", std::abs(value), decimals);
  const std::size_t point = std::min(digits.find('.'), digits.size());
  if (point < digits.size()) digits[point] = decimal;
  for (std::size_t at = point; thousands != '\0' && at > 3; at -= 3)
    digits.insert(at - 3, 1, thousands);
  const std::string cell = (value < 0 ? "-" : "") + digits;
  const auto read = plain_number(cell, {decimal, '*'});
  RC_ASSERT(read.has_value());
  RC_ASSERT(std::stod(*read) == std::stod(fmt::format("{:.{}f}", value, decimals)));
  // With the other decimal mark it is no number, unless its mark may be one for thousands.
  const auto other = plain_number(cell, {decimal == '.' ? ',' : '.', '*'});
  const NumberForm form = number_form(cell);
  const bool no_mark = form.decimal == 0 && form.doubtful == 0 &&
                       (form.thousands == 0 || form.thousands == ' ' || form.thousands == '\'');
  RC_ASSERT(form.kind == NumberForm::Kind::number);
  RC_ASSERT(!other || form.doubtful != 0 || no_mark);
}

}  // namespace
}  // namespace wearwell
