// The slips of people who use the program for the first time: each is told its real cause first,
// with what is possible, in one line, and exit code 2.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <regex>

#include "support/disk_content.h"
#include "support/messages.h"
#include "support/run_command.h"
#include "support/scratch.h"

namespace wearwell {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
namespace fs = std::filesystem;

class Door : public ScratchTest {
 protected:
  Door() {
    for (const char* name : {"joint", "bearing", "fatigue", "clutch", "formula"})
      fs::copy(fs::path(PROJECT_SOURCE_DIR) / "examples" / name, folder() / name);
  }

  CommandResult in_folder(const std::string& command) const {
    return run_command(fmt::format("cd '{}' && {}", folder().string(), command));
  }

  // What the program says of a command line, which it refuses.
  std::string refused(const std::string& arguments) const {
    const CommandResult run = in_folder("'" WEARWELL_BINARY "' " + arguments);
    EXPECT_EQ(run.exit_code, 2) << arguments << "\n" << run.out << run.err;
    EXPECT_EQ(run.out, "") << arguments;
    EXPECT_THAT(run.err, StartsWith("wearwell: ")) << arguments;
    EXPECT_EQ(messages_in(run.err), 1u) << run.err;
    EXPECT_THAT(run.err, AllOf(Not(HasSubstr("internal error")), Not(HasSubstr("exception")),
                               Not(HasSubstr("Error while"))));
    return run.err.substr(0, run.err.size() - 1);
  }

