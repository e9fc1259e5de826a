#include "wearwell/input/date_text.h"

#include <gmock/gmock.h>

#include "support/scratch.h"

namespace wearwell {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

Column texts(std::vector<std::string> cells) {
  return {"date", false, {}, std::move(cells)};
}

TEST(DateText, SecondsOfADate) {
  EXPECT_EQ(date_in("1970-01-02", "%Y-%m-%d"), 86400);
  EXPECT_EQ(date_in(" 29.2.2024 ", "%d.%m.%Y"), 1709164800);
  EXPECT_EQ(date_in("2/29/2024 13:05:07", "%m/%d/%Y %H:%M:%S"), 1709164800 + 13 * 3600 + 307);
  EXPECT_EQ(date_in("01.03.24", "%d.%m.%y"), date_in("2024-03-01", "%Y-%m-%d"));
  for (const char* text : {"", "29.02.2023", "1.13.2024", "0.1.2024", "1.1.24", "1.1.2024 10:00",
                           "1.1.2024x", "-1.1.2024", "1 .1.2024"})
    EXPECT_FALSE(date_in(text, "%d.%m.%Y")) << text;
}

TEST(DateText, LayoutsOfAColumn) {
  EXPECT_THAT(date_layouts(texts({"01.02.2024", "", "NA", "5.6.2024"})), ElementsAre("%d.%m.%Y"));
  EXPECT_THAT(date_layouts(texts({"01/02/2024", "03/04/2024"})),
              ElementsAre("%d/%m/%Y", "%m/%d/%Y"));
  EXPECT_THAT(date_layouts(texts({"01/02/2024", "13/04/2024"})), ElementsAre("%d/%m/%Y"));
  EXPECT_THAT(date_layouts(texts({"01/02/2024", "04/13/2024"})), ElementsAre("%m/%d/%Y"));
  // A cell that is no date leaves the layout of the others.
  EXPECT_THAT(date_layouts(texts({"2024-02-30", "2024-02-01", "2024-02-02"})),
              ElementsAre("%Y-%m-%d"));
  EXPECT_THAT(date_layouts(texts({"304L", "2024-02-01", "12 mm"})), IsEmpty());
  EXPECT_THAT(date_layouts(texts({"", "-"})), IsEmpty());
  EXPECT_THAT(date_layouts(texts({"0001-02-24", "0003-04-24"})), IsEmpty());
  EXPECT_THAT(date_layouts({"number", true, {20240101}, {}}), IsEmpty());
}

class TableOfDates : public ScratchTest {
 protected:
  std::vector<std::string> cells_of(const std::string& text) const {
    return read_table(write("dates.csv", text)).columns.at(1).text;
  }
};

// DuckDB would read the first as the first of February.
TEST_F(TableOfDates, DatesThatHaveSeveralReadingsStayText) {
  EXPECT_THAT(cells_of("n,d\n1,01/02/2024\n2,03/04/2024\n"),
              ElementsAre("01/02/2024", "03/04/2024"));
  EXPECT_THAT(cells_of("n,d\n1,01/02/2024 10:30:00\n2,03/04/2024 11:30:00\n"),
              ElementsAre("01/02/2024 10:30:00", "03/04/2024 11:30:00"));
  EXPECT_THAT(cells_of("n,d\n1,2024-02-01\n2,2024-04-03\n"),
              ElementsAre("2024-02-01", "2024-04-03"));
}

}  // namespace
}  // namespace wearwell
