// `wearwell new --from` on tables of lives: step-stress tests, status and mode columns with empty cells, counts of parts, prefixes in
// headings; what is no table of lives is refused with one message, and nothing is written.
#include <gmock/gmock.h>

#include <algorithm>

#include "support/new_from_table.h"

namespace wearwell {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class NewLifeTables : public NewFromTable {
 protected:
  double middle(const char* parameter) { return result_["parameters"][parameter]["q50"]; }
  // The one line of a refusal, with nothing written.
  std::string refused(const std::string& words) {
    const CommandResult run = here("new " + words);
    EXPECT_EQ(run.exit_code, 2) << words << run.out;
    EXPECT_FALSE(std::filesystem::exists(folder() / "refused")) << words;
    EXPECT_EQ(run.out, "") << words;
    EXPECT_THAT(run.err, testing::StartsWith("wearwell: ")) << words;
    return run.err;
  }
  std::string example(const std::string& file) {
    std::ifstream in(PROJECT_SOURCE_DIR "/examples/" + file);
    return {std::istreambuf_iterator<char>(in), {}};
  }
};

TEST_F(NewLifeTables, AStepStressTest) {
  const std::string said = fitted("steps.csv", example("accelerated/step_stress.csv"));
  EXPECT_THAT(said, AllOf(HasSubstr("step-stress test: a power of voltage"),
                          HasSubstr("the rows of one specimen are the steps of its test"),
                          HasSubstr("Other readings of this table"), HasSubstr("degradation")));
  EXPECT_THAT(content("out/study.toml"), HasSubstr("steps  = \"specimen\""));
  // Simulated with an exponent of 8 and a shape of 2.
  EXPECT_NEAR(middle("voltage_power"), 8, 2.5);
  EXPECT_NEAR(middle("slope"), 2, 0.8);
}

// One row for each unit, with its dates: counted by month. Its end is the last date of the table.
TEST_F(NewLifeTables, UnitsWithDatesOfSaleAndReturn) {
  const std::string said = fitted("units.csv", example("warranty/units.csv"));
  EXPECT_THAT(said,
              AllOf(HasSubstr("units with their dates of sale and of return"),
                    HasSubstr("sold: column 'sale date'"), HasSubstr("the last date of the table"),
                    HasSubstr("column 'serial' is not used")));
  EXPECT_THAT(content("out/study.toml"), HasSubstr("returned = \"failure date\""));
  // As examples/warranty/units.toml has it, whose table ends in the same month.
  EXPECT_THAT(content("out/study.toml"), HasSubstr("until    = \"2025-12\""));
  EXPECT_NEAR(middle("slope"), 1.2, 0.5);
}

// One cell tells for its column which number is the day; where none does, the column is refused.
TEST_F(NewLifeTables, DatesWithTheDayFirst) {
  write("days.csv",
        "serial,sale date,return date\n1,05/01/2024,\n2,03/02/2024,01/05/2024\n"
        "3,25/03/2024,13/06/2024\n4,01/04/2024,\n");
  EXPECT_EQ(here("new --from days.csv days").exit_code, 0);
  EXPECT_THAT(content("days/study.toml"), HasSubstr("until    = \"2024-06\""));
  write("either.csv", "serial,sale date,return date\n1,05/01/2024,\n2,03/02/2024,13/05/2024\n");
  EXPECT_THAT(
      refused("--from either.csv refused"),
      AllOf(HasSubstr("row 1, column 'sale date': '05/01/2024' can be read as day/month/year"),
            HasSubstr("day/month/year or month/day/year"), HasSubstr("write 2024-01-31")));
}

// A cell that is no date is named, with what is allowed; the same of a unit without a date of sale.
TEST_F(NewLifeTables, DatesThatCannotBeRead) {
  const auto refused = [&](const std::string& rows) {
    write("dates.csv", "serial,sale date,return date\n" + rows);
    const CommandResult run = here("new --from dates.csv none");
    EXPECT_EQ(run.exit_code, 2) << run.out;
    EXPECT_FALSE(std::filesystem::exists(folder() / "none"));
    return run.err;
  };
  EXPECT_THAT(refused("1,2024-01-05,\n2,2024-02-30,2024-05-01\n3,2024-03-01,2024-06-01\n"),
              AllOf(HasSubstr("dates.csv, row 2, column 'sale date'"), HasSubstr("'2024-02-30'"),
                    HasSubstr("2024-01-31")));
  EXPECT_THAT(refused("1,2024-01-05,\n2,2024-02-03,soon\n3,2024-03-01,2024-06-01\n4,2024-03-01,"
                      "2024-07-01\n"),
              AllOf(HasSubstr("row 2, column 'return date'"), HasSubstr("'soon'"),
                    HasSubstr("leave the cell")));
  EXPECT_THAT(refused("1,2024-01-05,\n2,,2024-05-01\n3,2024-03-01,2024-06-01\n"),
              AllOf(HasSubstr("row 2, column 'sale date'"), HasSubstr("no date of sale")));
}

// ReliaSoft's page names months without a year: they have no order.
TEST_F(NewLifeTables, TrianglesOfMonthsWithoutAYear) {
  write("months.csv",
        "shipped,quantity,July,August,September\nJune,100,3,3,5\nJuly,140,,2,4\nAugust,150,,,4\n");
  const CommandResult run = here("new --from months.csv none");
  EXPECT_EQ(run.exit_code, 2) << run.out;
  EXPECT_THAT(run.err, AllOf(HasSubstr("'shipped' and the headings 'July' to 'September'"),
                             HasSubstr("July 2024")));
}

// What is like one, but is none: a failure before the last row, a condition that was read, ages that do not rise.
TEST_F(NewLifeTables, TablesThatAreNoSteps) {
  for (const char* rows :
       {"a,10,1,failed\na,20,2,survived\nb,10,1,survived\nb,20,2,failed\n",
        "a,10,1.1,survived\na,20,2.3,failed\nb,10,1.2,survived\nb,20,2.4,failed\n",
        "a,10,1,survived\na,10,2,failed\nb,10,1,survived\nb,10,2,failed\n"}) {
    write("t.csv", std::string("specimen,hours,kV,result\n") + rows);
    const CommandResult run = here("new --from t.csv none");
    EXPECT_THAT(run.out + run.err, Not(HasSubstr("step-stress"))) << rows;
    std::filesystem::remove_all(folder() / "none");
  }
}

// As the tables of Meeker and Escobar have them: the ends say what the indicator says.
TEST_F(NewLifeTables, IntervalsWithAnIndicatorOfCensoring) {
  const std::string rows = "50,100,Interval,7\n100,200,Interval,9\n,50,Left,2\n200,,Right,5\n";
  const std::string said =
      fitted("t.csv", "Hours Lower,Hours Upper,Censoring Indicator,Count\n" + rows);
  EXPECT_THAT(said, HasSubstr("'Censoring Indicator' says what the ends of the intervals say"));
  EXPECT_THAT(content("out/study.toml"), Not(HasSubstr("status")));
  // Where it says something else it is not left out.
  write("other.csv",
        "Hours Lower,Hours Upper,Censoring Indicator,Count\n" + rows + "300,,Left,1\n");
  here("new --from other.csv other");
  EXPECT_THAT(content("other/study.toml"), HasSubstr("Censoring Indicator"));
}

TEST_F(NewLifeTables, RowsOfOneUnitUnderSeveralConditions) {
  write("t.csv",
        "machine,life [h],temperature [degC],status\na,100,80,failed\na,120,60,failed\n"
        "b,90,80,failed\nb,300,60,runout\n");
  const CommandResult run = here("new --from t.csv out");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, AllOf(HasSubstr("Arrhenius"), HasSubstr("several rows are of one unit"),
                             HasSubstr("the model is \"repairable\"")));
}

