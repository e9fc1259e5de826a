#include "wearwell/present/text_table.h"

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include <set>
#include <sstream>

namespace wearwell {
namespace {

using testing::HasSubstr;

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> all;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) all.push_back(line);
  return all;
}

std::size_t widest(const std::string& text) {
  std::size_t most = 0;
  for (const std::string& line : lines(text)) most = std::max(most, line.size());
  return most;
}

TEST(TextTable, AlignsNumbersRightAndWordsLeft) {
  EXPECT_EQ(text_table({{"", "mean", "sd"}, {"k", "7.5", "0.25"}, {"sigma", "10", "1"}}),
            "         mean    sd\n"
            "  k       7.5  0.25\n"
            "  sigma    10     1\n");
  EXPECT_EQ(
      text_table({{"check", "verdict", "found"}, {"a", "pass", "all is well"}, {"b", "fail", ""}},
                 true),
      "  check  verdict  found\n"
      "  a         pass  all is well\n"
      "  b         fail\n");
}

TEST(TextTable, CountsCharactersAndNotBytes) {
  EXPECT_EQ(text_table({{"°C", "1"}, {"ab", "22"}}),
            "  °C   1\n"
            "  ab  22\n");
}

TEST(TextTable, ARowOfOneCellIsAHeading) {
  EXPECT_EQ(text_table({{"", "x"}, {"of the shaft, under all that it bears"}, {"  B10", "1"}}),
            "         x\n"
            "  of the shaft, under all that it bears\n"
            "    B10  1\n");
}

TEST(TextTable, LongWordsAreFoldedBesideTheirNumbers) {
  std::string label = "allowed alternating stress";
  for (int i = 0; i < 12; ++i) label += " and more";
  const std::string text = text_table({{"", "5 %", "50 %"}, {label, "255.1", "263.4"}});
  EXPECT_LE(widest(text), text_width);
  ASSERT_GT(lines(text).size(), 2u);
  EXPECT_THAT(lines(text)[1], HasSubstr("255.1  263.4"));
  EXPECT_THAT(lines(text)[2], testing::StartsWith("    more"));
}

TEST(TextTable, TooManyColumnsStandBelowEachOther) {
  std::vector<std::vector<std::string>> rows = {{""}, {"k [mm^3/(N m)]"}};
  for (int c = 0; c < 30; ++c) {
    rows[0].push_back("column " + std::to_string(c));
    rows[1].push_back(std::to_string(c));
  }
  const std::string text = text_table(rows);
  EXPECT_LE(widest(text), text_width);
  for (const std::string& name : rows[0]) EXPECT_THAT(text, HasSubstr(name));
  int times = 0;
  for (const std::string& line : lines(text)) times += line.starts_with("  k [mm^3/(N m)]");
  EXPECT_GT(times, 3);
}

// Whatever stands in a table, no line is wider than the terminal but for one word that is, and no word
// is lost.
RC_GTEST_PROP(TextTable, FitsAndKeepsEveryWord, ()) {
  const int columns = *rc::gen::inRange(1, 12), rows = *rc::gen::inRange(1, 6);
  const bool words_last = *rc::gen::arbitrary<bool>() && columns <= 3;
  std::vector<std::vector<std::string>> cells;
  std::vector<std::string> all;
  for (int r = 0; r < rows; ++r) {
    cells.emplace_back();
    for (int c = 0; c < columns; ++c) {
      std::string cell;
      const bool words = c == 0 || (words_last && c + 1 == columns);
      for (int w = *rc::gen::inRange(1, words ? 40 : 3); w > 0; --w) {
        all.push_back(std::string(static_cast<std::size_t>(*rc::gen::inRange(1, 9)),
                                  static_cast<char>('a' + c)));
        cell += (cell.empty() ? "" : " ") + all.back();
      }
      cells.back().push_back(cell);
    }
  }
  const std::string text = text_table(cells, words_last);
  RC_ASSERT(widest(text) <= text_width);
  std::istringstream in(text);
  std::multiset<std::string> shown;
  for (std::string word; in >> word;) shown.insert(word);
  for (const std::string& word : all) {
    const auto found = shown.find(word);
    RC_ASSERT(found != shown.end());
    shown.erase(found);
  }
}

TEST(Wrapped, BreaksAtBlanksAndHangs) {
  std::string text;
  for (int i = 0; i < 60; ++i) text += "word" + std::to_string(i) + " ";
  const std::string out = wrapped(text, 2, 6);
  EXPECT_LE(widest(out), text_width);
  EXPECT_EQ(lines(out)[0].find_first_not_of(' '), 2u);
  EXPECT_EQ(lines(out)[1].find_first_not_of(' '), 6u);
  EXPECT_EQ(wrapped("short"), "short\n");
  EXPECT_EQ(wrapped(""), "\n");
}

}  // namespace
}  // namespace wearwell
