// What strangers, slips and broken files do to the program: exit code 2, one sentence that names
// the place, nothing written.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <filesystem>

#include "support/messages.h"
#include "support/run_command.h"
#include "support/scratch.h"

namespace wearwell {
namespace {

using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
namespace fs = std::filesystem;

class Refusal : public ScratchTest {
 protected:
  /// Runs in the test's own folder; must end with 2, say one line, and leave no new file there.
  std::string refused(const std::string& arguments) {
    const int before = files();
    const CommandResult run =
        run_command("cd '" + folder().string() + "'; '" WEARWELL_BINARY "' " + arguments);
    EXPECT_EQ(run.exit_code, 2) << arguments << "\n" << run.out << run.err;
    EXPECT_EQ(run.out, "") << arguments;
    EXPECT_THAT(run.err, StartsWith("wearwell: "));
    EXPECT_EQ(messages_in(run.err), 1u) << run.err;
    EXPECT_THAT(run.err, AllOf(Not(HasSubstr("internal error")), Not(HasSubstr("json.exception")),
                               Not(HasSubstr("Error:"))));
    EXPECT_EQ(files(), before) << arguments;
    return run.err;
  }
  int files() const {
    return static_cast<int>(std::distance(fs::recursive_directory_iterator(folder()), {}));
  }
  void data(const std::string& content = "cycles,volume\n1,4.44\n100,5.105\n1000,9\n") {
    write("runs.csv", content);
  }
  /// A joint study; `more` goes into [data], `prior` is that of k.
  std::string study(const std::string& more = "", const std::string& prior = flat,
                    const std::string& name = "study.toml") const {
    write(name, fmt::format(R"(title = "t"
model = "archard-joint"
[data]
file = "runs.csv"
{}
[data.columns]
cycles = "cycles"
volume = {{ column = "volume", unit = "mm^3" }}
[conditions]
work_per_cycle = "5.966 N m"
[likelihood]
family = "normal"
[prior]
k = {}
sigma = {{ distribution = "flat", unit = "mm^3", lower = "0 mm^3", upper = "100 mm^3" }}
)",
                            more, prior));
    return name;
  }
  static constexpr const char* flat =
      R"toml({ distribution = "flat", unit = "mm^3/(N m)", lower = "0 mm^3/(N m)", upper = "1 mm^3/(N m)" })toml";
};

TEST_F(Refusal, AStudyIsNoProgram) {
  data();
  const std::string target = (folder() / "owned.csv").string();
  for (const std::string& sql :
       {fmt::format("select * from data; copy (select 'owned') to '{}'", target),
        fmt::format("copy (select 'owned') to '{}'", target), fmt::format("attach '{}'", target),
        fmt::format("export database '{}'", target)}) {
    const std::string file = study(fmt::format("sql = \"{}\"", sql));
    for (const char* command : {"check ", "fit "})
      EXPECT_THAT(refused(command + file), HasSubstr("study.toml:5:7: data.sql: "));
    EXPECT_THAT(
        refused(fmt::format("select runs.csv --sql \"{}\" --response volume --inputs cycles", sql)),
        AnyOf(HasSubstr("must be one SELECT"), HasSubstr("may read only the data file")));
  }
  for (const char* read : {"read_text('/etc/passwd')", "glob('/etc/*')", "'/etc/passwd'"})
    EXPECT_THAT(refused("check " + study(fmt::format("sql = \"select * from {}\"", read))),
                HasSubstr("study.toml:5:7: data.sql: "));
}

TEST_F(Refusal, FilesAreNamedWhereTheStudyNamesThem) {
  EXPECT_THAT(refused("check " + study()), HasSubstr("study.toml:4:8: data.file: no such file: "));
  data("cycles,volume\n1,4.44\n100,5,1\n");
  EXPECT_THAT(refused("check " + study()),
              HasSubstr("runs.csv, line 3: 3 values but the heading has 2: '100,5,1'"));
  data("load;volume;cycles\n2;1;35.000\n3;2;60.000\n");
  EXPECT_THAT(refused("fit " + study()),
              HasSubstr("runs.csv, row 1, column 'cycles': '35.000' can mean 35 or, with a "
                        "thousands separator, 35000"));
  // Another column shows that commas are the decimal marks of this file.
  data("load;volume;cycles\n2,5;1;35.000\n2,6;2;60.000\n");
  const CommandResult read =
      run_command("cd '" + folder().string() + "' && '" WEARWELL_BINARY "' check " + study());
  EXPECT_EQ(read.exit_code, 0) << read.err;
  EXPECT_THAT(read.out,
              AllOf(HasSubstr("decimal comma, thousands point"), HasSubstr("60\u202f000")));
  EXPECT_THAT(refused("check /dev/null"), HasSubstr("a pipe or a device"));
  const CommandResult piped = run_command("cat '" + (folder() / study()).string() +
                                          "' | '" WEARWELL_BINARY "' check /dev/stdin");
  EXPECT_EQ(piped.exit_code, 2);
  EXPECT_THAT(piped.err, HasSubstr("/dev/stdin is a pipe or a device"));
}

TEST_F(Refusal, WhatFitRefusesCheckRefuses) {
  // All of the prior lies where the likelihood is zero even in logarithms.
  data("cycles,volume\n1,4.44\n100,1e160\n1000,9\n");
  const std::string far =
      R"toml({ distribution = "uniform", lower = "1e-320 mm^3/(N m)", upper = "1e-319 mm^3/(N m)" })toml";
  const std::string fit = refused("fit " + study("", far));
  EXPECT_EQ(refused("check " + study("", far)), fit);
}

// Laws whose quantiles no double holds, and bounds with nothing between them.
TEST_F(Refusal, PriorsThatNoNumberCanStartFrom) {
  data();
  for (
      const char* law :
      {R"toml({ distribution = "student-t", df = 1e-3, location = "0 mm^3/(N m)", scale = "1 mm^3/(N m)" })toml",
       R"toml({ distribution = "inverse-gamma", shape = 1e-5, scale = "1 mm^3/(N m)" })toml",
       R"toml({ distribution = "uniform", lower = "1 mm^3/(N m)", upper = "1.0000000000000002 mm^3/(N m)" })toml"})
    EXPECT_THAT(refused("check " + study("", law)), HasSubstr("study.toml:14:5: [prior.k]: "))
        << law;
}

TEST_F(Refusal, LongAndForeignText) {
  data();
  const std::string message =
      refused("check " + study("", "{ distribution = \"" + std::string(10'000, 'x') + "\" }"));
  EXPECT_LT(message.size(), 1000U);
  EXPECT_THAT(message, HasSubstr("(10000 characters)"));
  EXPECT_THAT(refused("check " + study("", "{ distribution = \"a\\u001b[31mb\" }")),
              AllOf(HasSubstr("a\\x1b[31mb"), Not(HasSubstr("\x1b"))));
  std::string deep = "a";
  for (int i = 0; i < 50'000; ++i) deep += ".a";
  write("deep.toml", "title = \"t\"\n" + deep + " = 1\n");
  EXPECT_THAT(refused("check deep.toml"), HasSubstr("deep.toml:2: the key has more than 32 parts"));
  write("trip.toml", "title = \"t\"\n\n[.= 1\n");
  EXPECT_THAT(refused("check trip.toml"), HasSubstr("trip.toml:3: invalid TOML"));
}

// A name is bytes; results hold text.
TEST_F(Refusal, NamesThatAreNoText) {
  data();
  study("", flat,
        "gr\xF6\xDF"
        "e.toml");
  const CommandResult run = run_command("cd '" + folder().string() +
                                        "'; sed -i 1d gr*e.toml; '" WEARWELL_BINARY
                                        "' fit gr*e.toml -o out --method exact --json");
  EXPECT_LE(run.exit_code, 1) << run.err;
  EXPECT_THAT(run.out, HasSubstr("\"gr\xEF\xBF\xBD\xEF\xBF\xBD"
                                 "e\""));
}

TEST_F(Refusal, OptionsThatNoNumberCanBe) {
  write("traces.csv",
        "plate,time [s],slip_speed [rad/s],torque [N m],temperature [degC]\n1,0,10,5,50\n1,0.1,0,"
        "5,50\n");
  EXPECT_THAT(refused("clutch features traces.csv --slip-off '2 s'"), HasSubstr("--slip-off"));
  EXPECT_THAT(refused("clutch features traces.csv --slip-off '-2 rad/s'"), HasSubstr("--slip-off"));
  EXPECT_THAT(refused("clutch features traces.csv --torque-on '1e308 MN m'"),
              HasSubstr("--torque-on: '1e308 MN m' is infinite"));
  EXPECT_THAT(refused("clutch design --most-energy '-1 kJ'"), HasSubstr("--most-energy"));
  EXPECT_THAT(refused("clutch design --torque '1e308, 2e308 MN m'"), HasSubstr("--torque"));
  EXPECT_THAT(refused("bearing chart --sigma 1e300"), HasSubstr("clearance/radius 1e+300"));
  EXPECT_THAT(refused("bearing chart --sigma inf"), HasSubstr("--sigma"));
  EXPECT_THAT(refused("bearing rate --contact stationary --radius '1e308 km' --clearance '20 um' "
                      "--depth '0.1 mm' --pressure '1 MPa' --revolutions 1e5"),
              HasSubstr("--radius"));
  for (const char* level : {"inf", "nan", "-1", "0", "1e300"})
    EXPECT_THAT(refused(fmt::format("clutch life model.json --level {}", level)),
                HasSubstr("--level"));
  for (const char* seed : {"99999999999999999999", "-1", "1.5"})
    EXPECT_THAT(refused(fmt::format("clutch design --seed {}", seed)), HasSubstr("--seed"));
  data();
  for (const char* option : {"--near nan", "--near -1", "--time inf", "--time nan"})
    EXPECT_THAT(
        refused(fmt::format("select runs.csv --response volume --inputs cycles {}", option)),
        HasSubstr(std::string(option).substr(0, 6)));
}

TEST_F(Refusal, ModelsThatAreNone) {
  write("cycles.csv", "plate\n1\n");
  EXPECT_THAT(refused("clutch predict . cycles.csv"), HasSubstr("is a folder, not a file"));
  EXPECT_THAT(refused("clutch predict none.json cycles.csv"), HasSubstr("none.json"));
  for (const char* content : {"", "[1, 2", "[]", "{\"format\": 3}",
                              "{\"format\": \"wearwell clutch wear model\", \"version\": 1}"}) {
    write("bad.json", content);
    EXPECT_THAT(refused("clutch predict bad.json cycles.csv"), HasSubstr("bad.json")) << content;
  }
}

// Squares of these are no doubles.
TEST_F(Refusal, ResponsesWhoseSquaresAreNoNumbers) {
  for (const char* factor : {"e154", "e-165", "e-300", "e200"}) {
    write("y.csv", fmt::format("x,y\n1,1.5{0}\n2,2.5{0}\n3,3.4{0}\n4,4.1{0}\n5,5.6{0}\n", factor));
    EXPECT_THAT(refused("select y.csv --response y --inputs x --degree 2 --cloud"),
                HasSubstr("y.csv, column 'y': the largest value is"))
        << factor;
    write("x.csv", fmt::format("y,x\n1,1.5{0}\n2,2.5{0}\n3,3.4{0}\n4,4.1{0}\n5,5.6{0}\n", factor));
    EXPECT_THAT(refused("select x.csv --response y --inputs x --degree 2 --cloud"),
                HasSubstr("x.csv, column 'x': the largest value is"))
        << factor;
  }
}

// The fit of y scaled by 1e90 is the fit of y, scaled.
TEST_F(Refusal, ScalesThatAreNumbersAreFitted) {
  for (const char* factor : {"e90", "e-90", ""}) {
    write("y.csv",
          fmt::format("x,y\n1,1.5{0}\n2,2.5{0}\n3,3.4{0}\n4,4.1{0}\n5,5.6{0}\n6,6.5{0}\n", factor));
    const CommandResult run =
        run_command("cd '" + folder().string() +
                    "'; '" WEARWELL_BINARY
                    "' select y.csv --response y --inputs x --degree 2 --cloud --json | grep -m1 "
                    "'\"r2p\"'");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("0.98")) << factor;
  }
}

}  // namespace
}  // namespace wearwell