// An empty cell of a status is read where the other cells leave one reading.
TEST_F(NewLifeTables, EmptyCellsOfAStatus) {
  std::string said =
      fitted("failed.csv", "hours,state\n100,failed\n200,failed\n300,\n150,failed\n400,\n");
  EXPECT_THAT(said, HasSubstr("is read as a run-out: all others are failures"));
  EXPECT_THAT(content("out/study.toml"),
              HasSubstr("status = { column = \"state\", runout = \"\" }    # GUESS"));
  const double with_runouts = middle("characteristic");
  std::filesystem::remove_all(folder() / "out");
  fitted("same.csv", "hours,state\n100,failed\n200,failed\n300,runout\n150,failed\n400,runout\n");
  EXPECT_DOUBLE_EQ(middle("characteristic"), with_runouts);
  std::filesystem::remove_all(folder() / "out");
  said = fitted("ran.csv", "hours,state\n100,\n200,\n300,running\n150,\n400,running\n");
  EXPECT_THAT(said, HasSubstr("is read as a failure: all others are run-outs"));
  EXPECT_DOUBLE_EQ(middle("characteristic"), with_runouts);
  std::filesystem::remove_all(folder() / "out");
  // A code of failures in the heading.
  fitted("coded.csv", "hours,failed\n100,1\n200,1\n300,\n150,1\n400,\n");
  EXPECT_DOUBLE_EQ(middle("characteristic"), with_runouts);
}

TEST_F(NewLifeTables, EmptyCellsOfAStatusWithBothWords) {
  write("t.csv", "hours,state\n100,failed\n200,\n300,running\n150,failed\n");
  const CommandResult run = here("new --from t.csv out");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.out, HasSubstr("row 2, column 'state': no value; state how this test ended"));
}

TEST_F(NewLifeTables, EmptyCellsOfAStatusBesideModes) {
  std::string said = fitted("runouts.csv",
                            "hours,mode,state\n100,A,failed\n200,B,failed\n300,,\n150,A,failed\n"
                            "400,,\n50,B,failed\n");
  EXPECT_THAT(said, HasSubstr("is read as a run-out: all others are failures"));
  const double of_a = middle("characteristic[A]");
  std::filesystem::remove_all(folder() / "out");
  said = fitted("modes.csv",
                "hours,mode,state\n100,A,\n200,B,\n300,,running\n150,A,\n400,,running\n50,B,\n");
  EXPECT_THAT(said, HasSubstr("is read as a failure: those rows have a failure mode"));
  EXPECT_DOUBLE_EQ(middle("characteristic[A]"), of_a);
}

