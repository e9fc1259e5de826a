// `wearwell report`, `check` and `new` as their users run them.
#include <gmock/gmock.h>

#include "support/run_command.h"
#include "support/scratch.h"

namespace wearwell {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

const std::string study = PROJECT_SOURCE_DIR "/examples/joint/study.toml";

std::string content(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

class ReportCommands : public ScratchTest {
 protected:
  CommandResult fit(const std::string& options) {
    return run_wearwell("fit " + study + " -o '" + results().string() + "' --quiet " + options);
  }
  fs::path results() const { return folder() / "results"; }
};

TEST_F(ReportCommands, RebuildsTheReportToTheByte) {
  ASSERT_EQ(fit("").exit_code, 0);
  const std::string first = content(results() / "report.html");
  ASSERT_THAT(first, HasSubstr("<!doctype html>"));
  fs::remove(results() / "report.html");
  EXPECT_EQ(run_wearwell("report '" + results().string() + "'").exit_code, 0);
  EXPECT_EQ(content(results() / "report.html"), first);
}

TEST_F(ReportCommands, WritesNoReportWhenNoneIsWanted) {
  ASSERT_EQ(fit("--no-report").exit_code, 0);
  EXPECT_FALSE(fs::exists(results() / "report.html"));
  EXPECT_FALSE(fs::exists(results() / "report.json"));
  const CommandResult run = run_wearwell("report '" + results().string() + "'");
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("report.json is missing"));
}

TEST_F(ReportCommands, NamesTheFileThatIsWrong) {
  EXPECT_THAT(run_wearwell("report '" + folder().string() + "'").err, HasSubstr("summary.json"));
  ASSERT_EQ(fit("").exit_code, 0);
  write("results/draws_2.csv", "lp__,k,sigma\n1,2\n");
  const std::string results_ = "'" + results().string() + "'";
  const CommandResult short_row = run_wearwell("compare " + results_ + " " + results_);
  EXPECT_EQ(short_row.exit_code, 2);
  EXPECT_THAT(short_row.err, HasSubstr("draws_2.csv, draw 1: should have 3 numbers"));
  write("results/summary.json", "{\"wearwell\": 1}");
  const CommandResult summary = run_wearwell("report '" + results().string() + "'");
  EXPECT_EQ(summary.exit_code, 2);
  EXPECT_THAT(summary.err, HasSubstr("summary.json is not what wearwell writes"));
}

// Folders from elsewhere: one message with file and key, and the report stays as it was.
TEST_F(ReportCommands, RefusesAFolderThatNobodyFitted) {
  ASSERT_LE(fit("--draws 10 --warmup 10").exit_code, 1);
  const std::string summary = content(results() / "summary.json");
  const std::string before = content(results() / "report.html");
  const auto refused = [&](const std::string& from, const std::string& to, const std::string& why,
                           bool only_compared = true) {
    std::string changed = summary;
    const std::size_t at = changed.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    write("results/summary.json", changed.replace(at, from.size(), to));
    const std::string folder = "'" + results().string() + "'";
    for (const std::string& command : {"report " + folder, "compare " + folder + " " + folder}) {
      if (only_compared && command.starts_with("report")) continue;
      const CommandResult run = run_wearwell(command);
      EXPECT_EQ(run.exit_code, 2) << command;
      EXPECT_THAT(run.err, HasSubstr("summary.json is not what wearwell writes: " + why))
          << command;
      EXPECT_EQ(run.out, "") << command;
    }
  };
  refused("\"chains\": 4", "\"chains\": 0",
          "sampler.chains should be a whole number from 1 to 1000");
  refused("\"chains\": 4", "\"chains\": 2000000000", "sampler.chains");
  refused("\"rows\": 5", "\"rows\": null", "data.rows should be a whole number", false);
  refused("\"at\": \"inside\"", "\"at\": \"<script>\"", "mode.parameters.k.at should be one of");
  refused("\"parameters\": {", "\"parameters\": {}, \"unknowns\": {", "parameters is empty");
  EXPECT_EQ(content(results() / "report.html"), before);
}

TEST_F(ReportCommands, CheckSaysWhatWillBeFitted) {
  const CommandResult run = run_wearwell("check " + study);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  for (const char* words :
       {"V = k W, W = cycles x 5.966 N m", "5 rows of worn volume",
        "k      wear coefficient [mm^3/(N m)]",
        "prior: flat (no prior knowledge), above 0 mm^3/(N m)",
        "prior: uniform, between 0 and 15 mm^3", "by nuts, 4 chains of 1\u202f000 draws",
        "worn volume [mm^3] at 20\u202f585 cycles", "until the worn volume reaches 100 mm^3"}) {
    EXPECT_THAT(run.out, HasSubstr(words));
  }
}

TEST_F(ReportCommands, NewStudyRunsAsItIs) {
  const fs::path bearing = folder() / "bearing";
  ASSERT_EQ(run_wearwell("new bearing '" + bearing.string() + "'").exit_code, 0);
  const CommandResult check = run_wearwell("check '" + (bearing / "study.toml").string() + "'");
  EXPECT_EQ(check.exit_code, 0) << check.err;
  for (const char* words : {"24 rows of wear depth", "k_scatter  scatter of ln k between",
                            "life [h] of a new bearing to 80 um at 1.5 MPa, 60 rpm"}) {
    EXPECT_THAT(check.out, HasSubstr(words));
  }

  const fs::path mine = folder() / "mine";
  ASSERT_EQ(run_wearwell("new joint '" + mine.string() + "'").exit_code, 0);
  EXPECT_EQ(content(mine / "study.toml"), content(study));
  EXPECT_EQ(run_wearwell("check '" + (mine / "study.toml").string() + "'").exit_code, 0);
  const CommandResult again = run_wearwell("new joint '" + mine.string() + "'");
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_THAT(again.err, HasSubstr("is not empty"));
  EXPECT_EQ(run_wearwell("new nonsense '" + (folder() / "other").string() + "'").exit_code, 2);
  EXPECT_FALSE(fs::exists(folder() / "other"));
}

}  // namespace
}  // namespace wearwell
