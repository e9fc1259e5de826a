#include "wearwell/present/html.h"

#include <gmock/gmock.h>

#include <limits>

namespace wearwell::html {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(Html, EscapesMarkup) {
  EXPECT_EQ(escape("<b>\"A & B's\"</b>"), "&lt;b&gt;&quot;A &amp; B&#39;s&quot;&lt;/b&gt;");
}

TEST(Html, WritesNumbersAsPeopleDo) {
  EXPECT_EQ(number(0.7759), "0.7759");
  EXPECT_EQ(number(95.288), "95.29");
  EXPECT_EQ(number(21602.3), "21\u202f600");
  EXPECT_EQ(number(-6.7314), "−6.731");
  EXPECT_EQ(number(7.7589e-4), "7.759\u00a0×\u00a010⁻⁴");
  EXPECT_EQ(number(0), "0");
  EXPECT_EQ(number(std::numeric_limits<double>::infinity()), "–");
  EXPECT_EQ(number(std::numeric_limits<double>::quiet_NaN()), "–");
}

TEST(Html, KeepsEveryDigitOfWhatWasGiven) {
  EXPECT_EQ(given(20585), "20\u202f585");
  EXPECT_EQ(given(1), "1");
  EXPECT_EQ(given(0.5), "0.5");
  EXPECT_EQ(given(100), "100");
  EXPECT_EQ(given(2.5e-5), "2.5\u00a0×\u00a010⁻⁵");
}

TEST(Html, WritesOnePowerOfTenForARange) {
  EXPECT_EQ(range(6.2988e-4, 9.2198e-4), "6.299 to 9.220\u00a0×\u00a010⁻⁴");
  EXPECT_EQ(range(-7.01, 30.956), "−7.010 to 30.96");
}

TEST(Html, RaisesPowersOfUnits) {
  EXPECT_EQ(unit("mm^3/(N m)"), "mm³/(N\u00a0m)");
  EXPECT_EQ(unit("m^-1"), "m⁻¹");
  EXPECT_EQ(unit("1e5 cycles"), "×\u00a010⁵\u00a0cycles");
  EXPECT_EQ(raised("a N^b"), "a N^b");
  EXPECT_EQ(unit("1"), "");
  EXPECT_EQ(raised("from 5.6 mm^3 to 6 mm^3"), "from 5.6 mm³ to 6 mm³");
}

TEST(Html, TableNamesColumnsAndRows) {
  const std::string markup = table({"Lives", {"Part", "B10"}, {{"pin", "5"}}});
  EXPECT_THAT(markup, HasSubstr("<caption>Lives</caption>"));
  EXPECT_THAT(markup, HasSubstr("<th scope=\"col\">B10</th>"));
  EXPECT_THAT(markup, HasSubstr("<th scope=\"row\">pin</th><td>5</td>"));
}

TEST(Html, NothingInATableIsMarkup) {
  const std::string evil = "<img src=x onerror=alert(1)>";
  const std::string markup =
      table({evil, {evil, evil}, {{evil, evil + "\n" + evil}}, false, {evil}});
  EXPECT_THAT(markup, Not(HasSubstr("<img")));
  EXPECT_THAT(markup, HasSubstr("&lt;img src=x onerror=alert(1)&gt;<br><em>&lt;img"));
}

TEST(Html, TablesPaintUnitsAdviceAndVerdicts) {
  const std::string markup = table({"Checks",
                                    {"Life [h]", "Verdict"},
                                    {{"k [mm³]", "Passed"}, {"b", "Failed\nDraw more."}},
                                    true,
                                    {"pass", "fail"}});
  EXPECT_THAT(markup, HasSubstr("<th scope=\"col\">Life <span class=\"unit\">[h]</span></th>"));
  EXPECT_THAT(markup, HasSubstr("<th scope=\"row\">k <span class=\"unit\">[mm³]</span></th>"));
  EXPECT_THAT(markup, HasSubstr("<td><span class=\"badge pass\">Passed</span></td>"));
  EXPECT_THAT(markup, HasSubstr("Failed<br><em>Draw more.</em>"));
}

TEST(Html, ShowsControlCharacters) {
  EXPECT_EQ(escape("a\x1b[2Jb\u202ec\td\n"), "a\\x1b[2Jb\\u202ec\td\n");
}

// The ends of what doubles can hold.
TEST(Html, WritesAnyNumber) {
  EXPECT_EQ(number(5e-324), "4.941\u00a0×\u00a010⁻³²⁴");
  EXPECT_EQ(number(-1.7976931348623157e308), "−1.798\u00a0×\u00a010³⁰⁸");
  EXPECT_EQ(given(5e-324), "4.94065646\u00a0×\u00a010⁻³²⁴");
  EXPECT_EQ(range(5e-324, 1e-323), "4.941 to 9.881\u00a0×\u00a010⁻³²⁴");
}

// A specification stands in a script element, which ends at the first "</script" whatever the
// quotes around it.
TEST(Html, NothingInAFigureEndsItsScript) {
  const std::string evil = "</script><script>alert(1)</script><!--";
  const std::string markup = figures({{"id", evil, evil, {{"description", evil}}}});
  const std::string begin = "<script type=\"application/json\">";
  const std::size_t at = markup.find(begin) + begin.size();
  const std::string json = markup.substr(at, markup.find("</script>", at) - at);
  EXPECT_EQ(nlohmann::json::parse(json)["description"], evil);
  EXPECT_THAT(markup, Not(HasSubstr("<script>")));
  EXPECT_THAT(markup, Not(HasSubstr("<!--")));
}

}  // namespace
}  // namespace wearwell::html
