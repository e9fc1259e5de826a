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

class PlanDemonstrate : public ScratchTest {
 protected:
  static json plan(const std::string& arguments) {
    const CommandResult run = run_wearwell("plan demonstrate " + arguments + " --json");
    EXPECT_EQ(run.exit_code, 0) << arguments << "\n" << run.err;
    return json::parse(run.out);
  }
  static std::string refusal(const std::string& arguments) {
    const CommandResult run = run_wearwell("plan demonstrate " + arguments);
    EXPECT_EQ(run.exit_code, 2) << arguments << "\n" << run.err;
    EXPECT_EQ(run.out, "");
    return run.err;
  }
};

const std::string b10 = "'B10 >= 1e6 cycles' ";

TEST_F(PlanDemonstrate, SolvesForSpecimensTimeAndConfidence) {
  const json runs = plan(b10 + "--failures '0 to 3'");
  const std::size_t table[] = {22, 38, 52, 65};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(runs["plans"][i]["specimens"], table[i]);
  EXPECT_EQ(plan("'reliability >= 90 % at 1e6 cycles'")["plans"], plan(b10)["plans"]);
  EXPECT_EQ(plan("'L10 ≥ 1 Mcycles'")["plans"][0]["specimens"], 22);

  const json time = plan(b10 + "--shape 2 --specimens 10");
  EXPECT_EQ(time["sought"], "time");
  const double length = time["plans"][0]["time"];
  EXPECT_NEAR(length, 1e6 * std::sqrt(std::log(0.1) / std::log(0.9) / 10), 1000);
  EXPECT_GE(time["plans"][0]["confidence"], 0.9);
  const json specimens = plan(b10 + "--shape 2 --time '" + std::to_string(length) + " cycles'");
  EXPECT_EQ(specimens["plans"][0]["specimens"], 10);
  const json reached = plan(b10 + "--shape 2 --specimens 5 --time '1e6 cycles'");
  EXPECT_EQ(reached["sought"], "confidence");
  EXPECT_NEAR(reached["plans"][0]["confidence"].get<double>(), 1 - std::pow(0.9, 5), 1e-9);
  EXPECT_EQ(reached["plans"][0]["enough"], false);
}

TEST_F(PlanDemonstrate, SaysThePriorsPart) {
  const json wide = plan(b10 + "--shape '1.5 to 3' --time '2e6 cycles'");
  const json narrow = plan(b10 + "--shape 2.12132034 --time '2e6 cycles'");
  EXPECT_GE(wide["plans"][0]["specimens"], narrow["plans"][0]["specimens"]);
  // Long tests: a shape that is not known costs confidence.
  const std::string both = "--specimens 5 --time '3e6 cycles' --shape ";
  EXPECT_LT(plan(b10 + both + "'1.5 to 3'")["plans"][0]["confidence"],
            plan(b10 + both + "2.12132034")["plans"][0]["confidence"].get<double>() - 0.005);
  EXPECT_EQ(wide["plans"][0]["at_q05"],
            plan(b10 + "--shape 1.5 --time '2e6 cycles'")["plans"][0]["specimens"]);
  EXPECT_EQ(wide["plans"][0]["at_q95"],
            plan(b10 + "--shape 3 --time '2e6 cycles'")["plans"][0]["specimens"]);
  EXPECT_EQ(plan(b10 + "--shape '1.5 to 3' --time '1e6 cycles'")["plans"][0]["specimens"], 22);
  EXPECT_THAT(run_wearwell("plan demonstrate " + b10 + "--shape '1.5 to 3' --specimens 8").out,
              HasSubstr("The prior's part"));
}

TEST_F(PlanDemonstrate, ReportsTheProbabilityToPass) {
  const json at = plan(b10 +
                       "--shape 2 --specimens 10 --true 'B10 = 1e6 cycles' --true 'B10 = 3e6 "
                       "cycles' --true 'reliability = 99 % at 1e6 cycles'");
  const json& all = at["probability_to_pass"];
  ASSERT_EQ(all.size(), 3);
  EXPECT_NEAR(all[0]["probability"][0].get<double>(), 0.1, 1e-3);
  EXPECT_NEAR(all[1]["probability"][0].get<double>(), std::pow(0.1, 1.0 / 9), 1e-3);
  EXPECT_NEAR(all[2]["probability"][0].get<double>(), std::pow(0.1, std::log(0.99) / std::log(0.9)),
              1e-3);
}

