// `wearwell new --from`: messy tables of four kinds go from file to a fitted study in two commands; what a table leaves
// open is refused with every reading, or asked for on a terminal.
#include <gmock/gmock.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <nlohmann/json.hpp>

#include "support/new_from_table.h"

namespace wearwell {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

class NewFromTables : public NewFromTable {
 protected:
  double middle(const char* parameter) { return result_["parameters"][parameter]["q50"]; }
  // What is refused, with nothing written.
  std::string refused(const std::string& table, const std::string& text,
                      const std::string& options = "") {
    write(table, text);
    const CommandResult run = here("new --from " + table + " refused " + options);
    EXPECT_EQ(run.exit_code, 2) << run.out;
    EXPECT_FALSE(std::filesystem::exists(folder() / "refused"));
    return run.err;
  }
};

// Life data.

TEST_F(NewFromTables, LivesWithWordsForTheirEnds) {
  const std::string said = fitted("pumps.csv",
                                  "Pump,Operating hours,State\nP1,1200,failed\nP2,3400,running\n"
                                  "P3,800,failure\nP4,2200,suspended\nP5,1900,F\nP6,2600,failed\n");
  EXPECT_THAT(said, AllOf(HasSubstr("life: column 'Operating hours' in h"),
                          HasSubstr("status: column 'State' (failed, running"),
                          HasSubstr("column 'Pump' names rows")));
  EXPECT_EQ(result_["model"], "formula");
  EXPECT_GT(middle("characteristic"), 1500);
  EXPECT_LT(middle("characteristic"), 5000);
  EXPECT_THAT(content("out/study.toml"), AllOf(HasSubstr("PROPOSED"), HasSubstr("or lognormal")));
}

TEST_F(NewFromTables, LivesInSpanishWithCodes) {
  const std::string said = fitted(
      "bombas.csv", "equipo;horas;censurado\n1;1200,5;0\n2;3400;1\n3;800;0\n4;2200;0\n5;1900;1\n");
  EXPECT_THAT(
      said,
      AllOf(HasSubstr("life: column 'horas' in h"),
            HasSubstr("0 is a failure, 1 was stopped unbroken (censored): from the heading")));
  EXPECT_LT(middle("characteristic"), 10000);
}

TEST_F(NewFromTables, LivesBetweenTwoInspections) {
  const std::string said =
      fitted("looks.csv", "from [h],to [h],count\n0,100,3\n100,200,5\n200,300,6\n300,,4\n");
  EXPECT_THAT(said,
              AllOf(HasSubstr("lower: column 'from [h]' in h"), HasSubstr("count: column 'count'"),
                    HasSubstr("an empty upper end is read as a run-out")));
  EXPECT_GT(middle("characteristic"), 150);
  EXPECT_LT(middle("characteristic"), 400);
}

TEST_F(NewFromTables, LivesAtSeveralTemperatures) {
  const std::string said =
      fitted("ofen.csv",
             "Lebensdauer [h];Temperatur [°C];Ende\n120;80;F\n90;80;F\n140;80;F\n400;60;F\n"
             "520;60;F\n610;60;S\n1900;40;F\n2000;40;S\n2000;40;S\n");
  EXPECT_THAT(said, AllOf(HasSubstr("Arrhenius' law"),
                          HasSubstr("wearwell new life ofen-life --from ofen.csv"),
                          HasSubstr("state the conditions of use in [predict] given")));
  EXPECT_GT(middle("energy"), 0.3);
  EXPECT_LT(middle("energy"), 1.2);
}

// Wear and degradation.

TEST_F(NewFromTables, WearAgainstDistanceInInches) {
  const std::string said =
      fitted("liner.csv",
             "Sliding distance (km), Wear depth (mils), Temp (degF)\n1,0.5,120\n2,1.1,121\n"
             "3,1.4,119\n5,2.6,122\n8,3.9,120\n",
             "--limit '10 mils'");
  EXPECT_THAT(said, AllOf(HasSubstr("distance: column 'Sliding distance (km)' in km"),
                          HasSubstr("depth: column 'Wear depth (mils)' in mils"),
                          HasSubstr("assumed not to depend on 'Temp (degF)'")));
  EXPECT_NEAR(middle("rate"), 0.5, 0.05);
  EXPECT_THAT(content("out/study.toml"), HasSubstr("limit = { wear = \"10 mils\" }"));
}

TEST_F(NewFromTables, WearOfUnitsInFrench) {
  const std::string said =
      fitted("usure.csv",
             "Pièce;Temps (heures);Usure (µm);Remarque\nA;100;10,5;\nA;200;21,0;ok\n"
             "A;300;30,2;\nB;100;14,1;\nB;200;27,9;\nB;300;43,0;rayé\nC;100;9,2;\nC;200;17,8;\nC;"
             "300;28,1;\n");
  EXPECT_THAT(said, AllOf(HasSubstr("unit: column 'Pièce'"),
                          HasSubstr("time: column 'Temps (heures)' in h"),
                          HasSubstr("no failure threshold is given"),
                          HasSubstr("column 'Remarque' is not used")));
  EXPECT_NEAR(middle("rate"), 0.11, 0.05);
  EXPECT_TRUE(result_["parameters"].contains("scatter"));
}

// A fit, too, says what it left out of its table.
TEST_F(NewFromTables, RowsOfMeansAreLeftOutAndSaid) {
  fitted("verschleiss.csv",
         "Probe;Zyklen;Verschleiß [µm]\n1;100;10,5\n2;200;21,0\n3;300;30,2\n4;400;40,1\n"
         "Mittelwert;250;20,6\n");
  EXPECT_EQ(result_["data"]["rows"], 4);
  EXPECT_THAT(result_["data"]["remarks"].dump(), HasSubstr("Mittelwert"));
}

// Degradation tables often have a column for each unit, as Meeker and Escobar (1998, tables C.17 and C.18).
TEST_F(NewFromTables, AColumnForEachUnit) {
  const std::string said = fitted("laser.csv",
                                  "Hours,Laser 1 [%],Laser 2 [%],Laser 3 [%],Laser 4 [%]\n"
                                  "250,0.47,0.71,0.71,0.36\n500,0.93,1.22,1.17,0.62\n"
                                  "750,2.11,1.90,1.73,1.36\n1000,2.72,2.30,1.99,\n");
  EXPECT_THAT(
      said, AllOf(HasSubstr("columns Laser 1 [%], Laser 2 [%], Laser 3 [%], Laser 4 [%] are units "
                            "with one column each"),
                  HasSubstr("unit: column 'unit'"), HasSubstr("in %")));
  EXPECT_EQ(result_["data"]["rows"], 15);
  EXPECT_NEAR(middle("rate"), 0.0024, 0.0006);
  EXPECT_THAT(content("out/study.toml"), HasSubstr("unpivot"));
}

TEST_F(NewFromTables, ColumnsThatAreNoUnits) {
  for (const char* heading : {"h,T1 [degC],T2 [degC],T3 [degC]\n", "h,force 1,force 2,force 3\n",
                              "x,P1,P2,P3\n", "h,P1 [um],P2 [um],P3 [mm]\n", "h,P1,P2\n"}) {
    write("t.csv", std::string(heading) + (std::string(heading) == "h,P1,P2\n"
                                               ? "1,2,3\n2,3,4\n3,5,6\n"
                                               : "1,2,3,4\n2,3,4,5\n3,5,6,7\n"));
    const CommandResult run = here("new --from t.csv out");
    EXPECT_THAT(run.out + run.err, Not(HasSubstr("with one column each"))) << heading;
    std::filesystem::remove_all(folder() / "out");
  }
}

TEST_F(NewFromTables, WearUnderForceIsArchards) {
  const std::string said =
      fitted("stift.csv",
             "Zyklen;Verschleiß [µm];Kraft "
             "[kN]\n1000;5,2;1,5\n2000;9,8;1,5\n4000;19,5;1,5\n8000;41,0;1,5\n");
  EXPECT_THAT(said,
              AllOf(HasSubstr("wear proportional to force and cycles"),
                    HasSubstr("wearwell new degradation stift-degradation --from stift.csv")));
  EXPECT_NEAR(middle("k"), 40.0 / 8000 / 1.5, 4e-4);
}

// What falls from where it begins.
TEST_F(NewFromTables, CapacityThatFalls) {
  const std::string said =
      fitted("cells.csv",
             "battery;cycle;capacity [Ah]\nB5;1;1.86\nB5;50;1.75\nB5;100;1.60\nB6;1;1.93\n"
             "B6;50;1.80\nB6;100;1.66\nB7;1;1.89\nB7;50;1.79\nB7;100;1.69\n");
  EXPECT_THAT(said, AllOf(HasSubstr("Ah is not a known unit"), HasSubstr("start - rate * cycles")));
  // The curved path in its place begins and falls as the straight one.
  EXPECT_THAT(content("out/study.toml"), HasSubstr("= \"start - rate * (cycles/1 [cycles])^p\""));
  EXPECT_NEAR(middle("start"), 1.9, 0.1);
  EXPECT_NEAR(middle("rate"), 0.0025, 0.001);
}

// S-N.

TEST_F(NewFromTables, StressAndLifeInGerman) {
  const std::string said = fitted(
      "woehler.csv",
      "Probe;Spannungsamplitude [MPa];Lastspiele;Ergebnis\n1;400;41.000;Bruch\n2;400;52.000;Bruch\n"
      "3;350;120.000;Bruch\n4;350;160.000;ausgefallen\n5;300;500.000;Bruch\n6;300;2.000.000;"
      "Durchläufer\n");
  EXPECT_THAT(said, HasSubstr("status: column 'Ergebnis' (Bruch, ausgefallen, Durchläufer)"));
  EXPECT_EQ(result_["model"], "sn");
  EXPECT_EQ(result_["coverage"]["rows"][5]["outcome"], "runout");
}

TEST_F(NewFromTables, LivesThatWentOnAreWrittenAsLimits) {
  const std::string said =
      fitted("limits.csv",
             "Spannung (MPa);Lastspiele\n400;41.000\n400;52.000\n350;120.000\n350;160.000\n"
             "300;500.000\n300;>5.000.000\n");
  EXPECT_THAT(said, HasSubstr("'>' in column 'Lastspiele' is a run-out"));
  EXPECT_EQ(result_["coverage"]["rows"][5]["outcome"], "runout");
}

TEST_F(NewFromTables, AmplitudesInKsi) {
  fitted("rig.csv",
         "Rig 7; night shift\n\nspecimen,stress amplitude "
         "[ksi],Nf,result\n1,60,41000,F\n2,60,52000,F\n3,50,120000,F\n"
         "4,50,160000,F\n5,45,500000,F\n6,45,5000000,runout\n");
  EXPECT_EQ(result_["model"], "sn");
}

// A response with inputs: one command prints the other.
TEST_F(NewFromTables, AResponseWithInputs) {
  write(
      "tribo.csv",
      "Load (N),Speed (rpm),Temp (C),Wear rate "
      "(mm3/Nm)\n10,100,25,1.1e-5\n20,100,25,1.2e-5\n10,200,25,1.6e-5\n"
      "20,200,60,1.9e-5\n10,100,60,1.4e-5\n30,150,40,1.6e-5\n30,250,60,2.4e-5\n15,250,25,2.0e-5\n");
  const CommandResult run = here("new --from tribo.csv");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const std::string begin = "Now run: wearwell ";
  ASSERT_THAT(run.out, HasSubstr(begin + "select"));
  std::string command = run.out.substr(run.out.find(begin) + begin.size());
  command = command.substr(0, command.find('\n'));
  EXPECT_THAT(
      command,
      HasSubstr("--response 'Wear rate (mm3/Nm)' --inputs 'Load (N),Speed (rpm),Temp (C)'"));
  const CommandResult selected = here(command);
  EXPECT_EQ(selected.exit_code, 0) << selected.err;
  EXPECT_THAT(selected.out, HasSubstr("Speed (rpm)"));

  // The same table as a formula, in which each condition has its part.
  EXPECT_THAT(run.out,
              HasSubstr("a response under its conditions: wear_rate under load, speed, temp:"));
  ASSERT_EQ(here("new formula powers --from tribo.csv").exit_code, 0);
  const std::string study = content("powers/study.toml");
  EXPECT_THAT(study, HasSubstr("(load/load_reference)^load_exponent"));
  EXPECT_THAT(study, HasSubstr("arrhenius(temp, temp_reference, temp_energy)"));
  const CommandResult fit =
      here("fit powers/study.toml --method exact --draws 100 --json --no-report -o powers-results");
  ASSERT_LE(fit.exit_code, 1) << fit.err;
  EXPECT_THAT(fit.out, HasSubstr("load_exponent"));
}

// A response that can be negative is a sum; names of the study do not clash with headings.
TEST_F(NewFromTables, ResponseThatCanBeNegative) {
  write("drift.csv",
        "material,level,sigma,response\nsteel,1,-2,-0.4\nbronze,2,4,0.5\nsteel,3,1,0.1\n"
        "bronze,1,3,0.2\nsteel,2,-1,0\n");
  const CommandResult run = here("new formula sum --from drift.csv");
  ASSERT_EQ(run.exit_code, 0) << run.err << run.out;
  EXPECT_THAT(
      content("sum/study.toml"),
      AllOf(HasSubstr("family = \"normal\""), HasSubstr("# material = \"material\"    # a label")));
  const CommandResult none = here("new formula none --from drift.csv --column response=");
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_FALSE(std::filesystem::exists(folder() / "none"));
}

// What is open.

TEST_F(NewFromTables, TwoColumnsForOneRole) {
  const std::string table =
      "wear left [um],wear right [um],cycles\n1,1.2,100\n2,2.5,200\n3,3.1,300\n";
  EXPECT_THAT(refused("h.csv", table),
              AllOf(HasSubstr("Which column of h.csv is depth?"),
                    HasSubstr("wearwell new refused --from h.csv --column 'depth=wear left [um]'"),
                    HasSubstr("--column 'depth=wear right [um]'")));
  fitted("h.csv", table, "--column 'depth=wear right [um]'");
  EXPECT_NEAR(middle("rate"), 0.011, 0.002);
}

TEST_F(NewFromTables, WhatAFailureIs) {
  const std::string table = "hours,status\n100,1\n200,0\n300,1\n150,1\n";
  EXPECT_THAT(refused("i.csv", table), AllOf(HasSubstr("1 is a failure, 0 was stopped"),
                                             HasSubstr("0 is a failure, 1 was stopped"),
                                             HasSubstr("--failure 1"), HasSubstr("--failure 0")));
  fitted("i.csv", table, "--column status=status --failure 1");
  EXPECT_THAT(content("out/study.toml"), HasSubstr("failure = 1"));
}

TEST_F(NewFromTables, WhichLabelIsTheUnit) {
  const std::string table =
      "rail,shop,hours,wear "
      "(um)\nA,x,10,1.1\nA,x,20,2.3\nB,x,10,1.4\nB,x,20,2.7\nC,y,10,0.9\nC,y,20,1.7\n";
  EXPECT_THAT(refused("x.csv", table),
              AllOf(HasSubstr("--column unit=rail"), HasSubstr("--column unit=shop"),
                    HasSubstr("--column unit=")));
  EXPECT_THAT(fitted("x.csv", table, "--column unit=rail"), HasSubstr("unit: column 'rail'"));
}

TEST_F(NewFromTables, AlongWhichColumn) {
  const std::string said =
      refused("y.csv", "time [h],cycles,wear [um]\n1,100,2\n2,200,4\n3,300,6.3\n4,400,8\n");
  EXPECT_THAT(said,
              AllOf(HasSubstr("--column cycles=cycles"), HasSubstr("--column 'time=time [h]'")));
}

TEST_F(NewFromTables, WhichSheet) {
  std::filesystem::copy(PROJECT_SOURCE_DIR "/examples/messy/woehler.xlsx", folder() / "w.xlsx");
  const CommandResult run = here("new --from w.xlsx");
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, AllOf(HasSubstr("--sheet Info"), HasSubstr("--sheet Versuche")));
  const CommandResult one = here("new --from w.xlsx --sheet Versuche --range B4:G22");
  EXPECT_EQ(one.exit_code, 0) << one.err << one.out;
  EXPECT_THAT(one.out, HasSubstr("life: column 'Schwingspiele'"));
  EXPECT_THAT(content("w-study/study.toml"), HasSubstr("sheet = \"Versuche\""));
}

