#include "wearwell/embed/memory_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace wearwell::embed {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

Column numbers(const std::string& name, std::vector<double> values) {
  return {.name = name, .is_number = true, .numbers = std::move(values), .text = {}};
}

TEST(MemoryTable, ColumnsHaveEquallyManyRows) {
  Table table{.source = "data", .columns = {}};
  add_column(table, numbers("F", {1, 2, 3}));
  EXPECT_EQ(table.rows, 3U);
  EXPECT_THAT(
      [&] {
        add_column(table, numbers("V", {1, 2}));
      },
      ThrowsMessage<InputError>("data: column 'V' has 2 rows, and 'F' has 3"));
}

TEST(MemoryTable, WhatIsNoTableIsRefused) {
  Table table{.source = "data", .columns = {}};
  EXPECT_THAT([&] { refuse_no_table(table); }, ThrowsMessage<InputError>("data has no columns"));
  add_column(table, numbers("F", {}));
  EXPECT_THAT([&] { refuse_no_table(table); }, ThrowsMessage<InputError>("data has no rows"));
  Table twice{.source = "data", .columns = {}};
  add_column(twice, numbers("F", {1}));
  add_column(twice, numbers("s", {1}));
  EXPECT_NO_THROW(refuse_no_table(twice));
  add_column(twice, numbers("F", {1}));
  EXPECT_THAT([&] { refuse_no_table(twice); },
              ThrowsMessage<InputError>("data: two columns are called 'F'"));
}

TEST(MemoryTable, UnitsGoToTheirColumns) {
  Table table{.source = "data", .columns = {}};
  add_column(table, numbers("F", {1}));
  add_column(table, numbers("s", {1}));
  add_units(table, {{"s", "km"}});
  EXPECT_EQ(table.column("s").unit, "km");
  EXPECT_EQ(table.column("F").unit, "");
  EXPECT_THAT([&] { add_units(table, {{"G", "N"}}); }, ThrowsMessage<InputError>(HasSubstr("'G'")));
}

}  // namespace
}  // namespace wearwell::embed