  // What `check` says of an example in which a line was written differently; it begins with file
  // and line.
  std::string slipped(const std::string& example, const std::string& pattern,
                      const std::string& instead) const {
    const std::string text = content(folder() / example / "study.toml");
    const std::string slip =
        std::regex_replace(text, std::regex(pattern, std::regex::multiline), instead);
    EXPECT_NE(slip, text) << pattern;
    write(example + "/slip.toml", slip);
    std::string said = refused("check " + example + "/slip.toml");
    const std::string begin = "wearwell: " + example + "/";
    EXPECT_THAT(said, StartsWith(begin));
    return said.substr(std::min(begin.size(), said.size()));
  }
};

struct Slip {
  const char *example, *pattern, *instead, *said;
};

// In the order in which a study is read.
TEST_F(Door, SlipsInAStudy) {
  const Slip slips[] = {
      // the model
      {"joint", "archard-joint", "joint",
       "slip.toml:4:9: model: 'joint' is not allowed; use one of archard-joint, bearing-wear, "
       "clutch-wear, sn, staircase, formula, repairable (nearest: 'archard-joint')"},
      {"joint", "^model", "modle", "slip.toml:4:9: modle: unknown key; did you mean 'model'?"},
      {"joint", "^model.*", "",
       "model: is missing: it is one of archard-joint, bearing-wear, clutch-wear, sn"},
      // TOML
      {"joint", "\"archard-joint\"", "archard-joint",
       "slip.toml:4:9: a text needs quotes: model = \"...\""},
      {"joint", "\"archard-joint\"", "\u201carchard-joint\u201d",
       "slip.toml:4:9: use straight quotes"},
      {"joint", "^title = .*", "title: joint", "write '=' between a key and its value, not ':'"},
      {"joint", "\"100 mm\\^3\"", "100 mm^3",
       "'100 mm^3': a number with a unit needs quotes; write \"100 mm^3\""},
      {"joint", "\"1 %\"", "0,01",
       "'0,01': a number needs a decimal point, not a comma; write 0.01"},
      {"joint", "\"15 mm\\^3\"", "15,5 mm^3",
       "'15,5 mm^3': a number needs a decimal point, not a comma, and a number with a unit needs "
       "quotes; write \"15.5 mm^3\""},
      {"fatigue", "mean = -0.1,", "mean = -0,1,",
       "'-0,1': a number needs a decimal point, not a comma; write -0.1"},
      {"joint", "\"100 mm\\^3\"", "\"100 mm^3",
       "a text is not closed: a quote is missing on this line"},
      {"joint", "^risk.*", "risk = 0.1\nrisk = 0.2", "'risk' is defined twice"},
      {"joint", "^\\[predict\\]", "[data]\n[predict]", "'data' is defined twice"},
      {"joint", "^risk .*", "risk =", "there is no value after '='"},
      // units
      {"joint", "\"100 mm\\^3\"", "\"100,5 mm^3\"",
       "predict.limit: '100,5 mm^3' has a decimal comma; use a decimal point; "
       "write '100.5 mm^3'"},
      {"joint", "\"100 mm\\^3\"", "100", "predict.limit: 100 has no unit"},
      {"joint", "\\[20585\\]", "\"20,585 cycles\"",
       "predict.cycles: '20,585 cycles' is ambiguous: 20.585 with a decimal comma"},
      {"joint", "unit = \"mm\\^3\"", "unit = \"mm\"",
       "data.columns.volume.unit: unit 'mm' has the wrong dimension (expected one like 'm^3')"},
      {"bearing", "1.5 MPa", "1.5 mpa",
       "predict.pressure: 'mpa' is not a unit (expected one like 'Pa'; did you mean 'mPa' or "
       "'MPa'?)"},
      {"bearing", "60 rpm", "60 1/s",
       "predict.speed: '60 1/s' counts neither revolutions nor radians"},
      {"clutch", "170 degC", "170 C",
       "life.points.launch.temperature: unit 'C' has the wrong dimension (expected one like 'K' or "
       "'degC')"},
      {"fatigue", "3.3 log10\\(MPa\\)", "2000 MPa",
       "prior.log10_a.mean: 'MPa' is not the logarithm of a quantity"},
      // keys that are misspelt, before what follows from that
      {"joint", "^limit", "limt",
       "predict.limt: unknown key; did you mean 'limit'? (possible: b_lives, credible_level, "
       "cycles, level, limit, risk, sides, "
       "work_per_cycle)"},
      {"joint", "\\[predict\\]", "[predct]", "predct: unknown key; did you mean 'predict'?"},
      {"joint", "data.columns", "data.coloumns",
       "data.coloumns: unknown key; did you mean 'columns'?"},
      {"joint", "^k  ", "K  ",
       "prior.K: unknown key; did you mean 'k'? (possible: V0, exponent, k, sigma)"},
      {"joint", "distribution = \"flat\"", "distributoin = \"flat\"",
       "prior.k.distributoin: unknown key; did you mean 'distribution'?"},
      {"joint", "distribution = \"flat\"", "law = \"flat\"",
       "prior.k.law: the name of this key is 'distribution' now"},
      {"formula", "model = \"formula\"", "model = \"law\"", "model: 'law' is named 'formula' now"},
      {"formula", "\\[formula\\]", "[law]", "law: the name of this key is 'formula' now"},
      {"formula", "random_effects.machine", "varies.machine",
       "varies: the name of this key is 'random_effects' now"},
      {"joint", "^work_per_cycle", "work_per_cylce",
       "conditions.work_per_cylce: unknown key; did you mean 'work_per_cycle'?"},
      {"bearing", "^contact", "conact", "conditions.conact: unknown key; did you mean 'contact'?"},
      {"bearing", "^limit", "limt", "predict.limt: unknown key; did you mean 'limit'?"},
      {"bearing", "depth_error", "deptherror",
       "likelihood.deptherror: unknown key; did you mean 'depth_error'?"},
      {"fatigue", "log10_Sut ", "log10_sut ",
       "prior.log10_sut: unknown key; did you mean 'log10_Sut'?"},
      {"fatigue", "\"400 MPa\", stress_ratio", "\"400 MPa\", stres_ratio",
       "predict.stress.shaft.stres_ratio: unknown key; did you mean 'stress_ratio'?"},
      {"fatigue", "^b_lives", "B_lives", "predict.B_lives: unknown key; did you mean 'b_lives'?"},
      {"clutch", "^truth", "truht", "simulation.truht: unknown key; did you mean 'truth'?"},
      {"clutch", "^slip_speed = \"1700", "slipspeed = \"1700",
       "life.points.launch.slipspeed: unknown key; did you mean 'slip_speed'?"},
      // keys that stand in the wrong table
      {"joint", "^file = ", "title = \"t\"\nfile = ",
       "data.title: unknown key here; title belongs at the top, before the first [table]"},
      {"joint",
       "^file = ", "risk = 0.1\nfile = ", "data.risk: unknown key here; risk belongs in [predict]"},
      {"fatigue", "^log10_Sut.*", "S_ut = \"1200 MPa\"",
       "prior.S_ut: unknown key here; S_ut belongs in [conditions]"},
      {"clutch", "\\[simulation\\]", "[data]",
       "data.truth: unknown key here; truth belongs in [simulation]"},
      // keys without effect
      {"fatigue", "\"goodman\"", "\"none\"", "prior.log10_Sut: has no effect in this study"},
      // missing
      {"joint", "^volume.*", "", "data.columns.volume: is missing"},
      {"joint", "distribution = \"uniform\", .* \\}", "distribution = \"uniform\" }",
       "2 keys are missing; with values of yours: prior.sigma.lower = \"0 mm^3\"; "
       "prior.sigma.upper = "},
      {"bearing", ", log_sd = 2.5", "", "prior.k.log_sd: is missing (a number)"},
      {"bearing", "^(radius  |clearance   = \\{).*", "",
       "2 keys are missing; with values of yours: data.columns.radius = { column = \"radius\", "
       "unit = \"mm\" } (or conditions.radius); data.columns.clearance = "},
      {"clutch", "^(torque = \"50|closing_time = \"2.15).*", "",
       "2 keys are missing; with values of yours: life.points.launch.torque = \"50 N m\"; "
       "life.points.launch.closing_time = "},
      {"clutch", "^\\[search\\]", "[data]\n[search]",
       "data: is given, and so is [simulation]; keep one of them"},
      // values
      {"joint", "distribution = \"uniform\"", "distribution = \"unifrom\"",
       "prior.sigma.distribution: 'unifrom' is not allowed; use one of flat, uniform, "},
      {"joint", "family = \"normal\"", "family = \"gaussian\"",
       "likelihood.family: 'gaussian' is not allowed; use one of normal, lognormal (nearest: "
       "'normal')"},
      {"joint", "\"row\"", "\"rows\"", "update.stages: 'rows' is not allowed; only 'row' is"},
      {"joint", "\"1 %\"", "5", "predict.risk: must lie between 0 and 1, like 0.05 or \"5 %\""},
      {"joint", "\\[20585\\]", "\"many\"", "predict.cycles: 'many' is not a number"},
      {"joint", "^cycles = \"cycles\"", "cycles = 5", "data.columns.cycles: must be a table"},
      {"joint", "family = \"normal\"", "family = true",
       "likelihood.family: must be a text in quotes, and is true or false"},
      {"joint", "\\[20585\\]", "true", "predict.cycles: must be a number, and is true or false"},
      {"bearing", "\"stationary\"", "\"ball\"",
       "conditions.contact: 'ball' is not allowed; use one of stationary, journal, bushing"},
      {"bearing", "^\\[conditions\\]", "[conditions]\nforce = \"4 N\"",
       "conditions.force: is given here and as data.columns.force; keep one"},
      {"fatigue", "goodman", "Goodman",
       "law.mean_stress: 'Goodman' is not allowed; use one of none, goodman, "},
      {"fatigue", "\\[1, 10\\]", "[\"B10\"]", "predict.b_lives: entry 1: 'B10' is not a number"},
      // files
      {"joint", "joint_wear.csv", "joint_waer.csv",
       "data.file: no such file: joint/joint_waer.csv; did you mean 'joint_wear.csv'?"},
      {"joint", "\"joint_wear.csv\"", "\".\"", "is a folder, not a file"},
      {"clutch", "\"design.csv\"", "\"desing.csv\"",
       "simulation.design: no such file: clutch/desing.csv; did you mean 'design.csv'?"},
  };
  for (const Slip& slip : slips)
    EXPECT_THAT(slipped(slip.example, slip.pattern, slip.instead), HasSubstr(slip.said))
        << slip.pattern;
}

TEST_F(Door, TwoSlipsAreOneMessage) {
  const std::string said = slipped("joint", "^limit  =|^risk   =", "x$&");
  EXPECT_EQ(
      said.substr(0, said.find('\n')),
      "slip.toml:29:11: predict.xlimit: unknown key; did you mean 'limit'? (possible: b_lives, "
      "credible_level, cycles, level, limit, risk, sides, work_per_cycle); and 30:11: "
      "predict.xrisk: unknown "
      "key; did you mean "
      "'risk'? (possible: b_lives, credible_level, cycles, level, limit, risk, sides, "
      "work_per_cycle)");
  EXPECT_THAT(said,
              AllOf(HasSubstr("\n    right: limit  = "), HasSubstr("\n    right: risk   = ")));
  EXPECT_THAT(
      slipped("joint", "^(cycles = \"cycles\"|volume =|family =|work_per_cycle =|sigma|k ).*", ""),
      AllOf(HasSubstr("4 keys are missing"), HasSubstr("data.columns.cycles = "),
            HasSubstr("data.columns.volume = "), HasSubstr("conditions.work_per_cycle = "),
            HasSubstr("likelihood.family = ")));
}

TEST_F(Door, SlipsInACommandLine) {
  fs::create_directory(folder() / "other");
  write("other/summary.json", "{\"schema\": 1}");
  write("other/model.json", "{}");
  const std::pair<const char*, const char*> slips[] = {
      {"fti joint/study.toml",
       "'fti' is not a command of wearwell; did you mean 'fit'? (commands: open, new, check, fit, "
       "report, "
       "life, "
       "decide, plan, update, backtest, compare, monitor, bearing, clutch, fleet, returns, "
       "fatigue, export, "
       "select, "
       "help, version; see wearwell help)"},
      {"Fit joint/study.toml", "did you mean 'fit'?"},
      {"joint/study.toml",
       "'joint/study.toml' is not a command of wearwell (commands: open, new, check, fit, "},
      {"", "wearwell needs a command: open, new, check, fit, "},
      {"clutch",
       "wearwell clutch needs a command: design, simulate, features, predict, life, compare, sql "
       "(see "
       "wearwell help clutch)"},
      {"clutch lfie", "'lfie' is not a command of wearwell clutch; did you mean 'life'?"},
      {"bearing rat", "did you mean 'rate'?"},
      {"help fti", "'fti' is not a command of wearwell; did you mean 'fit'?"},
      {"help fit study", "wearwell fit has no subcommands; 'study' is unknown"},
      {"fit joint/study.toml --metod exact",
       "wearwell fit has no option --metod; did you mean '--method'? (options: --help, --output, "},
      {"fit joint/study.toml -output out", "-output needs two dashes: --output"},
      {"fit joint/study.toml --method exakt",
       "--method: 'exakt' is not allowed; use one of nuts, metropolis, exact; did you mean "
       "'exact'?"},
      {"fit joint/study.toml --draws abc", "--draws: Value abc not in range 10 to 10000000"},
      {"fit joint/study.toml -o", "wearwell fit: --output needs a value (see wearwell help fit)"},
      {"fit joint/study.toml -o a -o b", "--output may be given once; it is given 2 times"},
      {"fit joint/study.toml bearing/study.toml",
       "wearwell fit: 'bearing/study.toml' is an extra argument"},
      {"fit", "wearwell fit: STUDY is missing: Study file (TOML) (see wearwell help fit)"},
      {"fit none.toml", "no such file: none.toml"},
      {"fit joint", "joint is a folder, not a study file; did you mean 'joint/study.toml'?"},
      {"fit empty", "empty is a folder, not a study file"},
      {"fit joint/joint_wear.csv",
       "joint/joint_wear.csv is a table, not a study; name it in a study (TOML) with data.file = "
       "\"joint_wear.csv\""},
      {"check joint/study.toml --json", "wearwell check has no option --json (options: --help; "},
      {"new jiont x",
       "PRESET: 'jiont' is not allowed; use one of joint, bearing, clutch, fatigue, spectrum, "
       "strain-life, staircase, formula, life, accelerated, degradation, fleet, warranty, "
       "repairable; did "
       "you mean "
       "'joint'?"},
      {"new joint", "wearwell new: DIR is "},
      {"new joint joint", "joint is not empty"},
      {"compare joint", "one result cannot be compared; name two or more"},
      {"compare joint bearing",
       "joint does not contain summary.json, so it is not a folder of results of wearwell fit"},
      {"compare joint/study.toml bearing",
       "joint/study.toml is a file; give the folder of results"},
      {"compare other other",
       "other/summary.json is not what wearwell writes: wearwell is missing"},
      {"clutch compare other other",
       "other/summary.json is not what wearwell writes: model is missing"},
      {"report nowhere", "no such folder: nowhere"},
      {"report joint", "joint does not contain summary.json"},
      {"clutch life joint", "joint is a folder, not a file, and has no model.json"},
      {"clutch life other", "model.json"},
      {"clutch life none.json", "no such file: none.json"},
      {"clutch life clutch/study.toml", "clutch/study.toml is not valid JSON"},
      {"bearing rate --contact journal --radius '9,5 mm'",
       "--radius: '9,5 mm' has a decimal comma; use a decimal point; write '9.5 "
       "mm'"},
      {"bearing rate --contact journal --radius 9.5", "--radius: '9.5' has no unit"},
      {"bearing life --contcat journal",
       "wearwell bearing life has no option --contcat; did you mean '--contact'?"},
      {"version now", "wearwell version: 'now' is an extra argument"},
  };
  fs::create_directory(folder() / "empty");
  for (const auto& [arguments, said] : slips)
    EXPECT_THAT(refused(arguments), HasSubstr(said)) << arguments;
}

TEST_F(Door, HelpAndVersionAreCommandsToo) {
  const CommandResult version = in_folder("'" WEARWELL_BINARY "' version");
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_EQ(version.out, in_folder("'" WEARWELL_BINARY "' --version").out);
  EXPECT_EQ(in_folder("'" WEARWELL_BINARY "' help").out,
            in_folder("'" WEARWELL_BINARY "' --help").out);
  for (const char* command : {"fit", "clutch", "clutch life", "bearing rate", "select"}) {
    const CommandResult help = in_folder(fmt::format("'" WEARWELL_BINARY "' help {}", command));
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_THAT(help.out, HasSubstr(fmt::format("Usage: wearwell {}", command)));
    EXPECT_EQ(help.out, in_folder(fmt::format("'" WEARWELL_BINARY "' {} --help", command)).out);
  }
}

}  // namespace
}  // namespace wearwell
