#include "wearwell/base/shown.h"

#include "wearwell/base/printable.h"

#include <gmock/gmock.h>

#include <string>

namespace wearwell {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::SizeIs;
using testing::StartsWith;

TEST(Shown, OrdinaryMessagesStay) {
  for (const char* message :
       {"a.csv, row 3, column 'volume': 'abc' is not a number", "no such file: it's.csv",
        "2 \xC2\xB5m \xE2\x89\xA4 5 \xF0\x9F\x94\xA7", ""})
    EXPECT_EQ(shown(message), message);
}

TEST(Shown, NothingReachesTheTerminalButText) {
  EXPECT_EQ(shown("a\x1b[31mb\x07\x7f"), "a\\x1b[31mb\\x07\\x7f");
  EXPECT_EQ(shown("a\xC2\x9B"
                  "31m"),
            "a\\x9b31m");
  EXPECT_EQ(shown("two\nlines\tand"), "two lines and");
  EXPECT_EQ(shown(std::string("nul\0.", 5)), "nul\\x00.");
}

TEST(Shown, AnExcerptWithACaretKeepsItsLines) {
  EXPECT_EQ(shown("law: two\nlines\n    a  +\x1b b\n       ^"),
            "law: two lines\n    a  +\\x1b b\n       ^");
  EXPECT_EQ(shown("study.toml:1:1: no\n    a\n    ^\n    right: b\n    c\n    ^"),
            "study.toml:1:1: no\n    a\n    ^\n    right: b\n    c\n    ^");
  const std::string excerpt = "\n    a\n    ^";
  std::string many;
  for (int i = 0; i < 479; ++i) many += "word ";
  EXPECT_EQ(shown(many + excerpt), many);
  EXPECT_EQ(shown(many.substr(100) + excerpt), many.substr(100) + excerpt);
  EXPECT_EQ(shown("a\n    ^\n    b"), "a     ^     b");
  EXPECT_EQ(shown("a\nwearwell: b\n    ^"), "a wearwell: b     ^");
  EXPECT_EQ(shown("a\n    b\n c  ^"), "a     b  c  ^");
  EXPECT_EQ(shown("a\n    ^"), "a     ^");
}

TEST(Shown, AnExampleKeepsItsLines) {
  EXPECT_EQ(
      shown(
          "a.toml:1:1: source: is missing; for example:\n    [source.line]\n    kind = \"x\x1b\""),
      "a.toml:1:1: source: is missing; for example:\n    [source.line]\n    kind = \"x\\x1b\"");
  EXPECT_EQ(shown("is missing; for example:\nwearwell: b"), "is missing; for example: wearwell: b");
  EXPECT_EQ(shown("is missing, like this:\n    [a]\n    b = 1"),
            "is missing, like this:     [a]     b = 1");
}

// RFC 3629: what is no UTF-8 (a lone byte, an overlong form, a surrogate, beyond U+10FFFF, cut).
TEST(Shown, WhatIsNoUtf8IsReplacedByteByByte) {
  const std::string no = "\xEF\xBF\xBD";
  EXPECT_EQ(valid_utf8("Gr\xF6\xDF"
                       "e"),
            "Gr" + no + no + "e");
  EXPECT_EQ(valid_utf8("\xC0\xAF"), no + no);
  EXPECT_EQ(valid_utf8("\xED\xA0\x80"), no + no + no);
  EXPECT_EQ(valid_utf8("\xF4\x90\x80\x80"), no + no + no + no);
  EXPECT_EQ(valid_utf8("a\xE2\x82"), "a" + no + no);
  EXPECT_EQ(valid_utf8("\xE2\x82\xAC"), "\xE2\x82\xAC");
}

TEST(Shown, LongValuesAreCut) {
  const std::string value(10'000, 'x');
  EXPECT_EQ(
      shown("f.toml:1:5: law: '" + value + "' is not possible"),
      "f.toml:1:5: law: '" + std::string(60, 'x') + "... (10000 characters)' is not possible");
  EXPECT_THAT(shown("key " + value + " is unknown"),
              EndsWith("x... (10000 characters) is unknown"));
  std::string many;
  for (int i = 0; i < 10'000; ++i) many += "word ";
  EXPECT_THAT(shown(many), SizeIs(testing::Lt(2500U)));
  EXPECT_THAT(shown(many), EndsWith("... (50000 characters)"));
  // Between characters, not within.
  std::string euros = "a";
  for (int i = 0; i < 500; ++i) euros += "\xE2\x82\xAC";
  EXPECT_EQ(valid_utf8(shown("'" + euros + "'")), shown("'" + euros + "'"));
}

TEST(Shown, NoClassesOfTheJsonLibrary) {
  EXPECT_EQ(shown("m.json: [json.exception.out_of_range.403] key 'map' not found"),
            "m.json: key 'map' not found");
  EXPECT_EQ(shown("[json.exception."), "");
}

}  // namespace
}  // namespace wearwell
