#include "wearwell/study/table_scope.h"

#include <gmock/gmock.h>

#include <cmath>

#include "wearwell/study/column_values.h"

namespace wearwell {
namespace {

using testing::ElementsAre;
using testing::IsNan;

Table words(std::vector<std::string> cells) {
  Table table;
  table.rows = cells.size();
  Column column;
  column.name = "reading";
  column.text = std::move(cells);
  table.columns.push_back(std::move(column));
  return table;
}

TEST(TableScope, ReadsAColumnOnceAndAsWithoutIt) {
  const Table table = words({"3.5", "broken", "", ">7", "3.5"}), other = words({"1", "2"});
  const Column& column = table.columns.front();
  const auto expect_values = [&] {
    EXPECT_THAT(numbers_of(table, column), ElementsAre(3.5, IsNan(), IsNan(), IsNan(), 3.5));
    EXPECT_THAT(kinds_of(table, column), ElementsAre("3.5", "broken", ">7"));
  };
  expect_values();
  EXPECT_NE(shared_numbers(table, column), shared_numbers(table, column));
  {
    const TableScope once(table);
    expect_values();
    EXPECT_EQ(shared_numbers(table, column), shared_numbers(table, column));
    EXPECT_EQ(shared_kinds(table, column), shared_kinds(table, column));
    const TableScope inner(other);
    EXPECT_THAT(numbers_of(other, other.columns.front()), ElementsAre(1, 2));
    expect_values();
  }
  EXPECT_NE(shared_numbers(table, column), shared_numbers(table, column));
}

}  // namespace
}  // namespace wearwell
