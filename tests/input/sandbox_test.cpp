// A study from a stranger holds SQL: it may read the one file that is its data, and no more.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <fstream>

#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/input/column_stream.h"
#include "wearwell/input/table.h"

namespace wearwell {
namespace {

using testing::AnyOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

class SandboxTest : public ScratchTest {
 protected:
  std::string refusal(const std::string& sql, const QueryLimits& limits = {}) {
    return message_of<QueryError>([&] { read_table(data(), sql, limits); });
  }
  fs::path data() { return write("a.csv", "x,y\n1,2\n3,4\n"); }
  int files() const {
    return static_cast<int>(std::distance(fs::directory_iterator(folder()), {}));
  }
};

TEST_F(SandboxTest, WritesNothing) {
  const std::string target = (folder() / "owned").string();
  for (const std::string& sql :
       {fmt::format("copy (select 1) to '{}'", target),
        fmt::format("select * from data; copy (select 1) to '{}'", target),
        fmt::format("copy data to '{}' (format parquet); select * from data", target),
        fmt::format("attach '{}' as other", target), fmt::format("export database '{}'", target),
        fmt::format("select * from query('copy (select 1) to ''{}''')", target),
        fmt::format("with a as (select 1) select * from data; attach '{}'", target),
        fmt::format("explain analyze copy (select 1) to '{}'", target),
        fmt::format("create table t as select 1"), fmt::format("insert into data values (1, 2)"),
        fmt::format("drop view data"), fmt::format("checkpoint")}) {
    EXPECT_THAT(refusal(sql), HasSubstr("a.csv (through sql): ")) << sql;
    EXPECT_EQ(files(), 1) << sql;
  }
}

TEST_F(SandboxTest, ReadsNothingElse) {
  const std::string other = write("other.csv", "secret\n42\n").string();
  for (const char* read :
       {"select * from '{}'", "select * from read_csv('{}')", "select * from read_text('{}')",
        "select * from read_blob('{}')", "select * from glob('{}')",
        "select * from sniff_csv('{}')", "select * from read_json('{}')",
        "select * from read_parquet('{}')", "select * from parquet_metadata('{}')",
        "select (select content from read_text('{}')) as x from data",
        "select * from query('from read_text(''{}'')')", "select * from query_table('{}')",
        "from read_csv(['{0}', '{0}'])"}) {
    const std::string message = refusal(fmt::format(fmt::runtime(read), other));
    EXPECT_THAT(message, AnyOf(HasSubstr("only the data file"), HasSubstr("there is no table")))
        << read;
    EXPECT_THAT(message, Not(HasSubstr("42"))) << read;
  }
  EXPECT_THAT(refusal("select * from read_text('/etc/passwd')"), HasSubstr("/etc/passwd"));
  EXPECT_THAT(refusal("select * from 'https://127.0.0.1/x.csv'"), HasSubstr("only the data file"));
}

TEST_F(SandboxTest, ChangesNoSettings) {
  for (const char* sql :
       {"set enable_external_access = true", "set memory_limit = '1TB'", "reset lock_configuration",
        "set global allowed_directories = ['/']", "pragma enable_external_access",
        "pragma memory_limit='1TB'", "install httpfs", "load httpfs", "call pragma_version()",
        "use data", "begin", "prepare q as select 1", "execute q", "deallocate q", "vacuum"})
    EXPECT_NE(refusal(sql), "") << sql;
}

TEST_F(SandboxTest, IsOneSelect) {
  EXPECT_THAT(refusal("select x from data; select y from data"), HasSubstr("must be one SELECT"));
  EXPECT_THAT(refusal("explain select * from data"), HasSubstr("must be one SELECT"));
  EXPECT_THAT(refusal(""), HasSubstr("it is empty"));
  EXPECT_THAT(refusal("-- nothing"), HasSubstr("it is empty"));
  EXPECT_THAT(refusal("select ?"), HasSubstr("parameter"));
  for (const char* sql : {"select x, y from data;", "from data", "with d as (from data) from d",
                          "select x, y from data -- all", "(select x, y from data)"})
    EXPECT_EQ(read_table(data(), sql).rows, 2u) << sql;
}

TEST_F(SandboxTest, SaysWhatIsWrongWithoutDuckDBsClasses) {
  const auto expect = [&](const char* sql, const char* part) {
    EXPECT_THAT(refusal(sql), HasSubstr(part)) << sql;
    EXPECT_THAT(refusal(sql), Not(HasSubstr("Error:"))) << sql;
  };
  expect("select volume from data", "\"volume\" not found");
  expect("select * from runs", "no table 'runs'; the file is the table 'data'");
  expect("selekt x from data", "syntax error at or near \"selekt\"");
  expect("select spread(x) from data", "spread does not exist");
  expect("select * from sqlite_scan('a', 'b')", "SQL extensions are disabled");
}

TEST_F(SandboxTest, EndsAQueryThatDoesNot) {
  const QueryLimits limits{0.2};
  EXPECT_THAT(refusal("with recursive t(n) as (select 1 union all select n + 1 from t) "
                      "select count(*) as x from t",
                      limits),
              AnyOf(HasSubstr("time limit of 0.2 seconds"), HasSubstr("memory limit")));
  EXPECT_THAT(
      refusal("select count(*) as x from range(10000000) a, range(10000000) b where a.range < "
              "b.range + x",
              limits),
      Not(HasSubstr("internal")));
}

// Names of files are no patterns, and folders make no columns.
TEST_F(SandboxTest, ReadsExactlyTheNamedFile) {
  write("data1.csv", "x\n1\n");
  write("run1.csv", "x\n1\n");
  write("run2.csv", "x\n2\n");
  EXPECT_THAT(read_table(write("data[1].csv", "x\n9\n")).columns[0].numbers, ElementsAre(9));
  EXPECT_THAT(read_table(write("run*.csv", "x\n7\n")).columns[0].numbers, ElementsAre(7));
  EXPECT_THAT(read_table(write("what?.csv", "x\n6\n")).columns[0].numbers, ElementsAre(6));
  EXPECT_THAT(read_table(write("it's 'x'.csv", "x\n5\n")).columns[0].numbers, ElementsAre(5));
  EXPECT_THAT(message_of<InputError>([&] { read_table(folder() / "run[12].csv"); }),
              HasSubstr("no such file"));
  fs::create_directories(folder() / "x=3" / "cycles=77");
  const Table table = read_table(write("x=3/cycles=77/a.csv", "x,y\n1,2\n"));
  ASSERT_EQ(table.columns.size(), 2u);
  EXPECT_THAT(table.columns[0].numbers, ElementsAre(1));

  fs::copy(PROJECT_SOURCE_DIR "/tests/input/two_columns.parquet",
           folder() / "x=3" / "a[0]*.parquet");
  ColumnStream stream(folder() / "x=3" / "a[0]*.parquet");
  EXPECT_THAT(stream.headings(), ElementsAre("x", "y"));
  stream.select({"x"});
  ColumnStream::Batch batch;
  ASSERT_TRUE(stream.next(batch));
  EXPECT_THAT(batch.columns[0], ElementsAre(1, 3));
}

TEST_F(SandboxTest, NamesAreBytes) {
  const Table table =
      read_table(write("gr\xF6\xDF"
                       "e.csv",
                       "x\n4\n"));
  EXPECT_THAT(table.columns[0].numbers, ElementsAre(4));
  EXPECT_THAT(table.source, HasSubstr("gr\xEF\xBF\xBD\xEF\xBF\xBD"
                                      "e.csv"));
}

}  // namespace
}  // namespace wearwell
