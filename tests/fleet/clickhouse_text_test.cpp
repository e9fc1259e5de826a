#include "wearwell/fleet/clickhouse_text.h"

#include <gmock/gmock.h>

#include <cmath>

#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/fleet/clickhouse_address.h"

namespace wearwell::fleet {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

// As servers of 18.16 and of today say it.
TEST(ClickhouseText, ErrorsAreOneSentence) {
  const std::string old =
      "Code: 60, e.displayText() = DB::Exception: Table default.x doesn't exist., e.what() = "
      "DB::Exception\n";
  EXPECT_EQ(error_code(old), 60);
  EXPECT_EQ(error_sentence(old), "Table default.x doesn't exist");
  const std::string today =
      "Code: 60. DB::Exception: Unknown table expression identifier 'x' in scope SELECT. "
      "(UNKNOWN_TABLE) (version 25.8.1 (official build))\n";
  EXPECT_EQ(error_code(today), 60);
  EXPECT_THAT(error_sentence(today), AllOf(HasSubstr("identifier 'x'"), Not(HasSubstr("version"))));
  const std::string dead =
      "Code: 279, e.displayText() = DB::NetException: All connection tries failed. Log: \n\nCode: "
      "210, e.displayText() = DB::NetException: Connection refused (127.0.0.2:19000), e.what() = "
      "DB::NetException\n\n, e.what() = DB::NetException";
  EXPECT_EQ(error_code(dead), 279);
  EXPECT_EQ(error_sentence(dead),
            "All connection tries failed: Connection refused (127.0.0.2:19000)");
  EXPECT_EQ(error_sentence("what\x1b[31m"), "what\\x1b[31m");
  EXPECT_EQ(error_code(""), 0);
}

TEST(ClickhouseText, SemicolonsWithinQuotesEndNothing) {
  EXPECT_THAT(single_statements("-- a; b\nset x = 1;\nselect ';', \"a;\\\"b\", `;`;\n\n"),
              ElementsAre("set x = 1", "select ';', \"a;\\\"b\", `;`"));
  EXPECT_THAT(single_statements(" ; "), ElementsAre());
}

TEST(ClickhouseText, RowsArriveInPieces) {
  const std::string all = "a\\tb\\\\\t1.5\n\\N\tnan\n";
  for (std::size_t cut = 0; cut <= all.size(); ++cut) {
    std::vector<std::vector<std::string>> rows;
    SeparatedText text;
    for (const std::string& piece : {all.substr(0, cut), all.substr(cut)})
      text.add(piece, [&](const auto& cells) { rows.push_back(cells); });
    ASSERT_TRUE(text.at_end());
    EXPECT_THAT(rows, ElementsAre(ElementsAre("a\tb\\", "1.5"), ElementsAre("", "nan")));
  }
  SeparatedText cut;
  cut.add("a\t1", [](const auto&) { FAIL(); });
  EXPECT_FALSE(cut.at_end());
  EXPECT_EQ(separated_number("-2.5e-20"), -2.5e-20);
  EXPECT_TRUE(std::isnan(separated_number("")));
  EXPECT_THROW(separated_number("1x"), InputError);
}

TEST(ClickhouseAddress, IsTakenApart) {
  const ClickhouseAddress plain = read_clickhouse_address("clickhouse://db1");
  EXPECT_EQ(plain.user, "default");
  EXPECT_EQ(plain.database, "default");
  ASSERT_EQ(plain.hosts.size(), 1u);
  EXPECT_EQ(plain.hosts[0].port, "8123");
  const ClickhouseAddress all =
      read_clickhouse_address("clickhouses://me:a%40%2Fb@db1:9,[::1],db3/fleet%20one");
  EXPECT_EQ(all.user, "me");
  EXPECT_EQ(all.password, "a@/b");
  EXPECT_EQ(all.database, "fleet one");
  ASSERT_EQ(all.hosts.size(), 3u);
  EXPECT_EQ(all.hosts[0].port, "9");
  EXPECT_EQ(all.hosts[1].host, "::1");
  EXPECT_EQ(all.hosts[2].port, "8443");
  EXPECT_TRUE(all.hosts[2].tls);
  for (const char* wrong :
       {"clickhouse://", "clickhouse://:8123", "clickhouse://a:x", "clickhouse://a:70000",
        "clickhouse://a,,b", "clickhouse://u:top%4@a", "clickhouse://u:to%0ap@a",
        "clickhouse://a/b/c", "clickhouse://a?x=1", "clickhouse://u:top@a b"})
    EXPECT_THAT(message_of<InputError>([&] { read_clickhouse_address(wrong); }),
                AllOf(HasSubstr("--engine"), Not(HasSubstr("top"))))
        << wrong;
  EXPECT_EQ(url_part("a b&c=1"), "a%20b%26c%3D1");
}

}  // namespace
}  // namespace wearwell::fleet
