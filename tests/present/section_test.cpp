#include "wearwell/present/section.h"

#include <gmock/gmock.h>

#include <cmath>

namespace wearwell::present {
namespace {

using testing::HasSubstr;
using testing::Not;

Table lives(std::size_t rows) {
  Table table{"lives",
              "Lives",
              {{"Quantity"}, {"Unit"}, {"Of"}, {"50 %"}, {"B10"}, {"Range", "h", {}, true}}};
  for (std::size_t i = 0; i < rows; ++i)
    table.rows.push_back({"life", "mm^3/(N m)", "pump", 5.0, std::nan(""), Range{NAN, NAN}});
  return table;
}

std::string page_of(Block block) {
  return html_of(Section{"s", "S", {std::move(block)}});
}

TEST(Section, ATableShowsNoColumnWithoutContent) {
  Table table = lives(2);
  std::string page = page_of({table});
  EXPECT_THAT(page, Not(HasSubstr("B10")));
  EXPECT_THAT(page, Not(HasSubstr("Range")));
  EXPECT_THAT(page, HasSubstr("50 %"));
  table.rows[1][4] = 3.0;
  page = page_of({table});
  EXPECT_THAT(page, HasSubstr("B10"));
  EXPECT_THAT(page, HasSubstr("<td>–</td>"));
}

TEST(Section, AUnitStandsWithWhatItIsOf) {
  const std::string page = page_of({lives(1)});
  EXPECT_THAT(page, HasSubstr("life <span class=\"unit\">[mm³/(N\u00a0m)]</span>"));
  EXPECT_THAT(page, Not(HasSubstr(">Unit<")));
}

TEST(Section, TextMayWrapAndNumbersMayNot) {
  const std::string page = page_of({lives(1)});
  EXPECT_THAT(page, HasSubstr("<td class=\"text\">pump</td>"));
  EXPECT_THAT(page, HasSubstr("<td>5.000</td>"));
  // A name without an end breaks anywhere, a word of a language nowhere.
  Table table = lives(2);
  for (auto& row : table.rows)
    for (auto& cell : row)
      if (const auto* text = std::get_if<std::string>(&cell); text && *text == "pump")
        cell = std::string(17, 'p');
  EXPECT_THAT(page_of({table}),
              HasSubstr("<td class=\"text long\">" + std::string(17, 'p') + "</td>"));
}

TEST(Section, ALongTableIsFolded) {
  EXPECT_THAT(page_of({lives(most_rows_open)}), Not(HasSubstr("<details>")));
  const std::string page = page_of({lives(most_rows_open + 1)});
  EXPECT_THAT(page, HasSubstr("<details><summary>Lives (13 rows)</summary>"));
  Table words = lives(most_rows_open + 1);
  words.words = true;
  EXPECT_THAT(page_of({words}), Not(HasSubstr("<details>")));
  // What is folded already is not folded twice.
  EXPECT_THAT(page_of({Details{"more", {{lives(most_rows_open + 1)}}}}), Not(HasSubstr("13 rows")));
}

TEST(Section, SmallMultiplesHaveOneTitleAndCaption) {
  std::vector<html::Figure> figures;
  for (const char* name : {"a", "b", "c"}) {
    html::Figure figure{name, std::string("Unit ") + name, "On common axes.", {}};
    figure.panel_of = "Wear of each unit";
    figures.push_back(figure);
  }
  figures.push_back({"d", "Alone", "Its own.", {}});
  const std::string page = page_of({Figures{figures}});
  const auto count = [&](const std::string& words) {
    std::size_t found = 0;
    for (std::size_t at = 0; (at = page.find(words, at)) != page.npos; ++at) ++found;
    return found;
  };
  EXPECT_EQ(count("<h3>Wear of each unit</h3>"), 1u);
  EXPECT_EQ(count("On common axes."), 1u);
  EXPECT_EQ(count("<figure"), 4u);
  EXPECT_THAT(page, HasSubstr("<h4>Unit b</h4>"));
  EXPECT_THAT(page, HasSubstr("<h3>Alone</h3>"));
}

}  // namespace
}  // namespace wearwell::present
