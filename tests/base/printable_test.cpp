#include "wearwell/base/printable.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace wearwell {
namespace {

TEST(Printable, LeavesTextAsItIs) {
  for (const char* text : {"", "Pin joint, 90 %", "7.6 × 10⁻⁴ mm³/(N m)", "Verschleiß", "磨耗",
                           "a\\b", "\U0001f527"}) {
    EXPECT_EQ(printable(text), text);
    EXPECT_EQ(printable_lines(text), text);
  }
}

// ECMA-48: C0, DEL and C1, the latter in the two bytes that UTF-8 gives them.
TEST(Printable, ShowsControlCharacters) {
  EXPECT_EQ(printable("\x1b]0;owned\x07"), "\\x1b]0;owned\\x07");
  EXPECT_EQ(printable("\x1b[2J"), "\\x1b[2J");
  EXPECT_EQ(printable("a\rb\bc\x7f"), "a\\x0db\\x08c\\x7f");
  EXPECT_EQ(printable("\u009b31m"), "\\x9b31m");
  EXPECT_EQ(printable(std::string_view("a\0b", 3)), "a\\x00b");
  for (int c = 0; c < 0x20; ++c) {
    const std::string text(1, static_cast<char>(c));
    EXPECT_EQ(printable(text).size(), 4u) << c;
    EXPECT_EQ(printable_lines(text) == text, c == '\n') << c;
  }
}

// Unicode Standard Annex 9, table 4: what turns the order of letters round.
TEST(Printable, ShowsMarksOfDirection) {
  EXPECT_EQ(printable("a\u202eb\u2066c\u2069\u200f\u061c"),
            "a\\u202eb\\u2066c\\u2069\\u200f\\u061c");
  EXPECT_EQ(printable("a\u2028b"), "a\\u2028b");
}

// A byte of C1 by itself is one for terminals that are not in UTF-8; overlong forms hide controls.
TEST(Printable, ShowsBytesThatAreNoUtf8) {
  EXPECT_EQ(printable("\x9b[31m"), "\\x9b[31m");
  EXPECT_EQ(printable("Verschlei\xdf"), "Verschlei\\xdf");
  EXPECT_EQ(printable("\xc0\x9b"), "\\xc0\\x9b");
  EXPECT_EQ(printable("\xe0\x80\x9b"), "\\xe0\\x80\\x9b");
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");
  EXPECT_EQ(printable("\xe2\x80"), "\\xe2\\x80");
}

// RFC 8259, 7: any character may be written by its number, and means the same.
TEST(Printable, JsonReadsBackAsItWas) {
  const nlohmann::json json = {{"a\u202eb", "\x1b[31m\x7f\u009b \u00b5m \u200f\u2068"},
                               {"lines", 2}};
  const std::string text = json.dump(2), shown = printable_json(text);
  EXPECT_EQ(nlohmann::json::parse(shown), json);
  EXPECT_EQ(printable_lines(shown), shown);
  EXPECT_NE(shown.find("\\u202e"), std::string::npos);
  EXPECT_NE(shown.find("\u00b5m"), std::string::npos);
  EXPECT_EQ(printable_json("{\n  \"x\": 1\n}"), "{\n  \"x\": 1\n}");
}

TEST(Printable, KeepsLinesWhereTheyBelong) {
  EXPECT_EQ(printable("a\nTrusted."), "a\\x0aTrusted.");
  EXPECT_EQ(printable_lines("a\nb\t\x1b[1m"), "a\nb\\x09\\x1b[1m");
}

TEST(Printable, ShortensBetweenCharacters) {
  EXPECT_EQ(shortened("abc", 3), "abc");
  EXPECT_EQ(shortened("abcd", 3), "abc...");
  EXPECT_EQ(shortened("aß!", 2), "a...");
}

}  // namespace
}  // namespace wearwell