TEST_F(NewFromTables, AMultipleOfCyclesIsNeverLost) {
  EXPECT_THAT(fitted("m.csv", "million_revolutions\n17.88\n28.92\n33\n41.52\n42.12\n45.6\n"),
              HasSubstr("in 1e6 rev"));
}

TEST_F(NewFromTables, AFactorInTheHeadingIsNeverLost) {
  for (const auto& [heading, unit] : {std::pair{"khours", "1e3 h"},
                                      {"thousand hours", "1e3 h"},
                                      {"1000 hours", "1e3 h"},
                                      {"1000 km", "1e3 km"},
                                      {"kcycles", "1e3 cycles"},
                                      {"Mcycles to failure", "1e6 cycles"},
                                      {"hours", "h"},
                                      {"km", "km"}}) {
    write("f.csv",
          std::string(heading) + ",status\n10,failure\n20,failure\n30,runout\n14,failure\n");
    const CommandResult run = here("new --from f.csv f");
    EXPECT_EQ(run.exit_code, 0) << heading << run.err;
    EXPECT_THAT(run.out, HasSubstr(std::string("' in ") + unit + "\n")) << heading;
    std::filesystem::remove_all(folder() / "f");
  }
}

// Ages at which units fail and are repaired are no lives of parts.
TEST_F(NewFromTables, FailuresOfRepairedUnits) {
  fitted("engines.csv",
         "engine,hours,event\nA,120,failure\nA,300,failure\nA,500,end\nB,80,failure\nB,410,end\n"
         "C,390,end\n");
  EXPECT_EQ(result_["model"], "repairable");
  EXPECT_GT(middle("beta"), 0.2);
  // In rising order without ends they can be either.
  const std::string rising =
      "unit,hours,event\np,0.7,failure\np,3.7,failure\np,13.2,failure\np,54,failure\n";
  EXPECT_THAT(refused("p.csv", rising), AllOf(HasSubstr("wearwell new repairable refused"),
                                              HasSubstr("wearwell new life refused")));
  write("p.csv", rising);
  EXPECT_EQ(here("new repairable --from p.csv rising").exit_code, 0);
  EXPECT_THAT(content("rising/study.toml"), HasSubstr("end = \"last failure\""));
  const CommandResult lives = here("new life --from p.csv lives");
  EXPECT_THAT(lives.out, HasSubstr("the model is \"repairable\""));
}

