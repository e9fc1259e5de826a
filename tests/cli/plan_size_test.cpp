#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "support/run_command.h"
#include "support/scratch.h"

namespace wearwell {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::string planned = PROJECT_SOURCE_DIR
    "/examples/life/study.toml --tests " PROJECT_SOURCE_DIR "/examples/life/planned.csv --goal B10";

class PlanSize : public ScratchTest {
 protected:
  static std::string refusal(const std::string& arguments) {
    const CommandResult run = run_wearwell("plan size " + arguments);
    EXPECT_EQ(run.exit_code, 2) << arguments << "\n" << run.err;
    EXPECT_EQ(run.out, "");
    return run.err;
  }
};

TEST_F(PlanSize, TellsTheSameAsJsonAndInAFolder) {
  const std::string results = (folder() / "size").string();
  const CommandResult run =
      run_wearwell("plan size " + planned +
                   " --width 'factor 9' --most 16 --simulations 20 --json -o " + results);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json reported = json::parse(run.out);
  std::ifstream file(results + "/plan.json");
  EXPECT_EQ(json::parse(file), reported);
  double narrow = 0;
  for (const json& each : reported["sizes"]) {
    EXPECT_NEAR(each["failures"].get<double>() + each["runouts"].get<double>(),
                each["specimens"].get<double>(), 1e-9);
    EXPECT_GE(each["assurance"].get<double>(), narrow - 0.15);
    narrow = each["assurance"];
  }
  for (const char* name : {"report.html", "tables/sizes.csv", "results.sha1"})
    EXPECT_TRUE(std::filesystem::exists(results + "/" + name)) << name;
}

// predict.types of the study are of its data, which are not there; an S-N study refuses campaigns
// without a failure, which are too wide.
TEST_F(PlanSize, LeavesOutTypesAndCountsCampaignsOfRunouts) {
  const auto short_tests =
      write("short.csv", "alternating_stress_MPa,mean_stress_MPa,stop [cycles]\n240,1000,1000\n");
  const std::string springs = PROJECT_SOURCE_DIR "/examples/spring/sensible.toml --tests " +
                              short_tests.string() + " --width 'factor 3'";
  const CommandResult run = run_wearwell(
      "plan size " + springs + " --goal 'B10 at softer spring' --most 4 --simulations 20 --json");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json reported = json::parse(run.out);
  EXPECT_EQ(reported["reached"], false);
  EXPECT_EQ(reported["sizes"][0]["assurance"], 0);
  EXPECT_GE(reported["sizes"][0]["without_failure"], 10);
  EXPECT_EQ(reported["sizes"][0]["unresolved"], 0);
  EXPECT_THAT(refusal(springs + " --goal 'B10 at F'"), HasSubstr("softer spring"));
}

TEST_F(PlanSize, RefusesWhatItCannotPlan) {
  EXPECT_THAT(refusal(planned + " --width 'factor 1'"), HasSubstr("must be above 1"));
  EXPECT_THAT(refusal(planned + " --width '3 kg'"), HasSubstr("--width"));
  EXPECT_THAT(refusal(planned + " --width 'factor 2' --assurance '120 %'"),
              HasSubstr("--assurance"));
  EXPECT_THAT(refusal(planned + "x --width 'factor 2'"), HasSubstr("--goal"));
  const std::string steel = PROJECT_SOURCE_DIR "/examples/fatigue/study.toml --tests ";
  const std::string asked = " --goal 'B10 at hanger' --width 'factor 2'";
  const auto lacks = write("lacks.csv", "stress_ratio\n-1\n");
  EXPECT_THAT(refusal(steel + lacks.string() + asked),
              HasSubstr("lacks.csv has no column 'stress_amplitude_MPa', which the study reads"));
  const auto other = write("other.csv", "stress_ratio,amplitude [ksi]\n-1,33.4\n");
  EXPECT_THAT(refusal(steel + other.string() + asked),
              HasSubstr("column 'amplitude [ksi]' is unknown"));
}

}  // namespace
}  // namespace wearwell
