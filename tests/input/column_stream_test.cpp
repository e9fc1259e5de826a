#include "wearwell/input/column_stream.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <sched.h>

#include <cmath>

#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/input/table.h"

namespace wearwell {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class ColumnStreamTest : public ScratchTest {
 protected:
  /// Everything that comes, column by column.
  static std::vector<std::vector<double>> read(const std::filesystem::path& file,
                                               const std::vector<std::string>& columns) {
    ColumnStream stream(file);
    stream.select(columns);
    std::vector<std::vector<double>> all(columns.size());
    ColumnStream::Batch batch;
    while (stream.next(batch)) {
      EXPECT_EQ(batch.first_row, all[0].size());
      for (std::size_t c = 0; c < columns.size(); ++c) {
        EXPECT_EQ(batch.columns[c].size(), batch.rows);
        all[c].insert(all[c].end(), batch.columns[c].begin(), batch.columns[c].end());
      }
    }
    return all;
  }
};

TEST_F(ColumnStreamTest, ReadsAllRowsInOrder) {
  std::string content = "i,v,note\n";
  constexpr int rows = 100'000;
  for (int i = 0; i < rows; ++i) content += fmt::format("{},{},x\n", i, i * 0.5);
  const auto all = read(write("a.csv", content), {"v", "i"});
  ASSERT_EQ(all[0].size(), static_cast<std::size_t>(rows));
  for (std::size_t i = 0; i < rows; ++i) {
    ASSERT_EQ(all[1][i], static_cast<double>(i));
    ASSERT_EQ(all[0][i], 0.5 * static_cast<double>(i));
  }
}

TEST_F(ColumnStreamTest, ReadsParquetAndHeadings) {
  const std::filesystem::path file = PROJECT_SOURCE_DIR "/tests/input/two_columns.parquet";
  EXPECT_THAT(ColumnStream(file).headings(), ElementsAre("x", "y"));
  EXPECT_THAT(read(file, {"y"})[0], ElementsAre(2.5, 4.5));
}

TEST_F(ColumnStreamTest, MissingValuesAreNaN) {
  const auto v = read(write("a.csv", "i,v\n1,2\n2,\n3,4\n"), {"v"})[0];
  ASSERT_EQ(v.size(), 3u);
  EXPECT_EQ(v[0], 2);
  EXPECT_TRUE(std::isnan(v[1]));
}

TEST_F(ColumnStreamTest, RefusesByName) {
  const auto refused = [&](const std::filesystem::path& file, const char* column) {
    return message_of<InputError>([&] { read(file, {column}); });
  };
  EXPECT_THAT(refused(folder() / "none.csv", "v"), HasSubstr("no such file"));
  EXPECT_THAT(refused(write("e.csv", ""), "v"), HasSubstr("is empty"));
  EXPECT_THAT(refused(write("h.csv", "v\n"), "v"), HasSubstr("h.csv has no rows"));
  EXPECT_THAT(refused(write("t.csv", "v\none\ntwo\n"), "v"),
              HasSubstr("column 'v' does not hold numbers"));
  // Far down, after the type of the column was guessed.
  std::string content = "v\n";
  for (int i = 0; i < 60'000; ++i) content += "1.5\n";
  EXPECT_THAT(refused(write("late.csv", content + "oops\n2\n"), "v"), HasSubstr("60002"));
}

/// All threads of this process on the processors of the set; on one, they wait for each other.
void run_on(const cpu_set_t& processors) {
  for (const auto& thread : std::filesystem::directory_iterator("/proc/self/task"))
    sched_setaffinity(std::stoi(thread.path().filename()), sizeof processors, &processors);
}

// DuckDB's threads work ahead of the rows that were asked for, and whoever throws before the last row
// leaves them at it.
TEST_F(ColumnStreamTest, IsLeftWhileItsThreadsWork) {
  cpu_set_t all, one;
  ASSERT_EQ(sched_getaffinity(0, sizeof all, &all), 0);
  CPU_ZERO(&one);
  for (std::size_t i = 0; CPU_COUNT(&one) == 0; ++i) {
    if (CPU_ISSET(i, &all)) CPU_SET(i, &one);
  }
  std::vector<std::string> names;
  for (int c = 0; c < 20; ++c) names.push_back(fmt::format("c{}", c));
  std::string content = fmt::format("{}\n", fmt::join(names, ","));
  const std::string row = fmt::format("{}\n", fmt::join(std::vector(names.size(), 7), ","));
  for (int i = 0; i < 20'000; ++i) content += row;
  const auto file = write("a.csv", content);
  for (int i = 0; i < 40; ++i) {
    const auto leave = [&] {
      ColumnStream stream(file);
      run_on(one);
      stream.select(names);
      ColumnStream::Batch batch;
      for (int batches = 1 + i % 4; batches > 0; --batches) ASSERT_TRUE(stream.next(batch));
      throw InputError("enough");
    };
    EXPECT_EQ(message_of<InputError>(leave), "enough");
    run_on(all);
  }
}

}  // namespace
}  // namespace wearwell
