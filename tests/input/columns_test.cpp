// One way to read a column, whatever the model.
#include "wearwell/input/columns.h"

#include <gmock/gmock.h>

#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/input/source.h"

namespace wearwell {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

class ColumnsTest : public ScratchTest {
 protected:
  Table table(const std::string& content) const { return read_table(write("a.csv", content)); }
  TomlReader toml(const std::string& text) const {
    return TomlReader::parse({folder() / "study.toml", text});
  }
  std::string refused_counts(const std::string& content) const {
    return message_of<InputError>([&] { with_counts(toml("count = 'n'\n"), table(content)); });
  }
};

TEST_F(ColumnsTest, RowsThatStandForSeveral) {
  const Table once = table("n,v,label\n2,1.5,a\n1,2.5,b\n3,x,c\n");
  const Table all = with_counts(toml("count = 'n'\n"), once);
  EXPECT_EQ(all.rows, 6u);
  EXPECT_THAT(all.column("label").text, ElementsAre("a", "a", "b", "c", "c", "c"));
  EXPECT_THAT(all.column("v").text, ElementsAre("1.5", "1.5", "2.5", "x", "x", "x"));
  // Messages name the row of the file.
  EXPECT_THAT(message_of<InputError>([&] { si_numbers(all, "v", Unit{}); }),
              HasSubstr("row 3, column 'v': 'x' is not a number"));
  EXPECT_EQ(with_counts(toml("other = 'n'\n"), once).rows, 3u);
  EXPECT_THAT(refused_counts("n\n0\n"),
              HasSubstr("row 1, column 'n': 0 must be a whole number from 1"));
  EXPECT_THAT(refused_counts("n\n1\n1.5\n"), HasSubstr("row 2, column 'n': 1.5 must be"));
  EXPECT_THAT(refused_counts("n\n999999\n2\n"), HasSubstr("with a sum of at most 1000000"));
}

TEST_F(ColumnsTest, KeysOfATable) {
  write("a.csv", "Versuch\nx;y\n1.500;2,5\n");
  const auto read = [&](const std::string& keys) {
    return read_table(toml("file = 'a.csv'\n" + keys), Source{{folder() / "study.toml", ""}});
  };
  EXPECT_THAT(
      si_numbers(read("decimal = ','\nthousands = '.'\ndelimiter = ';'\nencoding = 'utf-8'\n"
                      "header_row = 2\nunits_row = 'none'\ncomment = '#'\n"),
                 "x", Unit{}),
      ElementsAre(1500));
  const auto refused = [&](const std::string& keys) {
    return message_of<InputError>([&] { read(keys); });
  };
  EXPECT_THAT(refused("decimal = ';'\n"), HasSubstr("study.toml:2:"));
  EXPECT_THAT(refused("decimal = ','\nthousands = ','\n"),
              HasSubstr("thousands: is also the decimal mark"));
  EXPECT_THAT(refused("comment = ''\n"), HasSubstr("comment: is empty"));
  EXPECT_THAT(refused("header_row = 0\n"), HasSubstr("header_row"));
  EXPECT_THAT(refused("sheet = 'A'\n"), HasSubstr("a.csv is not a workbook"));
  const Source memory{{folder() / "study.toml", ""}, {{"a.csv", table("x\n1\n")}}};
  EXPECT_THAT(
      message_of<InputError>([&] { read_table(toml("file = 'a.csv'\ndecimal = ','\n"), memory); }),
      HasSubstr("decimal: is for tables in files"));
}

TEST_F(ColumnsTest, ColumnsOfWords) {
  const Table t = table("type [kind],n\na,1\nb,2.5\n");
  EXPECT_EQ(read_word_column(toml("label = 'type'\n"), "label", t)->column, "type [kind]");
  const auto number = read_word_column(toml("label = 'n'\n"), "label", t);
  EXPECT_EQ(cell_word(t.column(number->column), 0), "1");
  EXPECT_EQ(cell_word(t.column(number->column), 1), "2.5");
  EXPECT_FALSE(read_word_column(toml("other = 'n'\n"), "label", t));
  EXPECT_THAT(
      message_of<InputError>([&] { read_word_column(toml("label = 'tipe'\n"), "label", t); }),
      HasSubstr("has no column 'tipe'"));
}

}  // namespace
}  // namespace wearwell
