#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "support/run_command.h"
#include "support/scratch.h"

namespace wearwell {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class PlanNext : public ScratchTest {
 protected:
  static void SetUpTestSuite() {
    results_ = std::filesystem::temp_directory_path() / "wearwell-plan-springs-XXXXXX";
    ASSERT_NE(mkdtemp(results_.data()), nullptr);
    const CommandResult run = run_wearwell("fit " PROJECT_SOURCE_DIR
                                           "/examples/spring/sensible.toml --quiet "
                                           "--no-report -o " +
                                           springs());
    ASSERT_LE(run.exit_code, 1) << run.err;
  }
  static void TearDownTestSuite() { std::filesystem::remove_all(results_); }

  static std::string springs() { return results_ + "/springs"; }
  static std::string question() {
    return "plan next " + springs() + " --goal 'B10 at softer spring'";
  }
  std::string table(const std::string& text) const {
    const std::string file = (folder() / "tests.csv").string();
    std::ofstream(file) << text;
    return file;
  }
  static std::string refusal(const std::string& arguments) {
    const CommandResult run = run_wearwell(arguments);
    EXPECT_EQ(run.exit_code, 2) << arguments << "\n" << run.err;
    EXPECT_EQ(run.out, "");
    return run.err;
  }

  static inline std::string results_;
};

const std::string grid =
    " --grid 'alternating_stress_MPa = 230, 280; mean_stress_MPa = 1000; stop = 1e5, 1e6 cycles'";

TEST_F(PlanNext, RanksAndWritesAFolder) {
  const std::string out = (folder() / "next").string();
  const CommandResult run =
      run_wearwell(question() + grid + " --specimens '1, 3' --specimen-cost 100 --json -o " + out);
  ASSERT_LE(run.exit_code, 1) << run.err;
  const json reported = json::parse(run.out);
  std::ifstream file(out + "/plan.json");
  EXPECT_EQ(json::parse(file), reported);
  ASSERT_EQ(reported["candidates"].size(), 8);
  EXPECT_EQ(reported["goal"]["scale"], "logarithmic");
  EXPECT_EQ(reported["goal"]["unit"], "1e5 cycles");
  double before = 1e9;
  for (const auto& each : reported["candidates"]) {
    EXPECT_LE(each["score"], before);
    before = each["score"];
    EXPECT_GT(each["narrowing"], -0.02);
    EXPECT_LT(each["width"].get<double>(), 1.02 * reported["goal"]["width"].get<double>());
    EXPECT_EQ(each["cost"], 100 * each["specimens"].get<int>());
    EXPECT_LE(each["test"].get<double>(), each["stop"].get<double>());
    EXPECT_GE(each["runouts"], 0);
  }
  for (const char* name : {"report.html", "tables/candidates.csv", "results.sha1"})
    EXPECT_TRUE(std::filesystem::exists(out + "/" + name)) << name;
}

TEST_F(PlanNext, SaysTheSameInEveryUnit) {
  const auto narrowing = [&](const std::string& text) {
    const CommandResult run = run_wearwell(question() + " --candidates " + table(text) + " --json");
    EXPECT_LE(run.exit_code, 1) << run.err;
    return json::parse(run.out)["candidates"][0]["narrowing"].get<double>();
  };
  const double megapascal =
      narrowing("alternating_stress_MPa,mean_stress_MPa,stop [cycles]\n250,1000,2e5\n");
  EXPECT_NEAR(narrowing("alternating_stress [GPa],mean_stress [MPa],stop [1e5 cycles]\n"
                        "0.25,1000,2\n"),
              megapascal, 1e-6);
}

TEST_F(PlanNext, RefusesWhatItCannotPlan) {
  EXPECT_THAT(refusal("plan next " + springs() + " --goal 'B10 at hanger'" + grid),
              HasSubstr("softer spring"));
  EXPECT_THAT(refusal(question()), HasSubstr("--candidates"));
  EXPECT_THAT(refusal(question() + " --grid 'alternating_stress_MPa = 250'"),
              HasSubstr("mean_stress_MPa"));
  EXPECT_THAT(refusal(question() + " --grid 'alternating_stress_MPa = -5; mean_stress_MPa = 0'"),
              HasSubstr("--grid, row 1"));
  EXPECT_THAT(
      refusal(question() + " --grid 'alternating_stress_MPa = 250; mean_stress_MPa = 9000'"),
      HasSubstr("outside the range of its formula"));
  EXPECT_THAT(refusal(question() + " --candidates " +
                      table("alternating_stress [h],mean_stress_MPa\n250,1000\n")),
              HasSubstr("different dimensions"));
  EXPECT_THAT(refusal(question() + " --candidates " +
                      table("alternating_stress_MPa,mean_stress_MPa,price\n250,1000,-3\n") +
                      " --cost price"),
              HasSubstr("row 1, column 'price': -3 must be positive"));
  EXPECT_THAT(
      refusal(question() + " --candidates " + table("alternating_stress_MPa,mean_stress_MPa\n")),
      HasSubstr("tests.csv"));
  EXPECT_THAT(refusal(question() + grid + " --until 'width <= 3 MPa'"), HasSubstr("factor"));
  const std::string out = (folder() / "never").string();
  refusal(question() + " --grid 'x = 1' -o " + out);
  EXPECT_FALSE(std::filesystem::exists(out));
}

}  // namespace
}  // namespace wearwell
