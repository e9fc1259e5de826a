#include "wearwell/models/recurrence/recurrence_data.h"

#include <gmock/gmock.h>

#include "support/messages.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"

namespace wearwell::recurrence {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class RecurrenceDataTest : public ScratchTest {
 protected:
  RecurrenceData read(const std::string& rows, const std::string& data = {},
                      const std::string& columns = {},
                      const std::string& heading = "unit,age [h],event") {
    write("d.csv", heading + "\n" + rows);
    const Source source =
        source_of(write("study.toml", "[data]\nfile = \"d.csv\"\n" + data +
                                          "\n[data.columns]\nunit = \"unit\"\nage = \"age\"\n" +
                                          (columns.empty() ? "event = \"event\"\n" : columns)));
    return read_recurrence_data(TomlReader::parse(source.study), source);
  }
  std::string refusal(const std::string& rows, const std::string& data = {},
                      const std::string& columns = {},
                      const std::string& heading = "unit,age [h],event") {
    return message_of<InputError>([&] { read(rows, data, columns, heading); });
  }
};

// Counts are the rows that they stand for: data and likelihood are the same.
TEST_F(RecurrenceDataTest, CountsOfFailuresAtOneAge) {
  const std::string heading = "unit,age [h],event,count", event = "event = \"event\"\n";
  const std::string rounding = "rounding = \"1 h\"\n", counted = event + "count = \"count\"\n";
  const RecurrenceData counts =
      read("a,10,failure,3\na,40,end,\nb,20,failure,1\nb,30,end,0\n", rounding, counted, heading);
  const RecurrenceData rows = read(
      "a,10,failure\na,10,failure\na,10,failure\na,40,end\nb,20,failure\nb,30,end\n", rounding);
  ASSERT_EQ(counts.units.size(), rows.units.size());
  EXPECT_EQ(counts.failures(), 4U);
  for (std::size_t i = 0; i < rows.units.size(); ++i) {
    EXPECT_EQ(counts.units[i].failures, rows.units[i].failures);
    EXPECT_EQ(counts.units[i].end, rows.units[i].end);
  }
  ASSERT_EQ(counts.gaps.size(), rows.gaps.size());
  const auto refused = [&](const std::string& table, const std::string& columns) {
    return refusal(table, rounding, columns, heading);
  };
  EXPECT_THAT(refused("a,10,failure,1.5\na,40,end,\n", counted), HasSubstr("whole number from 1"));
  EXPECT_THAT(refused("a,10,failure,0\na,40,end,\n", counted), HasSubstr("whole number from 1"));
  EXPECT_THAT(refused("a,10,failure,2\na,40,end,3\n", counted), HasSubstr("an end is one row"));
  EXPECT_THAT(refused("a,10,failure,2\na,40,end,1\n", event),
              HasSubstr("write count = \"count\" in [data.columns]"));
  EXPECT_THAT(refused("a,10,failure,2\na,40,end,1\na,50,failure,1\n", counted),
              HasSubstr("in row 2"));
  EXPECT_THAT(refusal("a,10,failure,2\na,40,end,1\n", "", counted, heading),
              HasSubstr("data.rounding"));
}

TEST_F(RecurrenceDataTest, UnitsWithTheirEvents) {
  const RecurrenceData data = read("a,10,failure\nb,30,end\na,15,failure\na,40,end\n");
  ASSERT_EQ(data.units.size(), 2U);
  EXPECT_EQ(data.units[0].failures, (std::vector<double>{36000, 54000}));
  EXPECT_EQ(data.units[0].end, 144000);
  EXPECT_TRUE(data.units[1].failures.empty());
  ASSERT_EQ(data.gaps.size(), 4U);  // in the order of the rows
  EXPECT_EQ(data.gaps[1].unit, 1U);
  EXPECT_FALSE(data.gaps[1].failed);
  EXPECT_EQ(data.gaps[2].from, 36000);
  EXPECT_EQ(data.failures(), 2U);
  EXPECT_EQ(data.longest(), 144000);
}

// Nelson's 1 and -1, R's 1 and 0, codes of censoring, words of other languages, words of the study.
TEST_F(RecurrenceDataTest, WordsOfEvents) {
  const auto failures = [&](const char* failure, const char* end, const std::string& columns = {},
                            const std::string& heading = "unit,age [h],event") {
    return read(fmt::format("a,10,{}\na,15,{}\na,40,{}\n", failure, failure, end), "", columns,
                heading)
        .failures();
  };
  EXPECT_EQ(failures("1", "-1"), 2U);
  EXPECT_EQ(failures("1", "0"), 2U);
  EXPECT_EQ(failures("Ausfall", "Ende"), 2U);
  EXPECT_EQ(failures("repair", "censored"), 2U);
  EXPECT_EQ(failures("0", "1", "event = \"censored\"\n", "unit,age [h],censored"), 2U);
  EXPECT_EQ(failures("0", "1", "event = { column = \"x\", failure = 0 }\n", "unit,age [h],x"), 2U);
  EXPECT_EQ(failures("new seat", "sold",
                     "event = { column = \"event\", failure = \"new seat\", end = \"sold\" }\n"),
            2U);
  EXPECT_THAT(refusal("a,10,1\na,40,0\n", "", "event = \"x\"\n", "unit,age [h],x"),
              AllOf(HasSubstr("row 1, column 'x': 1 is ambiguous"), HasSubstr("failure = 0")));
  EXPECT_THAT(refusal("a,10,perhaps\na,40,end\n"),
              HasSubstr("row 1, column 'event': 'perhaps' is not an event"));
  EXPECT_THAT(refusal("a,10,\na,40,end\n"), HasSubstr("no value; write failure"));
}

TEST_F(RecurrenceDataTest, RefusesWhatCannotBe) {
  EXPECT_THAT(
      refusal("a,10,failure\na,9,failure\na,40,end\n"),
      AllOf(HasSubstr("d.csv, row 2, column 'age [h]': 9 is less than 10"), HasSubstr("row 1")));
  EXPECT_THAT(
      refusal("a,10,failure\na,40,end\na,50,failure\n"),
      HasSubstr("row 3, column 'age [h]': 50 follows the end of observation of unit 'a' in row 2"));
  EXPECT_THAT(refusal("a,40,end\na,40,end\n"),
              HasSubstr("row 2, column 'age [h]': 40 follows the end"));
  EXPECT_THAT(refusal("a,-1,failure\na,40,end\n"),
              HasSubstr("row 1, column 'age [h]': -1 must be 0 or more"));
  EXPECT_THAT(refusal("a,0,failure\na,40,end\n"), HasSubstr("a failure at age 0"));
  EXPECT_THAT(refusal("a,0,end\n"), HasSubstr("ends where it starts"));
  EXPECT_THAT(refusal("a,10,failure\nb,40,end\n"),
              AllOf(HasSubstr("row 1, column 'unit': unit 'a' has no row of its end"),
                    HasSubstr("last failure")));
  EXPECT_THAT(refusal(",10,failure\n"), HasSubstr("row 1, column 'unit': no value"));
  EXPECT_THAT(refusal("a,10,failure\na,40,end\n", "", "", "unit,age,event"),
              HasSubstr("needs a unit"));
}

TEST_F(RecurrenceDataTest, TwoFailuresAtOneAge) {
  const std::string rows = "a,10,failure\na,10,failure\na,40,end\n";
  EXPECT_THAT(refusal(rows),
              AllOf(HasSubstr("row 2, column 'age [h]'"), HasSubstr("either the row is a copy"),
                    HasSubstr("data.rounding = \"1 h\"")));
  EXPECT_EQ(read(rows, "rounding = \"1 h\"").failures(), 2U);
  EXPECT_THAT(refusal(rows, "rounding = \"0 h\""), HasSubstr("must be positive"));
}

// As rows of an update may be in any order.
TEST_F(RecurrenceDataTest, FailureAndEndAtOneAge) {
  for (const char* rows :
       {"a,10,failure\na,40,failure\na,40,end\n", "a,10,failure\na,40,end\na,40,failure\n"}) {
    const RecurrenceData data = read(rows);
    EXPECT_EQ(data.units[0].failures, (std::vector<double>{36000, 144000}));
    EXPECT_EQ(data.units[0].end, 144000);
    ASSERT_EQ(data.gaps.size(), 3U);
    double from = 0, length = 0;
    for (const Gap& gap : data.gaps) {
      from += gap.from;
      length += gap.to - gap.from;
    }
    EXPECT_EQ(from, 36000 + 144000);
    EXPECT_EQ(length, 144000);
  }
  EXPECT_THAT(refusal("a,40,end\na,40,failure\na,40,failure\n"), HasSubstr("fails again at 40"));
}

TEST_F(RecurrenceDataTest, EndsAtTheLastFailure) {
  const RecurrenceData data =
      read("a,10,failure\na,15,failure\nb,30,end\n", "end = \"last failure\"");
  EXPECT_TRUE(data.units[0].ends_at_failure);
  EXPECT_EQ(data.units[0].end, 54000);
  EXPECT_FALSE(data.units[1].ends_at_failure);
}

TEST_F(RecurrenceDataTest, LateStarts) {
  const std::string columns = "event = \"event\"\nstart = \"start\"\n",
                    heading = "unit,age [h],event,start [h]";
  const RecurrenceData data =
      read("a,10,failure,5\na,15,end,5\nb,30,end,0\n", "", columns, heading);
  EXPECT_EQ(data.units[0].start, 18000);
  EXPECT_EQ(data.gaps[0].from, 18000);
  EXPECT_EQ(data.units[1].start, 0);
  EXPECT_THAT(refusal("a,10,failure,5\na,15,end,5\nb,30,end,\n", "", columns, heading),
              HasSubstr("row 3, column 'start [h]'"));
  EXPECT_THAT(refusal("a,10,failure,5\na,15,end,6\n", "", columns, heading),
              HasSubstr("row 2, column 'start [h]'"));
  EXPECT_THAT(refusal("a,4,failure,5\na,15,end,5\n", "", columns, heading),
              HasSubstr("before the start"));
  EXPECT_THAT(refusal("a,5,failure,5\na,15,end,5\n", "", columns, heading),
              HasSubstr("very start"));
}

// data.grouped: a row has the failures since the row before; the last row ends the observation, with or without a word for it.
TEST_F(RecurrenceDataTest, FailuresCountedByInterval) {
  const std::string grouped = "grouped = true\n", heading = "unit,age [h],count",
                    counted = "count = \"count\"\n";
  const RecurrenceData data = read("a,10,3\na,40,0\na,50,2\nb,30,1\n", grouped, counted, heading);
  ASSERT_EQ(data.gaps.size(), 4U);
  EXPECT_EQ(data.failures(), 6U);
  EXPECT_EQ(data.units[0].end, 180'000);
  EXPECT_EQ(data.gaps[2].from, 144'000);
  EXPECT_EQ(data.gaps[2].count, 2U);
  EXPECT_EQ(data.gaps[1].count, 0U);
  EXPECT_TRUE(data.units[1].grouped);
  const std::string with_ends = "unit,age [h],event,count",
                    events = "event = \"event\"\n" + counted;
  const RecurrenceData ended =
      read("a,10,failure,3\na,40,failure,0\na,50,end,2\nb,30,failure,1\nb,30,end,\n", grouped,
           events, with_ends);
  EXPECT_EQ(ended.failures(), 6U);
  EXPECT_EQ(ended.units[0].end, 180'000);
  EXPECT_EQ(ended.gaps.back().count, 0U);
  const auto refused = [&](const std::string& rows) {
    return refusal(rows, grouped, counted, heading);
  };
  EXPECT_THAT(refused("a,10,1.5\n"),
              AllOf(HasSubstr("row 1, column 'count'"), HasSubstr("whole number from 0")));
  EXPECT_THAT(refused("a,10,1\na,10,2\n"),
              AllOf(HasSubstr("row 2, column 'age [h]'"), HasSubstr("without length")));
  EXPECT_THAT(refused("a,10,1\na,5,2\n"), HasSubstr("must not go back"));
  EXPECT_THAT(refusal("a,10,failure,1\na,20,end,\na,30,failure,1\n", grouped, events, with_ends),
              HasSubstr("follows the end of observation"));
  EXPECT_THAT(refusal("a,10,failure\n", grouped), HasSubstr("data.columns.count"));
  EXPECT_THAT(refusal("a,10,1\n", grouped + "rounding = \"1 h\"\n", counted, heading),
              HasSubstr("data.rounding"));
}

TEST_F(RecurrenceDataTest, AgesOfAnyKind) {
  EXPECT_EQ(read("a,10,failure\na,40,end\n", "", "", "unit,age [km],event").si, "m");
  EXPECT_EQ(read("a,10,failure\na,40,end\n", "", "", "unit,age [cycles],event").si, "cycle");
}

}  // namespace
}  // namespace wearwell::recurrence
