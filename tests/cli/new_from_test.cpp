// `wearwell new --from`: headings as people write them, to a study that runs.
#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "support/new_from_table.h"

namespace wearwell {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class NewFrom : public NewFromTable {};

TEST_F(NewFrom, WornVolumes) {
  const std::string said =
      fitted("pin.csv",
             "Cycles [-],normal force (N),Sliding distance / m,worn volume [mm³],remark\n"
             "100,60,6,0.3,\n1000,60,60,3.1,ok\n5000,60,300,14,\n10000,60,600,31,\n");
  EXPECT_THAT(said, AllOf(HasSubstr("volume: column 'worn volume [mm³]' in mm^3"),
                          HasSubstr("force: column 'normal force (N)' in N"),
                          HasSubstr("slip: column 'Sliding distance / m' in m"),
                          HasSubstr("column 'remark' is not used")));
  EXPECT_EQ(result_["model"], "archard-joint");
  EXPECT_NEAR(result_["parameters"]["k"]["q50"], 31.0 / 36000, 0.1e-3);
  EXPECT_EQ(result_["parameters"]["k"]["prior"]["default"], true);
}

TEST_F(NewFrom, LivesInGerman) {
  const std::string said =
      fitted("versuche.csv",
             "Probe,Spannungsamplitude_MPa,Spannungsverhältnis,Lastspiele,Status\n1,400,-1,41000,"
             "F\n2,400,-1,52000,F\n"
             "3,350,-1,120000,F\n4,350,-1,160000,F\n5,300,-1,500000,F\n6,300,-1,2000000,S\n");
  EXPECT_THAT(said,
              AllOf(HasSubstr("alternating_stress: column 'Spannungsamplitude_MPa' in MPa"),
                    HasSubstr("life: column 'Lastspiele'"), HasSubstr("status: column 'Status'")));
  EXPECT_EQ(result_["model"], "sn");
  EXPECT_THAT(content("out/study.toml"), HasSubstr("mean_stress = \"none\""));
  EXPECT_EQ(result_["coverage"]["rows"][5]["outcome"], "runout");
}

// A unit that no heading has is a guess, and is called one in the study and on the terminal.
TEST_F(NewFrom, AUnitThatIsGuessedIsCalledAGuess) {
  const std::string said =
      fitted("lives.csv", "stress,N\n400,41000\n400,52000\n350,120000\n300,500000\n300,700000\n");
  EXPECT_THAT(said, AllOf(HasSubstr("column 'stress' has no unit in its heading; MPa is a guess"),
                          HasSubstr("no column tells which tests were stopped unbroken")));
  EXPECT_THAT(content("out/study.toml"), HasSubstr("unit = \"MPa\" }    # the unit is a GUESS"));
}

TEST_F(NewFrom, DepthsOfSeveralBearings) {
  const std::string said =
      fitted("inspections.csv",
             "bearing,contact,journal radius [mm],radial clearance [um],load [N],bearing length "
             "[mm],revolutions,wear depth [um]\n"
             "A,stationary,10,25,400,20,50000,16.7\nA,stationary,10,25,400,20,100000,31.9\n"
             "B,stationary,10,35,400,20,50000,12.0\nB,stationary,10,35,400,20,100000,22.5\n"
             "C,stationary,10,35,400,20,50000,19.0\nC,stationary,10,35,400,20,100000,34.5\n");
  EXPECT_THAT(said, AllOf(HasSubstr("depth: column 'wear depth [um]' in um"),
                          Not(HasSubstr("State what no heading tells"))));
  EXPECT_EQ(result_["model"], "bearing-wear");
  EXPECT_TRUE(result_["parameters"].contains("k_scatter"));
}

// A condition that no heading names is left to be stated: nothing runs with one that nobody stated.
TEST_F(NewFrom, WhatNobodyStatedIsNoGroundForAResult) {
  write("depths.csv", "revolutions,wear [um]\n50000,16.7\n100000,31.9\n150000,45.1\n");
  const CommandResult run = here("new --from depths.csv out");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.out, AllOf(HasSubstr("State what no heading tells"), HasSubstr("pressure: "),
                             HasSubstr("radius: "), HasSubstr("clearance: "),
                             HasSubstr("contact: "), HasSubstr("The study does not run yet")));
  const CommandResult fit = here("fit out/study.toml");
  EXPECT_EQ(fit.exit_code, 2);
  EXPECT_THAT(fit.err, AllOf(HasSubstr("conditions.pressure (like \"1.5 MPa\"), "
                                       "conditions.radius (like \"10 mm\"), conditions.clearance "),
                             HasSubstr("conditions.contact")));
  EXPECT_FALSE(std::filesystem::exists(folder() / "study-results"));
  std::string study = content("out/study.toml");
  for (const auto& [name, value] : {std::pair{"pressure", "1 MPa"},
                                    {"radius", "10 mm"},
                                    {"clearance", "30 um"},
                                    {"contact", "stationary"}}) {
    const std::string unstated = std::string(name) + " = \"?\"";
    ASSERT_NE(study.find(unstated), std::string::npos) << unstated;
    study.replace(study.find(unstated), unstated.size(),
                  std::string(name) + " = \"" + value + "\"");
    write("out/study.toml", study);
    EXPECT_EQ(here("fit out/study.toml --quiet --draws 100 --no-report -o r").exit_code == 2,
              study.find("= \"?\"") != std::string::npos)
        << name;
  }
  write("volumes.csv", "cycles,worn volume [mm^3]\n1000,3\n2000,5\n3000,8\n");
  EXPECT_EQ(here("new --from volumes.csv").exit_code, 1);
  EXPECT_THAT(here("fit volumes-study/study.toml").err,
              HasSubstr("conditions.work_per_cycle (like \"5.966 N m\") not stated"));
}

