#include "wearwell/fleet/dialect.h"

#include <gmock/gmock.h>

#include "support/scratch.h"
#include "wearwell/base/error.h"

namespace wearwell::fleet {
namespace {

using testing::HasSubstr;

TEST(Dialect, NamesHoldWhateverStandsInThem) {
  EXPECT_EQ(identifier(Dialect::duckdb, "cycle"), "\"cycle\"");
  EXPECT_EQ(identifier(Dialect::duckdb, "a\"; drop table x; --"), "\"a\"\"; drop table x; --\"");
  EXPECT_EQ(identifier(Dialect::postgresql, "a\\\"b"), "\"a\\\"\"b\"");
  EXPECT_EQ(identifier(Dialect::clickhouse, "a\\\"b"), "\"a\\\\\\\"b\"");
}

TEST(Dialect, NamesThatAnEngineCannotHoldAreRefused) {
  EXPECT_THAT(message_of<InputError>([] { identifier(Dialect::duckdb, ""); }), HasSubstr("empty"));
  EXPECT_THAT(
      message_of<InputError>([] { identifier(Dialect::duckdb, std::string_view("a\0b", 3)); }),
      HasSubstr("zero byte"));
  const std::string longest(63, 'x');
  EXPECT_EQ(identifier(Dialect::postgresql, longest), '"' + longest + '"');
  EXPECT_THAT(message_of<InputError>([&] { identifier(Dialect::postgresql, longest + "x"); }),
              HasSubstr("cuts names off at 63"));
}

TEST(Dialect, ATableLiesInSchemas) {
  EXPECT_EQ(table_identifier(Dialect::duckdb, "cycles"), "\"cycles\"");
  EXPECT_EQ(table_identifier(Dialect::duckdb, "fleet.cycles"), "\"fleet\".\"cycles\"");
  EXPECT_EQ(table_identifier(Dialect::duckdb, "\"a.b\".c"), "\"a.b\".\"c\"");
  EXPECT_EQ(table_identifier(Dialect::duckdb, "\"a\"\"b\""), "\"a\"\"b\"");
  EXPECT_EQ(table_identifier(Dialect::duckdb, "a; drop table b"), "\"a; drop table b\"");
  for (const char* wrong : {"", ".", "a.", ".a", "\"a", "\"a\"b", "a..b"})
    EXPECT_THROW(table_identifier(Dialect::duckdb, wrong), InputError) << wrong;
}

TEST(Dialect, TextsEndWhereTheyEnd) {
  EXPECT_EQ(literal(Dialect::duckdb, "it's"), "'it''s'");
  EXPECT_EQ(literal(Dialect::duckdb, "a\\'"), "'a\\'''");
  EXPECT_EQ(literal(Dialect::postgresql, "a\\'"), " E'a\\\\'''");
  EXPECT_EQ(literal(Dialect::clickhouse, "a\\'"), "'a\\\\\\''");
}

TEST(Dialect, NumbersAreDoublesWithAllTheirDigits) {
  EXPECT_EQ(number(1), "1e0");
  EXPECT_EQ(number(0.1), "0.1e0");
  EXPECT_EQ(number(-2.5e-20), "(-2.5e-20)");
  EXPECT_EQ(std::stod(number(1.0 / 3)), 1.0 / 3);
}

TEST(Dialect, ACommentHasOneLine) {
  EXPECT_EQ(comment("a\n; drop table x"), "-- a\\x0a; drop table x\n");
}

TEST(Dialect, UnknownDialectsAreRefused) {
  EXPECT_EQ(read_dialect("postgresql"), Dialect::postgresql);
  EXPECT_THROW(read_dialect("mysql"), InputError);
}

}  // namespace
}  // namespace wearwell::fleet
