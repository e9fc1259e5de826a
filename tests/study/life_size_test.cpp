#include "wearwell/study/life_size.h"

#include <gmock/gmock.h>

#include <cmath>

namespace wearwell {
namespace {

using testing::HasSubstr;

Column numbers(const std::string& name, std::vector<double> values) {
  Column column;
  column.name = name;
  column.is_number = true;
  column.numbers = std::move(values);
  return column;
}

Column words(const std::string& name, std::vector<std::string> cells) {
  Column column;
  column.name = name;
  column.text = std::move(cells);
  return column;
}

Table table_of_columns(std::vector<Column> columns, std::size_t rows) {
  Table table;
  table.columns = std::move(columns);
  table.rows = rows;
  return table;
}

// 1 of 100 failed at 400; 99 ran to 1000: (400^1.5 + 99 * 1000^1.5)^(2/3) = 21430.4.
TEST(LifeSize, FewFailuresLieBeyondTheTest) {
  const Table table = table_of_columns({numbers("life", {400, 1000}), numbers("count", {1, 99}),
                                        words("status", {"failure", "runout"})},
                                       2);
  const LifeHeadings headings =
      life_headings("life = \"life\"\ncount = \"count\"\nstatus = \"status\"\n", table);
  const LifeSize size = life_size(table, headings, 1000);
  const double expected = std::pow(std::pow(400, 1.5) + 99 * std::pow(1000, 1.5), 2.0 / 3);
  EXPECT_NEAR(size.median, expected, 1e-9 * expected);
  EXPECT_NEAR(size.log_sd, 2 * std::hypot(1, std::log(expected / 1000)), 0.25);
  EXPECT_EQ(size.failed, 1);
  EXPECT_EQ(size.parts, 100);
  EXPECT_THAT(words_of(size), HasSubstr("1 of 100 failed"));
}

TEST(LifeSize, ManyFailuresHaveTheLargestLife) {
  const Table table = table_of_columns({numbers("life", {100, 210, 320, 450, 600})}, 5);
  const LifeSize size = life_size(table, life_headings("life = \"life\"", table), 600);
  EXPECT_EQ(size.median, 600);
  EXPECT_EQ(size.log_sd, 2);
  EXPECT_EQ(words_of(size), "a factor of 27 to either side");
}

// A failure in 100 to 200 is one at 150, an empty upper end runs; entry at 50 is no time on test.
TEST(LifeSize, IntervalsAndEntries) {
  const Table table = table_of_columns({numbers("a", {100, 200}), numbers("b", {200, NAN}),
                                        numbers("n", {1, 50}), numbers("from", {0, 50})},
                                       2);
  const LifeSize size = life_size(
      table, life_headings("lower = \"a\"\nupper = \"b\"\ncount = \"n\"\nentry = \"from\"", table),
      200);
  const double exposure = std::pow(150, 1.5) + 50 * (std::pow(200, 1.5) - std::pow(50, 1.5));
  EXPECT_NEAR(size.median, std::pow(exposure, 2.0 / 3), 1e-9 * size.median);
  EXPECT_EQ(size.failed, 1);
}

TEST(LifeSize, NoFailureIsSaid) {
  const Table table =
      table_of_columns({numbers("life", {400, 1000}), words("status", {"S", "S"})}, 2);
  const LifeSize size =
      life_size(table, life_headings("life = \"life\"\nstatus = \"status\"", table), 1000);
  EXPECT_EQ(size.failed, 0);
  EXPECT_THAT(words_of(size), HasSubstr("none failed"));
}

// Of two modes each has half of the failures; a harsher stress with failures speaks for itself.
TEST(LifeSize, ModesAndStresses) {
  const Table table = table_of_columns(
      {numbers("life", {100, 300, 500, 500}), words("mode", {"wear", "seal", "runout", "runout"}),
       numbers("volt", {2, 1, 2, 1})},
      4);
  const std::string lines = "life = \"life\"\nmode = \"mode\"\n";
  const double all = std::pow(100, 1.5) + std::pow(300, 1.5) + 2 * std::pow(500, 1.5);
  const LifeSize modes = life_size(table, life_headings(lines, table), 500);
  EXPECT_NEAR(modes.median, std::pow(all, 2.0 / 3), 1e-9 * modes.median);
  EXPECT_EQ(modes.failed, 2);
  const LifeSize harsh = life_size_under(table, life_headings(lines, table), 300, {"volt"});
  EXPECT_EQ(harsh.parts, 2);
}

}  // namespace
}  // namespace wearwell