TEST_F(PlanDemonstrate, PlansSuddenDeath) {
  const json groups = plan(b10 + "--shape 2 --sudden-death 6");
  const json other = plan(b10 + "--shape 2 --sudden-death 6 --specimens 30");
  EXPECT_EQ(other["plans"].size(), 1);
  EXPECT_EQ(other["plans"][0]["group_size"], 5);
  EXPECT_EQ(groups["probability_to_pass"], other["probability_to_pass"]);
  EXPECT_NEAR(groups["probability_to_pass"][0]["probability"][0].get<double>(), 0.1, 1e-9);
}

TEST_F(PlanDemonstrate, WritesAFolder) {
  const std::string results = (folder() / "plan").string();
  const CommandResult run = run_wearwell("plan demonstrate " + b10 +
                                         "--shape 2 --failures '0 to 2' --json -o " + results);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  std::ifstream file(results + "/plan.json");
  EXPECT_EQ(json::parse(file), json::parse(run.out));
  for (const char* name : {"report.html", "tables/plans.csv", "tables/probability-to-pass.csv",
                           "tables/sample-against-time.csv"})
    EXPECT_TRUE(std::filesystem::exists(results + "/" + name)) << name;
}

TEST_F(PlanDemonstrate, RefusesWhatItCannotPlan) {
  EXPECT_THAT(refusal("'MTTF >= 1e6 cycles'"), HasSubstr("unknown goal 'mttf'"));
  EXPECT_THAT(refusal("'B10 <= 1e6 cycles'"), HasSubstr("must have '>='"));
  EXPECT_THAT(refusal("'B120 >= 1e6 cycles'"), HasSubstr("below 100 %"));
  EXPECT_THAT(refusal("'B10 >= -5 h'"), HasSubstr("must be positive"));
  EXPECT_THAT(refusal("'B10 >= 5 degC'"), HasSubstr("is not a life"));
  EXPECT_THAT(refusal("'B10 >= 1e6 bananas'"), HasSubstr("'bananas' is not a unit"));
  EXPECT_THAT(refusal("'reliability >= 90 %'"), HasSubstr("at which life"));
  EXPECT_THAT(refusal(b10 + "--confidence 90"), HasSubstr("--confidence: '90'"));
  EXPECT_THAT(refusal(b10 + "--failures -1"), HasSubstr("--failures"));
  EXPECT_THAT(refusal(b10 + "--shape 2 --time '5 h'"), HasSubstr("--time"));
  EXPECT_THAT(refusal(b10 + "--time '5e5 cycles'"), HasSubstr("needs --shape"));
  EXPECT_THAT(refusal(b10 + "--shape -2"), HasSubstr("must be positive"));
  EXPECT_THAT(refusal(b10 + "--shape '3 to 2'"), HasSubstr("below the second"));
  EXPECT_THAT(refusal(b10 + "--shape 'lognormal, median = 2'"), HasSubstr("log_sd"));
  EXPECT_THAT(refusal(b10 + "--sigma 0.5"), HasSubstr("--sigma: a Weibull"));
  EXPECT_THAT(refusal(b10 + "--distribution lognormal"), HasSubstr("needs --sigma"));
  EXPECT_THAT(refusal(b10 + "--distribution normal"), HasSubstr("--distribution"));
  EXPECT_THAT(refusal(b10 + "--specimens 2 --failures 2"), HasSubstr("allow fewer"));
  EXPECT_THAT(refusal(b10 + "--true 'B10 = 2e6 cycles'"), HasSubstr("needs --shape"));
  EXPECT_THAT(refusal(b10 + "--shape 2 --true 'B10 = 2e6 h'"), HasSubstr("--true"));
  EXPECT_THAT(refusal(b10 + "--sudden-death 4"), HasSubstr("needs --shape"));
  EXPECT_THAT(refusal(b10 + "--shape '1 to 2' --sudden-death 4"), HasSubstr("as a number"));
  EXPECT_THAT(refusal(b10 + "--shape 2 --sudden-death 4 --specimens 10"), HasSubstr("equal size"));
  EXPECT_THAT(refusal(b10 + "--shape 2 --sudden-death 4 --time '1e6 cycles'"),
              HasSubstr("leave out --time"));
  EXPECT_THAT(refusal(b10 + "--shape 3 --time '1 cycles'"), HasSubstr("ten million"));
}

}  // namespace
}  // namespace wearwell
