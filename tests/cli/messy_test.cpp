// examples/messy: tables as spreadsheets, loggers and rigs write them, from `check` to the result.
// What is true of each is in examples/messy/make_files.py.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "support/run_command.h"
#include "support/scratch.h"

namespace wearwell {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

const std::string examples = PROJECT_SOURCE_DIR "/examples/messy/";

class Messy : public ScratchTest {
 protected:
  static std::string checked(const std::string& study) {
    const CommandResult run = run_wearwell("check '" + examples + study + "'");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return run.out;
  }
  json fitted(const std::string& study) const {
    const CommandResult run =
        run_wearwell("fit '" + examples + study + "' --quiet --no-report --method exact -o '" +
                     (folder() / "results").string() + "'");
    EXPECT_LE(run.exit_code, 1) << run.err;
    std::ifstream file(folder() / "results" / "summary.json");
    return json::parse(file);
  }
  /// Whether a true value lies within four standard deviations of the mean.
  static void expect_near(const json& parameter, double truth) {
    EXPECT_NEAR(parameter["mean"].get<double>(), truth, 4 * parameter["sd"].get<double>());
  }
};

TEST_F(Messy, GermanExcel) {
  const std::string words = checked("german_excel.toml");
  EXPECT_THAT(words,
              AllOf(HasSubstr("semicolons, decimal comma, thousands point, cp1252, headings in "
                              "line 5, 2 empty rows left out\n"),
                    HasSubstr("1 kJ = 1\u202f000 N m"), HasSubstr("1 mm\u00B3 = 10^-9 m^3"),
                    HasSubstr("10       900  37\u202f500  250\u202f000")));
  expect_near(fitted("german_excel.toml")["parameters"]["k"], 5e-6);
}

TEST_F(Messy, Logger) {
  EXPECT_THAT(checked("logger.toml"),
              AllOf(HasSubstr("tabs, decimal point, UTF-16, units in the row below the headings\n"),
                    HasSubstr("1 kcycles = 1\u202f000 cycle"), HasSubstr("1 kJ = 1\u202f000 N m")));
  expect_near(fitted("logger.toml")["parameters"]["k"], 2e-6);
}

TEST_F(Messy, Rig) {
  EXPECT_THAT(
      checked("rig.toml"),
      AllOf(HasSubstr("commas, decimal point, headings in line 5, 4 comment lines left out\n"),
            HasSubstr(" 1000 = 1\u202f000 rev"), HasSubstr("1 um = 10^-6 m")));
  expect_near(fitted("rig.toml")["parameters"]["k"], 1e-6);
}

TEST_F(Messy, Workbook) {
  EXPECT_THAT(checked("workbook.toml"), AllOf(HasSubstr("sheet 'Versuche', headings in row 4\n"),
                                              HasSubstr("1 MPa = 1\u202f000\u202f000 Pa")));
  expect_near(fitted("workbook.toml")["parameters"]["b"], -0.1);
}

// A row that counts twice is two rows, for every model that has inspections.
TEST_F(Messy, CountsAreRows) {
  const char* const rest =
      "[likelihood]\nfamily = 'normal'\n[prior]\nk = { distribution = 'lognormal', median = '1e-6 "
      "mm^3/(N "
      "m)', "
      "log_sd = 2.5 }\nsigma = { distribution = 'half-normal', scale = '1 mm^3' }\n";
  write("once.csv",
        "cycles,work [J],V [mm^3],n\n1e3,6e3,0.3,2\n2e3,1.2e4,0.5,1\n3e3,1.9e4,0.9,3\n");
  write("all.csv",
        "cycles,work [J],V [mm^3]\n1e3,6e3,0.3\n1e3,6e3,0.3\n2e3,1.2e4,0.5\n3e3,1.9e4,0.9\n"
        "3e3,1.9e4,0.9\n3e3,1.9e4,0.9\n");
  json k[2];
  for (const int i : {0, 1}) {
    write("study.toml", std::string("model = 'archard-joint'\n[data]\nfile = '") +
                            (i ? "all.csv" : "once.csv") +
                            "'\n[data.columns]\ncycles = 'cycles'\nwork = 'work'\nvolume = 'V'\n" +
                            (i ? "" : "count = 'n'\n") + rest);
    const std::string out = (folder() / std::to_string(i)).string();
    const CommandResult run = run_wearwell("fit '" + (folder() / "study.toml").string() +
                                           "' --quiet --no-report --method exact -o '" + out + "'");
    EXPECT_LE(run.exit_code, 1) << run.err;
    std::ifstream file(out + "/summary.json");
    const json summary = json::parse(file);
    EXPECT_EQ(summary["data"]["rows"], 6);
    k[i] = summary["parameters"]["k"];
  }
  EXPECT_EQ(k[0], k[1]);
}

}  // namespace
}  // namespace wearwell