TEST_F(NewFromTables, OptionsThatFitNothing) {
  const std::string lives = "hours,event\n100,1\n200,0\n300,1\n";
  EXPECT_THAT(refused("l.csv", lives, "--column life=hors"), HasSubstr("nearest: 'hours'"));
  EXPECT_THAT(refused("l.csv", lives, "--column lief=hours"), HasSubstr("did you mean 'life'?"));
  EXPECT_THAT(refused("l.csv", lives, "--limit '100 um'"),
              HasSubstr("--limit: l.csv is read as lives"));
  EXPECT_THAT(refused("w.csv", "hours,wear [um]\n1,2\n2,4\n3,6\n", "--limit '100 N'"),
              HasSubstr("unit 'N' has the wrong dimension"));
  EXPECT_EQ(here("new law other --limit '1 um'").exit_code, 2);
}

// On a terminal the question is asked, and the answer used.
TEST_F(NewFromTables, AsksOnATerminal) {
  write("h.csv", "wear left [um],wear right [um],cycles\n1,1.2,100\n2,2.5,200\n3,3.1,300\n");
  int terminal = -1;
  const pid_t child = forkpty(&terminal, nullptr, nullptr, nullptr);
  ASSERT_GE(child, 0);
  if (child == 0) {
    if (chdir(folder().c_str()) != 0) _exit(9);
    execl(WEARWELL_BINARY, "wearwell", "new", "--from", "h.csv", nullptr);
    _exit(9);
  }
  const std::string answers = "7\n2\n";  // no such reading, then the second
  ASSERT_EQ(::write(terminal, answers.data(), answers.size()),
            static_cast<ssize_t>(answers.size()));
  std::string said;
  std::array<char, 256> bytes{};
  for (ssize_t n; (n = read(terminal, bytes.data(), bytes.size())) > 0;)
    said.append(bytes.data(), static_cast<std::size_t>(n));
  int status = 0;
  waitpid(child, &status, 0);
  close(terminal);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << said;
  EXPECT_THAT(said, AllOf(HasSubstr("Which column of h.csv is depth?"), HasSubstr("1 to 2:"),
                          HasSubstr("depth: column 'wear right [um]' in um")));
}

}  // namespace
}  // namespace wearwell
