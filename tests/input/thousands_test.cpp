// "35.000": thirty-five, or thirty-five thousand? Where the file cannot tell, nobody may.
#include "wearwell/input/thousands.h"

#include <gmock/gmock.h>

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

TEST_F(ThousandsTest, BesideDecimalCommasTheyAreRefused) {
  EXPECT_THAT(refused("load;life\n250,5;35.000\n240,5;60.000\n"),
              AllOf(HasSubstr("a.csv, row 1, column 'life': '35.000' can mean 35 or, with a mark "
                              "for thousands, 35000"),
                    HasSubstr("the file has '250,5', with a decimal comma")));
  EXPECT_THAT(refused("load,life\n\"250,5\",35.000\n\"240,5\",60.250\n"),
              HasSubstr("can mean 35 or, with a mark for thousands, 35000"));
  EXPECT_THAT(refused("load;life\n250,5;900\n240,5;35.250\n"),
              HasSubstr("row 2, column 'life': '35.250' can mean 35.25 or"));
  // A stream sees it too, before its first row.
  const auto file = write("a.csv", "load;life\n250,5;35.000\n240,5;60.000\n");
  EXPECT_THAT(message_of<InputError>([&] { ColumnStream stream(file); }), HasSubstr("35000"));
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

TEST_F(ThousandsTest, OtherMarksAreNoNumbers) {
  const auto expect = [&](const char* cell, const char* meaning) {
    EXPECT_THAT(refused(std::string("n;life\n1;5\n2;\"") + cell + "\"\n"),
                AllOf(HasSubstr("row 2, column 'life': '"),
                      HasSubstr("is not a number; it may mean"), HasSubstr(meaning)))
        << cell;
  };
  expect("1,234,567", "mean 1234567:");
  expect("1.234.567", "mean 1234567:");
  expect("1'234", "mean 1234:");
  expect("35 000", "mean 35000:");
  expect(
      "35\xC2\xA0"
      "000",
      "mean 35000:");
  expect("1,234", "mean 1234 or 1.234:");
  expect("12,5", "mean 12.5:");
  expect("1.234,5", "mean 1234.5:");
  expect("1,234.5", "mean 1234.5:");
  EXPECT_EQ(not_a_number("abc"), "'abc' is not a number");
  EXPECT_EQ(not_a_number("1,2,3"), "'1,2,3' is not a number");
}

}  // namespace
}  // namespace wearwell