// What stands in brackets is a unit, or is said to be none.
TEST_F(NewFrom, BracketsAreNeverDropped) {
  const auto asked = [&](const std::string& heading) {
    std::filesystem::remove_all(folder() / "out");
    write("d.csv", "revolutions," + heading +
                       ",pressure [MPa],radius [mm],clearance [um],contact\n"
                       "50000,16.7,1,10,30,stationary\n100000,31.9,1,10,30,stationary\n");
    return here("new bearing out --from d.csv");
  };
  EXPECT_THAT(asked("Wear [mil]").out, HasSubstr("column 'Wear [mil]' in mil"));
  EXPECT_THAT(asked("Wear [mikron]").out, HasSubstr("column 'Wear [mikron]' in mikron"));
  for (const std::string bracket : {"[left]", "[x1000 mm]", "(left)", "[N]"}) {
    const CommandResult run = asked("Wear " + bracket);
    EXPECT_EQ(run.exit_code, 1) << run.out;
    EXPECT_THAT(run.out, AllOf(HasSubstr("column 'Wear " + bracket + "': "),
                               HasSubstr("expected one like 'm'"), Not(HasSubstr("has no unit in")),
                               Not(HasSubstr("is a guess"))))
        << bracket;
    EXPECT_EQ(here("fit out/study.toml").exit_code, 2) << bracket;
  }
}

TEST_F(NewFrom, RefusesWhatSaysNothing) {
  write("a.csv", "x,y\n1,2\n2,3\n");
  const CommandResult none = here("new --from a.csv");
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_THAT(none.err, HasSubstr("no study follows from its headings (x, y)"));
  EXPECT_FALSE(std::filesystem::exists(folder() / "a-study"));
  EXPECT_EQ(here("new clutch --from a.csv").exit_code, 2);
  EXPECT_EQ(here("new --from missing.csv").exit_code, 2);
  EXPECT_EQ(here("new").exit_code, 2);
  EXPECT_EQ(here("new joint").exit_code, 2);
  EXPECT_THAT(here("new jiont d").err, HasSubstr("'jiont' is not allowed; use one of joint"));
}

// Dates are no numbers: first what makes a time of them.
TEST_F(NewFrom, TableOfNothingButDates) {
  write(
      "doors.csv",
      "door,fitted,removed\nD1,2022-03-01,2023-01-17\nD2,2022-03-09,\nD3,2022-04-02,2022-11-30\n");
  const CommandResult run = here("new --from doors.csv");
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err,
              HasSubstr("doors.csv: columns 'fitted', 'removed' are dates, not numbers: run "
                        "wearwell open doors.csv and choose dates in a heading"));
  EXPECT_FALSE(std::filesystem::exists(folder() / "doors-study"));
}

TEST_F(NewFrom, SaysWhatKeepsItFromRunning) {
  write("lives.csv", "stress [MPa],cycles,status\n400,41000,broke\n300,2000000,went on\n");
  const CommandResult run = here("new --from lives.csv");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.out, AllOf(HasSubstr("The study does not run yet"),
                             HasSubstr("'went on' is not a status")));
  EXPECT_TRUE(std::filesystem::exists(folder() / "lives-study" / "study.toml"));
}

// One cell of words makes a column of labels, which is no response: the message names the cell, and new says it at once.
TEST_F(NewFrom, NamesTheCellThatIsNoNumberOfAResponse) {
  write("rates.csv",
        "film_2,N (1000),loss\n10,1,1.2\n20,1,x\n20,2,2.1\n40,1,3.9\n80,2,n/a\n80,3,8\n");
  const CommandResult run = here("new formula --from rates.csv --column response=loss");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.out, AllOf(HasSubstr("likelihood.loss: is not a numeric column: "),
                             HasSubstr("2, column 'loss': 'x' is not a number\n"),
                             HasSubstr("\n    [likelihood.loss]\n"), Not(HasSubstr("\\x0a"))));
  const CommandResult fit = here("fit rates-study/study.toml");
  EXPECT_EQ(fit.exit_code, 2);
  EXPECT_THAT(fit.err, HasSubstr("row 2, column 'loss': 'x' is not a number"));
  // The second film, and a factor: neither is a unit of a text.
  write("rates.csv", "film_2,N (1000),loss\n10,1,1.2\n20,1,2\n20,2,2.1\n40,1,3.9\n80,3,8\n");
  EXPECT_EQ(here("new formula again --from rates.csv --column response=loss").exit_code, 0);
}

}  // namespace
}  // namespace wearwell
