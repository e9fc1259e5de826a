#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "support/run_command.h"
#include "support/scratch.h"

namespace wearwell {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::string lives = PROJECT_SOURCE_DIR "/examples/decide/lives.csv";
const std::string hidden =
    " --inspection-cost '60 EUR' --failure-cost '2000 EUR' --downtime-cost '2 EUR/h'";
const std::string evident =
    " --inspection-cost '60 EUR' --failure-cost '12000 EUR' --replacement-cost '900 EUR'";

class PlanInspect : public ScratchTest {
 protected:
  static std::string refusal(const std::string& arguments) {
    const CommandResult run = run_wearwell("plan inspect " + arguments);
    EXPECT_EQ(run.exit_code, 2) << arguments << "\n" << run.err;
    EXPECT_EQ(run.out, "");
    return run.err;
  }
  static json answered(const std::string& arguments) {
    const CommandResult run = run_wearwell("plan inspect " + arguments + " --json");
    EXPECT_EQ(run.exit_code, 0) << arguments << "\n" << run.err;
    return json::parse(run.out);
  }
  std::string table(const std::string& text) {
    const std::string file = (folder() / "lives.csv").string();
    std::ofstream(file) << text;
    return file;
  }
  // Weibull of shape 2 and 1000 h.
  std::string weibull() {
    std::string text = "life [h]\n";
    for (int i = 0; i < 5000; ++i)
      text += std::to_string(1000 * std::sqrt(-std::log(1 - (i + 0.5) / 5000))) + "\n";
    return table(text);
  }
};

TEST_F(PlanInspect, TellsTheSameAsJsonAndInAFolder) {
  const std::string results = (folder() / "plan").string();
  const json reported =
      answered(lives + " --unit P4 --risk '10 %' --until '800 h' --step '10 h' -o " + results);
  std::ifstream file(results + "/plan.json");
  EXPECT_EQ(json::parse(file), reported);
  const json& unit = reported["units"][0];
  EXPECT_EQ(unit["unit"], "P4");
  double before = 0;
  for (const json& each : unit["inspections"]) {
    EXPECT_GT(each["after"], before);
    EXPECT_LE(each["risk"], 0.1 + 1e-9);
    before = each["after"];
    EXPECT_NEAR(std::remainder(before, 10), 0, 1e-9);
  }
  for (const char* name : {"report.html", "tables/inspections.csv", "results.sha1"})
    EXPECT_TRUE(std::filesystem::exists(results + "/" + name)) << name;
}

// The first inspection of a Weibull life at 5 % is its B5, and the k-th the quantile of 1 - 0.95^k.
TEST_F(PlanInspect, FollowsTheQuantilesOfALife) {
  const json plan = answered(weibull() + " --risk '5 %'");
  const json& inspections = plan["units"][0]["inspections"];
  EXPECT_NEAR(plan["until"].get<double>(), 1000 * std::sqrt(std::log(2)), 1);
  ASSERT_EQ(inspections.size(), 13);  // log(0.5) / log(0.95) = 13.5
  for (std::size_t k = 0; k < inspections.size(); ++k)
    EXPECT_NEAR(inspections[k]["after"].get<double>(),
                1000 * std::sqrt(-static_cast<double>(k + 1) * std::log(0.95)), 1);
}

TEST_F(PlanInspect, PlansAFleetByVisits) {
  const json plan = answered(lives + " --risk '10 %' --until '1000 h'");
  EXPECT_EQ(plan["units"].size(), 8);
  EXPECT_LT(plan["visits"].size(), plan["visits_alone"]);
  for (const json& unit : plan["units"]) {
    for (const json& each : unit["inspections"]) {
      EXPECT_LE(each["risk"], 0.1 + 1e-9);
      bool visited = false;
      for (const json& visit : plan["visits"]) visited |= visit["after"] == each["after"];
      EXPECT_TRUE(visited) << unit["unit"];
    }
    EXPECT_LE(unit["end"]["risk"], 0.1 + 1e-9);
  }
}

TEST_F(PlanInspect, CostsNoMoreThanEqualIntervalsAndNone) {
  for (const std::string& costs :
       {hidden, evident, evident + " --warning '300 h'", evident + " --risk '3 %'"}) {
    const json plan = answered(lives + " --new --until '4000 h'" + costs);
    const json& unit = plan["units"][0];
    const bool bounded = costs.find("--risk") != std::string::npos;
    ASSERT_GE(unit["compared"].size(), 1) << costs;
    if (bounded) {
      for (const json& each : unit["inspections"]) EXPECT_LE(each["risk"], 0.03 + 1e-9);
    } else {
      for (const json& each : unit["compared"])
        EXPECT_LE(unit["cost"]["total"], each["cost"]["total"]) << costs;
    }
  }
}

TEST_F(PlanInspect, GroupsVisitsThatCost) {
  const std::string asked = lives + " --until '4000 h'" + hidden;
  const json free = answered(asked), costly = answered(asked + " --visit-cost '500 EUR'");
  EXPECT_LT(costly["visits"].size(), free["visits"].size());
  EXPECT_GE(costly["joint"]["cost"], costly["joint"]["least_possible"]);
}

TEST_F(PlanInspect, KeepsTheTotalOfUnforeseenFailures) {
  const json plan = answered(weibull() + " --total-risk '3 %' --warning '150 h' --until '800 h'");
  EXPECT_LE(plan["units"][0]["unforeseen"], 0.03);
  EXPECT_GE(plan["units"][0]["inspections"].size(), 3);
}

TEST_F(PlanInspect, RefusesWhatItCannotPlan) {
  EXPECT_THAT(refusal(lives + " --risk '120 %'"), HasSubstr("--risk"));
  EXPECT_THAT(refusal(lives + " --unit P44"), HasSubstr("did you mean 'P4'"));
  EXPECT_THAT(refusal(lives + " --unit P4 --new"), HasSubstr("--new"));
  EXPECT_THAT(refusal(lives + " --until '9 km'"), HasSubstr("a unit like h"));
  EXPECT_THAT(refusal(lives + " --step '1 h' --until '9000 h'"), HasSubstr("--step"));
  EXPECT_THAT(refusal(lives + " --unit P2 --risk '0.5 %' --step '100 h'"), HasSubstr("--step"));
  EXPECT_THAT(refusal(lives + " --total-risk '1 %'"), HasSubstr("--warning"));
  EXPECT_THAT(refusal(lives + " --warning '1 h'"), HasSubstr("--total-risk or costs"));
  EXPECT_THAT(refusal(lives + " --inspection-cost 1"), HasSubstr("--failure-cost"));
  EXPECT_THAT(refusal(lives + " --inspection-cost 1 --failure-cost 9"),
              HasSubstr("--replacement-cost"));
  EXPECT_THAT(refusal(lives + " --inspection-cost -1 --failure-cost 9 --replacement-cost 2"),
              HasSubstr("must not be negative"));
  EXPECT_THAT(refusal(lives + hidden + " --replacement-cost '9 EUR'"),
              HasSubstr("--replacement-cost"));
  EXPECT_THAT(refusal(lives + evident + " --visit-cost '9 USD'"), HasSubstr("another currency"));
  EXPECT_THAT(refusal(lives + " --given 'force = 2 N'"), HasSubstr("--given"));
  EXPECT_THAT(refusal("no-such.csv"), HasSubstr("no-such.csv"));
  EXPECT_THAT(refusal(table("life [h],unit\n12,A\n15,A\n") + " --new"),
              HasSubstr("no life of a new"));
}

}  // namespace
}  // namespace wearwell