TEST_F(NewLifeTables, EmptyModesWithoutAStatus) {
  write("t.csv", "hours,mode\n100,A\n200,B\n300,\n150,A\n400,\n50,B\n");
  const std::string question = refused("refused --from t.csv");
  EXPECT_THAT(question, AllOf(HasSubstr("What is an empty cell of column 'mode' of t.csv?"),
                              HasSubstr("--column mode=mode --column status=mode"),
                              HasSubstr("--column mode=mode --column status=\n")));
  fitted("t.csv", content("t.csv"), "--column mode=mode --column status=mode");
  const double of_runouts = middle("characteristic[A]");
  EXPECT_THAT(content("out/study.toml"), HasSubstr("runout = \"\""));
  std::filesystem::remove_all(folder() / "out");
  fitted("t.csv", content("t.csv"), "--column mode=mode --column status=");
  EXPECT_THAT(content("out/study.toml"), HasSubstr("unknown = \"\""));
  EXPECT_LT(middle("characteristic[A]"), of_runouts);  // two failures more
}

TEST_F(NewLifeTables, HeadingsOfCounts) {
  for (const char* heading : {"count", "number", "n", "quantity", "qty", "Number of units"}) {
    write("t.csv", std::string("hours,status,") + heading +
                       "\n100,failed,3\n200,failed,5\n300,runout,10\n150,failed,2\n");
    const CommandResult run = here("new --from t.csv out");
    EXPECT_EQ(run.exit_code, 0) << heading << run.err;
    EXPECT_THAT(content("out/study.toml"), HasSubstr("\ncount = \"")) << heading;
    std::filesystem::remove_all(folder() / "out");
  }
  // Numbers of rows, and "n" as the life of a table without another.
  write("t.csv", "number,hours,status\n1,100,failed\n2,200,failed\n3,300,runout\n");
  EXPECT_THAT(here("new --from t.csv rows").out, HasSubstr("column 'number' is not used"));
  EXPECT_THAT(content("rows/study.toml"), Not(HasSubstr("count")));
  write("t.csv", "n,status\n100,failed\n200,failed\n300,runout\n");
  EXPECT_THAT(here("new --from t.csv cycles").out, HasSubstr("life: column 'n'"));
}

TEST_F(NewLifeTables, PrefixesOfCounts) {
  for (const auto& [heading, unit] : {std::pair{"M cycles", " in 1e6 cycles\n"},
                                      {"MCycles", " in 1e6 cycles\n"},
                                      {"k cycles", " in 1e3 cycles\n"},
                                      {"1000 cycles", " in 1e3 cycles\n"},
                                      {"mtime [h]", " in h\n"},
                                      {"ktime [h]", " in h\n"},
                                      {"mcycles", "\n"},
                                      {"m cycles", " in cycles"}}) {
    write("f.csv",
          std::string(heading) + ",status\n10,failure\n20,failure\n30,runout\n14,failure\n");
    const CommandResult run =
        here("new --from f.csv f --column 'life=" + std::string(heading) + "'");
    EXPECT_EQ(run.exit_code, 0) << heading << run.err;
    EXPECT_THAT(run.out, HasSubstr("column '" + std::string(heading) + "'" + unit)) << heading;
    const bool small = heading[0] == 'm' && std::string(heading).ends_with("cycles");
    EXPECT_EQ(run.out.find("m is not read as a million") != std::string::npos, small) << heading;
    std::filesystem::remove_all(folder() / "f");
  }
}

TEST_F(NewLifeTables, FilesThatHoldNoLives) {
  write("empty.csv", "");
  write("heading.csv", "hours,status\n");
  write("engines.csv", "engine,age [h],event\n");
  write("words.csv", "hours,status\nlong,failed\nshort,failed\n");
  write("mass.csv", "life [kg],status\n1,failed\n2,failed\n");
  for (const char* preset : {"", "life ", "accelerated ", "repairable "}) {
    for (const char* file :
         {"none.csv", "empty.csv", "heading.csv", "engines.csv", "words.csv", "mass.csv", "."}) {
      const std::string message = refused(std::string(preset) + "refused --from " + file);
      EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 1) << message;
      EXPECT_THAT(message, HasSubstr(file)) << preset;
    }
  }
}

TEST_F(NewLifeTables, OneRow) {
  write("one.csv", "hours,status\n100,failed\n");
  write("engine.csv", "engine,age [h],event\nA,100,failure\n");
  for (const char* words : {"refused --from one.csv", "life refused --from one.csv",
                            "repairable refused --from engine.csv"})
    EXPECT_THAT(refused(words), HasSubstr("no study")) << words;
}

}  // namespace
}  // namespace wearwell
