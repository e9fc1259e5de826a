#include "wearwell/input/table.h"

#include <gmock/gmock.h>

#include <fstream>
#include <sstream>

#include "support/scratch.h"
#include "wearwell/base/error.h"

namespace wearwell {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class TableTest : public ScratchTest {
 protected:
  std::string refusal(const std::filesystem::path& file,
                      const std::optional<std::string>& sql = {}) {
    return message_of<InputError>([&] { read_table(file, sql); });
  }
};

TEST_F(TableTest, ReadsCsvAndConverts) {
  const auto file = write("a.csv", "cycles,volume,note\n1,4.44,first\n100,5.105,\n");
  const Table table = read_table(file);
  ASSERT_EQ(table.rows, 2u);
  EXPECT_THAT(si_numbers(table, "cycles", Unit{}), ElementsAre(1, 100));
  EXPECT_THAT(si_numbers(table, "volume", read_unit("mm^3", "m^3")),
              ElementsAre(testing::DoubleEq(4.44e-9), testing::DoubleEq(5.105e-9)));
  EXPECT_THAT(table.column("note").text, ElementsAre("first", ""));
}

// DuckDB would take F and T for false and true.
TEST_F(TableTest, LettersStayLetters) {
  const Table table = read_table(write("a.csv", "status,broken\nF,true\nF,false\n"));
  EXPECT_THAT(table.column("status").text, ElementsAre("F", "F"));
  EXPECT_THAT(table.column("broken").text, ElementsAre("true", "false"));
}

// two_columns.parquet was written by DuckDB 1.4.4: duckdb_query(connection, "copy (select * from
// (values (1, 2.5::double), (3, 4.5::double)) t(x, y)) to 'two_columns.parquet' (format parquet)").
TEST_F(TableTest, ReadsTsvJsonAndParquetAlike) {
  const auto csv = write("a.csv", "x,y\n1,2.5\n3,4.5\n");
  const auto tsv = write("a.tsv", "x\ty\n1\t2.5\n3\t4.5\n");
  const auto json = write("a.json", R"([{"x": 1, "y": 2.5}, {"x": 3, "y": 4.5}])");
  const std::filesystem::path parquet = PROJECT_SOURCE_DIR "/tests/input/two_columns.parquet";
  for (const auto& file : {csv, tsv, json, parquet}) {
    const Table table = read_table(file);
    EXPECT_THAT(si_numbers(table, "x", Unit{}), ElementsAre(1, 3)) << file;
    EXPECT_THAT(si_numbers(table, "y", Unit{}), ElementsAre(2.5, 4.5)) << file;
  }
}

// Of Parquet the same file with its second column named as the first, in the schema and where its pages are listed; of JSON any row may have
// two keys of one name.
TEST_F(TableTest, TwoColumnsOfOneNameAreRefusedAtEachDoor) {
  std::stringstream read;
  read << std::ifstream(PROJECT_SOURCE_DIR "/tests/input/two_columns.parquet").rdbuf();
  std::string parquet = read.str();
  std::size_t renamed = 0;
  for (std::size_t at = parquet.find("\x01y"); at != std::string::npos;
       at = parquet.find("\x01y", at + 1)) {
    parquet[at + 1] = 'x';
    ++renamed;
  }
  ASSERT_EQ(renamed, 2u);
  EXPECT_THAT(refusal(write("a.csv", "x,x\n1,2.5\n")),
              HasSubstr("a.csv has two columns named 'x': columns 1 and 2"));
  EXPECT_THAT(refusal(write("a.parquet", parquet)),
              HasSubstr("a.parquet has two columns named 'x': columns 1 and 2"));
  for (const char* rows : {R"([{"x": 1, "x": 2.5}])", R"([{"x": 1}, {"x": 1, "x": 2.5}])",
                           "{\"x\": 1}\n{\"x\": 1, \"x\": 2.5}\n"})
    EXPECT_THAT(refusal(write("a.json", rows)), HasSubstr("has duplicate key \"x\"")) << rows;
}

TEST_F(TableTest, SqlKeepsItsOrder) {
  const auto file = write("a.csv", "angle,cycles,v\n0,5,1\n0,2,3\npi,5,3\npi,2,5\n");
  const Table table =
      read_table(file, "select cycles, avg(v) as v from data group by cycles order by cycles desc");
  EXPECT_THAT(si_numbers(table, "cycles", Unit{}), ElementsAre(5, 2));
  EXPECT_THAT(si_numbers(table, "v", Unit{}), ElementsAre(2, 4));
}

TEST_F(TableTest, FilesThatAreNotTables) {
  EXPECT_THAT(refusal(folder() / "missing.csv"), HasSubstr("no such file"));
  EXPECT_THAT(refusal(folder()), HasSubstr("is a folder"));
  EXPECT_THAT(refusal(write("empty.csv", "")), HasSubstr("is empty"));
  EXPECT_THAT(refusal(write("header.csv", "a,b\n")), HasSubstr("has no rows"));
  EXPECT_THAT(refusal(write("twice.csv", "a,b,a\n1,2,3\n")),
              HasSubstr("two columns named 'a': columns 1 and 3"));
  EXPECT_THAT(refusal(write("bad.parquet", "not parquet at all")), HasSubstr("bad.parquet"));
  EXPECT_THAT(refusal(write("a.csv", "a\n1\n"), "select nothing from data"), HasSubstr("nothing"));
}

TEST_F(TableTest, NamesRowColumnAndValue) {
  const auto message = [&](const std::string& content) {
    const Table table = read_table(write("a.csv", content));
    return message_of<InputError>([&] { si_numbers(table, "v", Unit{}); });
  };
  EXPECT_THAT(message("n,v\n1,2.5\n2,abc\n"),
              HasSubstr("row 2, column 'v': 'abc' is not a number"));
  EXPECT_THAT(message("n,v\n1,2.5\n2,\n3,1\n"), HasSubstr("row 2, column 'v': no value"));
  EXPECT_THAT(message("n,v\n1,nan\n2,3\n"), HasSubstr("row 1, column 'v': no value"));
  EXPECT_THAT(message("n,v\n1,inf\n2,3\n"), HasSubstr("row 1, column 'v': the value is infinite"));
  EXPECT_THAT(message("n,w\n1,2\n"), HasSubstr("has no column 'v' (nearest: 'n')"));
}

TEST_F(TableTest, ManyRows) {
  std::string content = "i,v\n";
  for (int i = 0; i < 10'000; ++i) content += std::to_string(i) + ",0.5\n";
  const Table table = read_table(write("a.csv", content));
  ASSERT_EQ(table.rows, 10'000u);
  EXPECT_EQ(table.column("i").numbers[9'999], 9'999);
}

}  // namespace
}  // namespace wearwell
