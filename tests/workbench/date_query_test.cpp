#include "wearwell/workbench/date_query.h"

#include <gmock/gmock.h>

#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/input/table.h"

namespace wearwell::workbench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class DateQuery : public ScratchTest {
 protected:
  Table queried(const std::string& text, const DatesWanted& wanted) const {
    const auto file = write("dates.csv", text);
    return read_table(file, time_query(read_table(file), wanted, ""));
  }
  std::string refusal(const std::string& text, const DatesWanted& wanted) const {
    try {
      static_cast<void>(queried(text, wanted));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
};

const std::string pumps_with_dates =
    "pump;built;failed\nP1;28.02.2024;01.03.2024\nP2;01.03.2024;\nP3;01.01.2024;NA\n";

TEST_F(DateQuery, LivesBetweenTwoDatesWithSuspensions) {
  const Table table = queried(pumps_with_dates, {"failed", "%d.%m.%Y", "built", "", "2024-12-31"});
  EXPECT_THAT(table.column("life").numbers, ElementsAre(2, 305, 365));
  EXPECT_EQ(table.column("life").name, "life [d]");
  EXPECT_THAT(table.column("status").text, ElementsAre("failure", "runout", "runout"));
  EXPECT_THAT(table.column("pump").text, ElementsAre("P1", "P2", "P3"));
}

// Blanks and tabs around a date and around the mark of a missing one are no part of them.
TEST_F(DateQuery, BlanksAndTabsAroundCells) {
  const Table table = queried(
      "pump,built,failed\nP1,\"\t2024-02-28 \",\" 2024-03-01\t\"\nP2,2024-03-01,\"\t\"\n"
      "P3,2024-01-01,\"NA\t\"\n",
      {"failed", "%Y-%m-%d", "built", "", "2024-12-31"});
  EXPECT_THAT(table.column("life").numbers, ElementsAre(2, 305, 365));
  EXPECT_THAT(table.column("status").text, ElementsAre("failure", "runout", "runout"));
}

TEST_F(DateQuery, TimesOfTheDayGiveHours) {
  const Table table = queried("a,b,life\n2024-01-01 10:30:00,2024-01-02 09:00:00,7\n",
                              {"b", "%Y-%m-%d %H:%M:%S", "a", "", ""});
  EXPECT_THAT(table.column("b life").numbers, ElementsAre(22.5));
  EXPECT_EQ(table.column("b life").name, "b life [h]");
}

TEST_F(DateQuery, TimeSinceTheFirstDateOfTheTableOrOfEachUnit) {
  const std::string readings =
      "unit;day;wear\n;;um\nB;03/20/2024;5\nA;03/01/2024;1\nA;03/11/2024;2\nB;03/25/2024;6\n";
  const Table all = queried(readings, {"day", "%m/%d/%Y", "", "", ""});
  EXPECT_THAT(all.column("time").numbers, ElementsAre(19, 0, 10, 24));
  EXPECT_THAT(all.column("wear").numbers, ElementsAre(5, 1, 2, 6));
  EXPECT_EQ(all.column("wear").name, "wear [um]");
  const Table each = queried(readings, {"day", "%m/%d/%Y", "", "unit", ""});
  EXPECT_THAT(each.column("unit").text, ElementsAre("A", "A", "B", "B"));
  EXPECT_THAT(each.column("time").numbers, ElementsAre(0, 10, 0, 5));
  EXPECT_THAT(each.column("wear").numbers, ElementsAre(1, 2, 5, 6));
}

// Names of columns and cells are those of strangers.
TEST_F(DateQuery, NamesStayNames) {
  const Table table =
      queried("\"it's \"\"x\"\"\",\"end'); drop table data; --\"\n2024-01-01,2024-01-31\n",
              {"end'); drop table data; --", "%Y-%m-%d", "it's \"x\"", "", ""});
  EXPECT_THAT(table.column("life").numbers, ElementsAre(30));
}

TEST_F(DateQuery, RefusalsNameTheCell) {
  const DatesWanted wanted{"failed", "%d.%m.%Y", "built", "", "2024-12-31"};
  EXPECT_THAT(refusal(pumps_with_dates, {"failed", "%d.%m.%Y", "built", "", ""}),
              HasSubstr("row 2, column 'failed': is empty; state until which date"));
  EXPECT_THAT(refusal(pumps_with_dates + "P4;01.02.2024;31.02.2024\n", wanted),
              HasSubstr("row 4, column 'failed': '31.02.2024' is not a date of the form "
                        "day.month.year"));
  EXPECT_THAT(refusal(pumps_with_dates + "P4;01.02.2024;31.01.2024\n", wanted),
              HasSubstr("row 4, column 'built': '01.02.2024' is after '31.01.2024'"));
  EXPECT_THAT(refusal(pumps_with_dates + "P4;;31.01.2024\n", wanted),
              HasSubstr("row 4, column 'built': is empty"));
  EXPECT_THAT(refusal(pumps_with_dates, {"failed", "%d.%m.%Y", "built", "", "2024-02-29"}),
              HasSubstr("row 1, column 'failed': '01.03.2024' is after the date until which"));
  EXPECT_THAT(refusal(pumps_with_dates, {"failed", "%d.%m.%Y", "built", "", "31.12.2024"}),
              HasSubstr("'31.12.2024' is not a date; write it as 2024-12-31"));
  EXPECT_THAT(refusal(pumps_with_dates, {"failed", "%m/%d/%Y", "built", "", ""}),
              HasSubstr("column 'failed': its cells are not dates of the form month/day/year"));
  EXPECT_THAT(refusal(pumps_with_dates, {"failed", "%d.%m.%Y", "failed", "", ""}),
              HasSubstr("choose another column"));
  EXPECT_THAT(
      refusal("a,b\n01/02/2024,2024-05-01\n", {"b", "%Y-%m-%d", "a", "", ""}),
      HasSubstr("column 'a': its dates can be read as day/month/year and as month/day/year"));
}

}  // namespace
}  // namespace wearwell::workbench
